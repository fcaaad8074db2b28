"""Label and prediction files on disk: a folder with one file per image, or one file for all images."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

from app.errors import ClearLinesError, InvalidFile, InvalidInput, NotFound
from app.formats.files import read_file
from app.formats.labelled import LabelledSegments
from app.formats.limits import SEGMENT_LIMITS, SET_LIMITS
from app.formats.naming import check_names, name_segment_files
from app.formats.segment_files import list_segment_files, read_segment_set, read_segments

Read = Callable[[], LabelledSegments]


@dataclass(frozen=True)
class SegmentFiles:
    """The segments of images, read when asked for.

    Attributes:
        files: Reads the segments of an image, by its name.
        ambiguous: Reads the labels of an image that aren't to be scored, by its name.
    """

    files: Mapping[str, Read]
    ambiguous: Mapping[str, Read] = field(default_factory=dict)


def open_segment_files(path: Path, what: str, images: Collection[str] = ()) -> SegmentFiles:
    """Find the files in a folder and its subfolders; or read the one file for all images.

    Args:
        path: Folder or file.
        what: What they are, for messages: ``ground truth``, say.
        images: Names of images, so that one whose own name ends like a label file's is understood.

    Raises:
        NotFound: If there is nothing at the path.
        InvalidInput: If two files are for one image, all of which are named.
        InvalidFile: If the one file for all can't be read.
        TooLarge: If it is over the limits.
    """
    if path.is_file():
        images_of_set = read_segment_set(path.as_posix(), read_file(path, limit=SET_LIMITS.file_bytes))
        return SegmentFiles({name: partial(_same, value) for name, value in images_of_set.items()})
    if not path.is_dir():
        raise NotFound(f"the {what} folder doesn't exist", where=str(path), hint="is the path right?")
    try:
        files, ambiguous = name_segment_files(list_segment_files(path), set(images))
        check_names([*files, *ambiguous], where=str(path))
    except InvalidInput as error:
        raise InvalidInput(
            error.message, where=str(path), expected=error.expected, hint=error.hint, details=error.details
        ) from error
    return SegmentFiles(
        {name: partial(read_segment_file, path / file) for name, file in files.items()},
        {name: partial(read_segment_file, path / file) for name, file in ambiguous.items()},
    )


def read_segment_file(path: Path) -> LabelledSegments:
    """Read the segments of one image from a ``.npy``, ``.npz`` or ``.json`` file.

    Raises:
        InvalidFile: If it can't be read.
        TooLarge: If it is over the limits.
    """
    return read_segments(path.as_posix(), read_file(path, limit=SEGMENT_LIMITS.file_bytes))


def _same(value: LabelledSegments) -> LabelledSegments:
    return value


def one_error(errors: list[ClearLinesError]) -> ClearLinesError:
    """Return the only error, or one that says all of them, so that a person can mend everything in one go."""
    if len(errors) == 1:
        return errors[0]
    return InvalidFile(
        f"{len(errors)} files can't be used:\n" + "\n".join(f"  {error}" for error in errors),
        details={"errors": [error.as_dict() for error in errors]},
    )
