"""The files of an upload, one at a time: of a zip, of a tar.gz, or the upload itself."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import BinaryIO

from app.errors import ClearLinesError, InvalidFile, TooLarge
from app.formats.archives import Archive, open_archive
from app.formats.naming import AMBIGUOUS, REPORTS, SEGMENT_SUFFIXES, is_hidden
from app.formats.submission_limits import SubmissionLimits
from app.formats.submission_problems import Complaints, Problem
from app.formats.tars import GZIP_MAGIC, read_tar

ARCHIVED = "an archive inside the archive"
TAR_ENDINGS = (".tar.gz", ".tgz")
ACCEPTED = "a .zip or .tar.gz of one .npz, .json or .npy per image, or one .npz or .json for all images"


@dataclass(frozen=True)
class LeftOut:
    """A file of the upload that isn't read, and why."""

    file: str
    reason: str


def read_members(
    name: str,
    stream: BinaryIO,
    size: int,
    limits: SubmissionLimits,
    complaints: Complaints,
    left_out: list[LeftOut],
) -> Iterator[tuple[str, bytes]]:
    """Unpack the files of segments of an upload.

    Args:
        name: The upload's file name; its ending says what it is.
        stream: Its bytes, seekable, from the first.
        size: Their number.
        limits: How much is taken.
        complaints: Gets what is wrong with the archive and its entries.
        left_out: Gets what isn't read.

    Yields:
        Path and bytes of each.
    """
    lower = name.lower()
    try:
        if size > limits.upload_bytes:
            raise TooLarge(f"the upload has {size:,} bytes", expected=f"at most {limits.upload_bytes:,}")
        if lower.endswith(".zip"):
            with open_archive(stream, where=name, limits=limits.archive) as archive:
                yield from _of_zip(archive, complaints, left_out)
        elif lower.endswith(TAR_ENDINGS):
            yield from _of_tar(name, stream, size, limits, complaints, left_out)
        elif PurePosixPath(lower).suffix in SEGMENT_SUFFIXES:
            yield name, stream.read()
        else:
            packed = stream.read(2) == GZIP_MAGIC or lower.endswith(".tar")
            raise InvalidFile(
                "this is no file of results",
                expected=ACCEPTED,
                hint="pack it with gzip and call it .tar.gz" if packed else "the ending of the name says what it is",
            )
    except ClearLinesError as error:
        _complain(error, name, complaints)


def _complain(error: ClearLinesError, name: str, complaints: Complaints) -> None:
    """Take apart what the zip reader collected: a line for each entry, with its path first."""
    entries = error.details.get("problems")
    if not isinstance(entries, list):
        complaints.add_error(error, name)
        return
    for entry in entries:
        path, _, reason = str(entry).rpartition(": ")
        complaints.add(Problem(reason, path or name, hint="pack ordinary files, with paths under one root"))


def _of_zip(archive: Archive, complaints: Complaints, left_out: list[LeftOut]) -> Iterator[tuple[str, bytes]]:
    for path, reason in archive.ignored:
        _leave_out(path, reason, complaints, left_out)
    for member in archive.members:
        reason = _reason_to_leave_out(member.path)
        if reason:
            left_out.append(LeftOut(member.path, reason))
            continue
        try:
            yield member.path, archive.read(member)
        except ClearLinesError as error:
            complaints.add(Problem(error.message, member.path, expected=error.expected, hint=error.hint))


def _of_tar(
    name: str,
    stream: BinaryIO,
    size: int,
    limits: SubmissionLimits,
    complaints: Complaints,
    left_out: list[LeftOut],
) -> Iterator[tuple[str, bytes]]:
    files = 0
    for path, content in read_tar(stream, size=size, where=name, limits=limits.archive):
        if isinstance(content, ClearLinesError):
            complaints.add(Problem(content.message, path, hint="pack ordinary files, with paths under one root"))
        elif isinstance(content, str):
            _leave_out(path, content, complaints, left_out)
        elif reason := _reason_to_leave_out(path):
            left_out.append(LeftOut(path, reason))
        else:
            files += 1
            yield path, content
    if not files and not complaints.count:
        raise InvalidFile("the tar holds no file that could be read", where=name, expected=ACCEPTED)


def _leave_out(path: str, reason: str, complaints: Complaints, left_out: list[LeftOut]) -> None:
    """Folders and what systems add go without a word; an archive may hold results, so it isn't passed over."""
    if reason == ARCHIVED:
        complaints.add(Problem(reason, path, hint="unpack it and put its files into the upload"))
    elif reason != "a folder":
        left_out.append(LeftOut(path, reason))


def _reason_to_leave_out(path: str) -> str:
    file = PurePosixPath(path)
    if is_hidden(path):
        return "a hidden file"
    if file.suffix.lower() not in SEGMENT_SUFFIXES:
        return "no file of segments"
    if file.name in REPORTS:
        return "a report, not segments"
    if file.stem.endswith(AMBIGUOUS):
        return "ambiguous labels are no predictions"
    return ""
