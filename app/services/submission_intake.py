"""From an upload to a row: one file is taken as it is, several are packed into one zip first."""

from __future__ import annotations

import tempfile
import zipfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import BinaryIO

from app.errors import InvalidInput
from app.formats.naming import composed, has_control_characters
from app.formats.submission_limits import SubmissionLimits
from app.formats.submission_problems import Complaints, Problem, invalid_submission
from app.services.uploads import UploadedFile

NAME_LENGTH = 500
SPOOLED = 2**20
PACKED = "upload.zip"


@dataclass(frozen=True)
class Upload:
    """One file that holds a whole submission.

    Attributes:
        name: Its file name; the ending says what it is.
        stream: Its bytes, from the first.
        size: Their number.
    """

    name: str
    stream: BinaryIO
    size: int


@contextmanager
def one_upload(files: Sequence[UploadedFile], limits: SubmissionLimits) -> Iterator[Upload]:
    """Give what was uploaded as one file; a zip that is made on the way is gone at the end.

    Raises:
        InvalidInput: When there is no file.
        InvalidSubmission: When it is too large, or names can't be; all of them are named.
    """
    if not files:
        raise InvalidInput("there is no file", where="files", expected="one archive, or one file per image")
    sizes = [_size(file.stream) for file in files]
    if sum(sizes) > limits.upload_bytes:
        message = f"the upload has {sum(sizes):,} bytes"
        problem = Problem(message, files[0].name, expected=f"at most {limits.upload_bytes:,} bytes")
        raise invalid_submission([problem], where=files[0].name)
    _check_names(files, limits)
    if len(files) == 1:
        yield Upload(composed(files[0].name), files[0].stream, sizes[0])
        return
    with tempfile.SpooledTemporaryFile(SPOOLED) as packed:
        with zipfile.ZipFile(packed, "w") as archive:
            for file in files:
                archive.writestr(zipfile.ZipInfo(composed(file.name)), file.stream.read())
        size = packed.tell()
        packed.seek(0)
        yield Upload(PACKED, packed, size)  # type: ignore[arg-type]


def _size(stream: BinaryIO) -> int:
    size = stream.seek(0, 2)
    stream.seek(0)
    return size


def _check_names(files: Sequence[UploadedFile], limits: SubmissionLimits) -> None:
    complaints = Complaints(limits.problems)
    taken: dict[str, str] = {}
    for file in files:
        name = composed(file.name)
        key = name.casefold()
        if not name or len(name) > NAME_LENGTH or has_control_characters(name) or "\ufffd" in name:
            complaints.add(Problem("the file's name can't be read", name[:NAME_LENGTH], expected="a name in UTF-8"))
        elif key in taken:
            message = f"the same name as {taken[key]}, but for case at most"
            complaints.add(Problem(message, name, expected="each file once"))
        taken[key] = name
    complaints.raise_any("files")
