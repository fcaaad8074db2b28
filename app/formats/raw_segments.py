"""Read a file of predictions loosely: what can be taken is taken, and every complaint is collected.

The strict readers stop at the first thing that is wrong. Somebody who uploads results wants to know all of it at once.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import chain
from pathlib import PurePosixPath
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.errors import ClearLinesError, InvalidFile, TooLarge
from app.formats.inert_npy import read_label_arrays
from app.formats.json_segments import parse_json
from app.formats.naming import composed
from app.formats.npz import read_arrays
from app.formats.polylines import check_counts
from app.formats.submission_limits import SubmissionLimits
from app.formats.submission_problems import Complaints, Problem

POINTS = "x and y in px for each point"
NPZ = "points (M, 2) in px and offsets (S + 1,), from 0 to M"
JSON = '{"segments": [{"points": [[x, y], ...], "score": 0.9}]}'


@dataclass(frozen=True, eq=False)
class RawSegments:
    """The segments that a file gives for one image, shapes checked, values not.

    Attributes:
        file: Path of the file, with ``: image NAME`` behind it in a file for all images.
        name: Path of the file without extension, or the name that it gives the image.
        points: float64 ``(N, 2)``, px.
        counts: int64 ``(S,)``, points per segment.
        scores: float64 ``(S,)``; ``None`` without any.
        told: Segments that were complained of already.
        named: Whether the file itself names the image.
    """

    file: str
    name: str
    points: NDArray[np.float64]
    counts: NDArray[np.int64]
    scores: NDArray[np.float64] | None = None
    told: frozenset[int] = frozenset()
    named: bool = False


def read_raw(path: str, data: bytes, limits: SubmissionLimits, complaints: Complaints) -> list[RawSegments]:
    """Read ``.npy``, ``.npz`` or ``.json``, of one image or of all.

    Args:
        path: Of the file in the upload.
        data: Its bytes.
        limits: How much is taken.
        complaints: Gets all that is wrong.

    Returns:
        What could be read, by image.
    """
    readers = {".npy": _read_npy, ".npz": _read_npz, ".json": _read_json}
    try:
        return readers[PurePosixPath(path).suffix.lower()](path, data, limits, complaints)
    except ClearLinesError as error:
        complaints.add_error(error, path)
        return []


def _stem(path: str) -> str:
    return composed(PurePosixPath(path).with_suffix("").as_posix())


def _joined(
    file: str, name: str, polylines: list[NDArray[Any] | None], scores: NDArray[np.float64] | None, *, named: bool
) -> RawSegments:
    """Join polylines; ``None`` stands for one that was complained of."""
    usable = [np.zeros((0, 2)) if polyline is None else polyline for polyline in polylines]
    return RawSegments(
        file,
        name,
        np.concatenate([np.zeros((0, 2)), *usable]).astype(np.float64),
        np.array([len(polyline) for polyline in usable], np.int64),
        scores,
        frozenset(index for index, polyline in enumerate(polylines) if polyline is None),
        named,
    )


def _read_npy(path: str, data: bytes, limits: SubmissionLimits, complaints: Complaints) -> list[RawSegments]:
    polylines: list[NDArray[Any] | None] = []
    for index, array in enumerate(read_label_arrays(data, where=path, limits=limits.file)):
        flat = array.ndim in (2, 3) and array.shape[-1] == 2 and (array.ndim == 2 or array.shape[1] == 1)
        if not flat:
            message = f"a segment has shape {array.shape}"
            complaints.add(Problem(message, path, index, expected="(n, 1, 2) or (n, 2)"))
        polylines.append(array.reshape(-1, 2) if flat else None)
    return [_joined(path, _stem(path), polylines, None, named=False)]


def _read_npz(path: str, data: bytes, limits: SubmissionLimits, complaints: Complaints) -> list[RawSegments]:
    arrays = read_arrays(data, path, limits.member_bytes)
    points, offsets = arrays.get("points"), arrays.get("offsets")
    if points is None or offsets is None:
        raise InvalidFile(f"there is no array {'offsets' if offsets is None else 'points'}", expected=NPZ)
    if points.dtype.kind not in "fiu" or points.dtype.itemsize > 8 or points.ndim != 2 or points.shape[1] != 2:
        raise InvalidFile(f"points is {points.dtype} of shape {points.shape}", expected="float32 (M, 2), x and y in px")
    counts = np.diff(_rising(offsets, "offsets", len(points)))
    check_counts(len(counts), len(points), where=path, limits=limits.file)
    scores = arrays.get("scores")
    if scores is not None and (scores.dtype.kind not in "fiu" or scores.shape != (len(counts),)):
        message = f"scores is {scores.dtype} of shape {scores.shape}"
        complaints.add(Problem(message, path, expected=f"float32 ({len(counts)},), one from 0 to 1 for each segment"))
        scores = None
    values = None if scores is None else scores.astype(np.float64)
    whole = points.astype(np.float64)
    if "names" not in arrays:
        return [RawSegments(path, _stem(path), whole, counts, values)]
    names = arrays["names"]
    if names.dtype.kind != "U" or names.ndim != 1:
        raise InvalidFile(f"names is {names.dtype} of shape {names.shape}", expected="(I,) text")
    _check_images(len(names), path, limits)
    if "image_offsets" not in arrays:
        raise InvalidFile("there is no array image_offsets", expected="int64 (I + 1,), from 0 to the segments")
    images = _rising(arrays["image_offsets"], "image_offsets", len(counts))
    if len(images) != len(names) + 1:
        raise InvalidFile("image_offsets doesn't fit names", expected=f"{len(names) + 1} integers")
    starts = np.concatenate([[0], np.cumsum(counts)])
    return [
        RawSegments(
            f"{path}: image {name[:200]}",
            composed(name),
            whole[starts[first] : starts[last]],
            counts[first:last],
            None if values is None else values[first:last],
            named=True,
        )
        for name, first, last in zip(_texts(names), images[:-1].tolist(), images[1:].tolist(), strict=True)
    ]


def _rising(offsets: NDArray[Any], name: str, end: int) -> NDArray[np.int64]:
    if offsets.dtype.kind not in "iu" or offsets.ndim != 1 or len(offsets) == 0:
        raise InvalidFile(f"{name} is {offsets.dtype} of shape {offsets.shape}", expected="int64, one-dimensional")
    whole = offsets.astype(np.int64)
    if whole[0] != 0 or (np.diff(whole) < 0).any() or whole[-1] != end:
        raise InvalidFile(f"{name} doesn't rise from 0 to {end:,}", expected=f"0, then ever larger, at last {end:,}")
    return whole


def _read_json(path: str, data: bytes, limits: SubmissionLimits, complaints: Complaints) -> list[RawSegments]:
    containers = limits.points + 2 * limits.segments + 2 * limits.members + 100
    bytes_taken = limits.file.json_bytes
    document = parse_json(data, where=path, limit=bytes_taken, containers=containers, allow_constants=True)
    if not isinstance(document, dict) or ("images" not in document and "segments" not in document):
        raise InvalidFile("there is no list of segments", expected=JSON)
    if "images" not in document:
        return [_image_from_json(document, path, _stem(path), limits, complaints, named=False)]
    images = document["images"]
    if not isinstance(images, dict):
        raise InvalidFile("images is no object", expected='{"images": {NAME: {"segments": [...]}}}')
    _check_images(len(images), path, limits)
    return [
        _image_from_json(image, f"{path}: image {name[:200]}", composed(name), limits, complaints, named=True)
        for name, image in zip(map(_readable, images), images.values(), strict=True)
    ]


def _check_images(count: int, where: str, limits: SubmissionLimits) -> None:
    if count > limits.members:
        raise TooLarge(f"{count:,} images are too many", where=where, expected=f"at most {limits.members:,}")


def _texts(names: NDArray[np.str_]) -> list[str]:
    try:
        return [_readable(name) for name in names.tolist()]
    except SystemError as error:  # numpy takes four bytes for a character, whatever they are
        raise InvalidFile("names holds what is no character", expected="(I,) text") from error


def _readable(name: str) -> str:
    """Return a name that can be written as UTF-8; a lone surrogate is no character and is spelt out."""
    return name.encode("utf-8", "backslashreplace").decode()


def _image_from_json(
    document: Any, file: str, name: str, limits: SubmissionLimits, complaints: Complaints, *, named: bool
) -> RawSegments:
    entries = document.get("segments") if isinstance(document, dict) else None
    if not isinstance(entries, list):
        complaints.add(Problem("there is no list of segments", file, expected=JSON))
        entries = []
    check_counts(len(entries), 0, where=file, limits=limits.file)
    polylines = [_polyline(entry, file, index, complaints) for index, entry in enumerate(entries)]
    return _joined(file, name, polylines, _scores(entries, file, complaints), named=named)


def _polyline(entry: Any, file: str, index: int, complaints: Complaints) -> NDArray[np.float64] | None:
    points = entry.get("points") if isinstance(entry, dict) else None
    if not isinstance(points, list):
        complaints.add(Problem("a segment has no points", file, index, expected='{"points": [[x, y], ...]}'))
        return None
    if set(map(type, points)) <= {list} and set(map(len, points)) <= {2}:
        flat = list(chain.from_iterable(points))
        if set(map(type, flat)) <= {int, float}:
            # a number beyond every float is as far from an image as infinity
            values = [value if abs(value) < 1e300 else np.inf for value in flat] if _has_huge(flat) else flat
            return np.array(values, dtype=np.float64).reshape(-1, 2)
    place = next(place for place, point in enumerate(points) if not _is_point(point))
    complaints.add(Problem(f"{points[place]!r:.80} is no point", file, index, place, expected="[x, y] in px"))
    return None


def _has_huge(values: list[int | float]) -> bool:
    return any(type(value) is int and abs(value) >= 10**300 for value in values)


def _is_point(point: Any) -> bool:
    return isinstance(point, list) and len(point) == 2 and all(type(value) in (int, float) for value in point)


def _scores(entries: list[Any], file: str, complaints: Complaints) -> NDArray[np.float64] | None:
    given = [entry.get("score") if isinstance(entry, dict) else None for entry in entries]
    if all(value is None for value in given):
        return None
    values = np.full(len(given), 0.0)
    for index, value in enumerate(given):
        if value is None:
            message = "no score, although other segments have one"
            complaints.add(Problem(message, file, index, expected="a score for all segments or for none"))
        elif type(value) not in (int, float):
            complaints.add(Problem(f"{value!r:.80} is no score", file, index, expected="a number from 0 to 1"))
        else:
            values[index] = np.inf if abs(value) >= 1e300 else float(value)
    return values
