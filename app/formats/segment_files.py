"""Read any file of segments by its extension, and any set of such files."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path, PurePosixPath

from app.errors import InvalidFile, InvalidInput, NotFound
from app.formats.inert_npy import read_label_npy
from app.formats.json_segments import read_json, read_json_set
from app.formats.labelled import LabelledSegments
from app.formats.limits import SEGMENT_LIMITS, SET_LIMITS, SegmentLimits, SetLimits
from app.formats.naming import is_segment_path
from app.formats.npz import read_npz, read_npz_set


def read_segments(path: str, data: bytes, *, limits: SegmentLimits = SEGMENT_LIMITS) -> LabelledSegments:
    """Read the segments of one image from ``.npy``, ``.npz`` or ``.json``.

    Args:
        path: Name of the file; its extension says the format.
        data: Its bytes.
        limits: How many bytes, segments and points are taken.

    Raises:
        InvalidFile: On another extension, or whatever is wrong with the file.
        TooLarge: Over a limit.
    """
    match PurePosixPath(path).suffix.lower():
        case ".npy":
            return LabelledSegments(read_label_npy(data, where=path, limits=limits))
        case ".npz":
            return read_npz(data, where=path, limits=limits)
        case ".json":
            return read_json(data, where=path, limits=limits)
    raise InvalidFile("this is no file of segments", where=path, expected=".npy, .npz or .json")


def read_segment_set(path: str, data: bytes, *, limits: SetLimits = SET_LIMITS) -> Mapping[str, LabelledSegments]:
    """Read the one file that holds the segments of all images, ``.npz`` or ``.json``; errors as `read_segments`."""
    match PurePosixPath(path).suffix.lower():
        case ".npz":
            return read_npz_set(data, where=path, limits=limits)
        case ".json":
            return read_json_set(data, where=path, limits=limits)
    raise InvalidFile("this is no file for all images", where=path, expected=".npz or .json")


def list_segment_files(folder: Path) -> list[str]:
    """Return the paths of all files of segments under a folder, sorted, with forward slashes.

    Raises:
        NotFound: If there is no such folder.
    """
    if not folder.is_dir():
        raise NotFound("there is no such folder", where=str(folder))
    paths = (path for path in folder.rglob("*") if path.is_file())
    return sorted(relative for path in paths if is_segment_path(relative := path.relative_to(folder).as_posix()))


def read_all(
    files: Iterable[tuple[str, str, bytes]], *, limits: SegmentLimits = SEGMENT_LIMITS
) -> Iterator[tuple[str, LabelledSegments]]:
    """Read many files, given as (image name, path, bytes), and complain of all that are broken at once.

    Yields:
        Image name and segments, of each file that can be read.

    Raises:
        InvalidInput: After the last file, if any couldn't be read; ``details["errors"]`` has each.
    """
    errors: list[InvalidInput] = []
    for name, path, data in files:
        try:
            labelled = read_segments(path, data, limits=limits)
        except InvalidInput as error:
            errors.append(error)
            continue
        yield name, labelled
    if errors:
        raise InvalidFile(
            f"{len(errors)} files can't be read; the first: {errors[0].message}"
            if len(errors) > 1
            else errors[0].message,
            where=errors[0].where,
            expected=errors[0].expected,
            hint=errors[0].hint,
            details={"errors": [error.as_dict() for error in errors[:1000]]},
        )
