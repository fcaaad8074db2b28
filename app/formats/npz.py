"""Read and write npz: ``points``, ``offsets``, ``scores``, ``straightness`` and, of labels, ``verdicts``.

An npz is a zip of plain arrays. The sizes in its directory and in each array's header are compared with the limits
before anything is unpacked, and no array that would need unpickling is accepted.
"""

from __future__ import annotations

import io
from collections import Counter
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.errors import ClearLinesError, InvalidFile, TooLarge
from app.formats.inert_npy import array_from_npy
from app.formats.labelled import LabelledSegments
from app.formats.limits import SEGMENT_LIMITS, SET_LIMITS, SegmentLimits, SetLimits
from app.formats.naming import check_names, composed
from app.formats.polylines import check_coordinates, check_counts, check_file_size
from app.formats.zips import open_zip, read_member
from app.verdicts import VERDICTS
from app.vision.segments import Segments

MEMBER_LIMIT = 32
ARRAYS = ("points", "offsets", "scores", "straightness", "verdicts", "names", "image_offsets")
SET_ARRAYS = ("names", "image_offsets")


def read_npz(data: bytes, *, where: str = "file", limits: SegmentLimits = SEGMENT_LIMITS) -> LabelledSegments:
    """Read the segments of one image.

    Args:
        data: The file.
        where: Its name, for messages.
        limits: How many bytes, segments and points are taken.

    Raises:
        InvalidFile: If an array is missing, of the wrong kind or shape, or broken.
        TooLarge: Over a limit.
    """
    arrays = read_arrays(data, where, limits.file_bytes)
    if "names" in arrays:
        raise InvalidFile("the file holds several images", where=where, hint="use it as the one file for all images")
    points, offsets = _points(arrays, where), _offsets(arrays, "offsets", where)
    check_counts(len(offsets) - 1, len(points), where=where, limits=limits)
    return _labelled(arrays, points, offsets, where)


def read_npz_set(data: bytes, *, where: str = "file", limits: SetLimits = SET_LIMITS) -> Mapping[str, LabelledSegments]:
    """Read the segments of all images from one file.

    ``names`` (I,) are the images, image i has the segments ``image_offsets[i]:image_offsets[i + 1]``, segment s of the
    file the points ``offsets[s]:offsets[s + 1]``.
    """
    arrays = read_arrays(data, where, limits.file_bytes)
    names = _array(arrays, "names", where)
    if names.dtype.kind != "U" or names.ndim != 1:
        raise InvalidFile(f"names is {names.dtype} of shape {names.shape}", where=where, expected="(I,) text")
    if len(names) > limits.images:
        raise TooLarge(f"{len(names):,} images are too many", where=where, expected=f"at most {limits.images:,}")
    keys = [composed(str(name)) for name in names]
    check_names(keys, where=where)
    if len(set(keys)) < len(keys):
        twice = Counter(keys).most_common(1)[0][0]
        raise InvalidFile(f"the image {twice!r} is named twice", where=where, expected="each name once")
    points, offsets = _points(arrays, where), _offsets(arrays, "offsets", where)
    images = _offsets(arrays, "image_offsets", where)
    bounds = SegmentLimits(limits.file_bytes, limits.json_bytes, limits.segments, limits.points)
    check_counts(len(offsets) - 1, len(points), where=where, limits=bounds)
    if len(images) != len(keys) + 1 or images[-1] != len(offsets) - 1:
        raise InvalidFile(
            "image_offsets doesn't fit names and offsets",
            where=where,
            expected=f"{len(keys) + 1} integers from 0 to {len(offsets) - 1}",
        )
    whole = _labelled(arrays, points, offsets, where)
    found: dict[str, LabelledSegments] = {}
    for key, start, stop in zip(keys, images[:-1].tolist(), images[1:].tolist(), strict=True):
        here = f"{where}: image {key}"
        part = _part(whole, start, stop)
        check_counts(len(part), len(part.segments.points), where=here, limits=limits.image)
        found[key] = part
    return found


def write_npz(labelled: LabelledSegments) -> bytes:
    """Write the segments of one image; origins, ids and reasons are left out, and so is what is unknown."""
    segments = labelled.segments
    arrays: dict[str, NDArray[Any]] = {"points": segments.points, "offsets": segments.offsets}
    if segments.scores is not None:
        arrays["scores"] = segments.scores
    if labelled.straightness is not None:
        arrays["straightness"] = labelled.straightness
    if labelled.verdicts is not None:
        arrays["verdicts"] = np.array([verdict or "" for verdict in labelled.verdicts], dtype="<U9")
    return _dump(arrays)


def write_npz_set(images: Iterable[tuple[str, LabelledSegments]]) -> bytes:
    """Write the segments of all images, given as (name, segments), into one file.

    ``scores``, ``straightness`` and ``verdicts`` are written where every image has them.
    """
    pairs = list(images)
    parts = [labelled for _, labelled in pairs]
    filled = [part for part in parts if len(part)]
    arrays: dict[str, NDArray[Any]] = {
        "names": np.array([name for name, _ in pairs], dtype=np.str_),
        "image_offsets": np.cumsum([0, *(len(part) for part in parts)], dtype=np.int64),
        "offsets": np.cumsum(np.concatenate([[0], *(part.segments.counts for part in parts)]), dtype=np.int64),
        "points": np.concatenate([np.zeros((0, 2), np.float32), *(part.segments.points for part in parts)]),
    }
    scores = [part.segments.scores for part in filled]
    straightness = [part.straightness for part in filled]
    verdicts = [part.verdicts for part in filled]
    if all(values is not None for values in scores):
        arrays["scores"] = _join(scores)
    if filled and all(values is not None for values in straightness):
        arrays["straightness"] = _join(straightness)
    if filled and all(values is not None for values in verdicts):
        words = [verdict or "" for values in verdicts for verdict in values or ()]
        arrays["verdicts"] = np.array(words, dtype="<U9")
    return _dump(arrays)


def is_npz_set(data: bytes, *, where: str = "file") -> bool:
    """Whether an npz holds several images: whether its directory lists ``names``."""
    with open_zip(data, where=where, members=MEMBER_LIMIT) as archive:
        return "names.npy" in archive.namelist()


def _join(values: list[Any]) -> NDArray[np.float32]:
    return np.concatenate([np.zeros(0, np.float32), *values])


def _dump(arrays: Mapping[str, NDArray[Any]]) -> bytes:
    stream = io.BytesIO()
    np.savez_compressed(stream, allow_pickle=False, **arrays)
    return stream.getvalue()


def read_arrays(data: bytes, where: str, limit: int) -> dict[str, NDArray[Any]]:
    """Return the arrays of the file that are known here, by name, as they are: nothing is checked but their sizes.

    Args:
        data: The file.
        where: Its name, for messages.
        limit: Bytes that it may have, packed and unpacked.

    Raises:
        InvalidFile: If it is no npz, broken, or an array would need unpickling.
        TooLarge: Over the limit.
    """
    check_file_size(len(data), where=where, limit=limit)
    arrays: dict[str, NDArray[Any]] = {}
    left = limit
    with open_zip(data, where=where, members=MEMBER_LIMIT) as archive:
        wanted = [info for info in archive.infolist() if info.filename.removesuffix(".npy") in ARRAYS]
        if len({info.filename for info in wanted}) < len(wanted):
            raise InvalidFile("an array is in the file twice", where=where)
        for info in wanted:
            name = info.filename.removesuffix(".npy")
            member = read_member(archive, info, where=f"{where}: {name}", limit=left)
            left -= len(member)
            arrays[name] = array_from_npy(member, where=f"{where}: {name}")
    return arrays


def _array(arrays: Mapping[str, NDArray[Any]], name: str, where: str) -> NDArray[Any]:
    if name not in arrays:
        raise InvalidFile(f"there is no array {name}", where=where, expected="points (M, 2) and offsets (S + 1,)")
    return arrays[name]


def _points(arrays: Mapping[str, NDArray[Any]], where: str) -> NDArray[Any]:
    points = _array(arrays, "points", where)
    if points.dtype.kind not in "fiu" or points.dtype.itemsize > 8 or points.ndim != 2 or points.shape[1] != 2:
        raise InvalidFile(
            f"points is {points.dtype} of shape {points.shape}", where=where, expected="float32 (M, 2), x and y in px"
        )
    return points


def _offsets(arrays: Mapping[str, NDArray[Any]], name: str, where: str) -> NDArray[np.int64]:
    offsets = _array(arrays, name, where)
    if offsets.dtype.kind not in "iu" or offsets.ndim != 1 or len(offsets) == 0:
        raise InvalidFile(f"{name} is {offsets.dtype} of shape {offsets.shape}", where=where, expected="int64 (S + 1,)")
    whole = offsets.astype(np.int64)
    if whole[0] != 0 or (np.diff(whole) < 0).any() or (offsets > 2**62).any():
        raise InvalidFile(f"{name} doesn't rise from 0", where=where, expected="0, then ever larger")
    return whole


def _fractions(arrays: Mapping[str, NDArray[Any]], name: str, count: int, where: str) -> NDArray[np.float32] | None:
    values = arrays.get(name)
    if values is None:
        return None
    if values.dtype.kind not in "fiu" or values.shape != (count,):
        raise InvalidFile(
            f"{name} is {values.dtype} of shape {values.shape}", where=where, expected=f"float32 ({count},)"
        )
    outside = np.flatnonzero(~((values >= 0) & (values <= 1)))
    if len(outside):
        segment = int(outside[0])
        raise InvalidFile(
            f"{values[segment]!s} is out of range",
            where=f"{where}: segment {segment}, {name}",
            expected="a number from 0 to 1",
        )
    return values.astype(np.float32)


def _verdicts(arrays: Mapping[str, NDArray[Any]], count: int, where: str) -> tuple[str | None, ...] | None:
    values = arrays.get("verdicts")
    if values is None:
        return None
    if values.dtype.kind != "U" or values.shape != (count,):
        raise InvalidFile(
            f"verdicts is {values.dtype} of shape {values.shape}", where=where, expected=f"text ({count},)"
        )
    words = [str(value) for value in values]
    for segment, word in enumerate(words):
        if word and word not in VERDICTS:
            raise InvalidFile(
                f"{word!r:.80} is no verdict", where=f"{where}: segment {segment}", expected=", ".join(VERDICTS)
            )
    return tuple(word or None for word in words)


def _labelled(
    arrays: Mapping[str, NDArray[Any]], points: NDArray[Any], offsets: NDArray[np.int64], where: str
) -> LabelledSegments:
    check_coordinates(points, offsets, where=where)
    count = len(offsets) - 1
    try:
        segments = Segments(points.astype(np.float32), offsets, _fractions(arrays, "scores", count, where))
    except InvalidFile:
        raise
    except ClearLinesError as error:
        raise InvalidFile(error.message, where=f"{where}: {error.where}", expected=error.expected) from error
    return LabelledSegments(segments, _fractions(arrays, "straightness", count, where), _verdicts(arrays, count, where))


def _part(whole: LabelledSegments, start: int, stop: int) -> LabelledSegments:
    return whole.select(np.arange(start, stop))
