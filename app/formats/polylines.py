"""From the arrays of a foreign file to `Segments`, with every complaint naming segment and point."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from app.errors import InvalidFile, TooLarge
from app.formats.limits import COORDINATE_LIMIT, SEGMENT_LIMITS, SegmentLimits
from app.vision.segments import Segments


def check_counts(segments: int, points: int, *, where: str, limits: SegmentLimits = SEGMENT_LIMITS) -> None:
    """Refuse more segments or points than one image may have.

    Raises:
        TooLarge: Over a limit.
    """
    if segments > limits.segments:
        raise TooLarge(f"{segments:,} segments are too many", where=where, expected=f"at most {limits.segments:,}")
    if points > limits.points:
        raise TooLarge(f"{points:,} points are too many", where=where, expected=f"at most {limits.points:,}")


def check_file_size(size: int, *, where: str, limit: int) -> None:
    """Refuse a file of more bytes than the limit.

    Raises:
        TooLarge: Over the limit.
    """
    if size > limit:
        raise TooLarge(f"the file has {size:,} bytes", where=where, expected=f"at most {limit:,}")


def check_coordinates(points: NDArray[np.generic], offsets: NDArray[np.int64], *, where: str) -> None:
    """Refuse coordinates ``(N, 2)`` that aren't finite or lie far outside any image.

    Raises:
        InvalidFile: With the first such segment and point.
    """
    values = points.astype(np.float64, copy=False)
    with np.errstate(invalid="ignore"):
        bad = ~(np.abs(values) <= COORDINATE_LIMIT).all(axis=1)
    if not bad.any():
        return
    row = int(np.flatnonzero(bad)[0])
    segment = int(np.searchsorted(offsets, row, side="right") - 1)
    finite = bool(np.isfinite(values[row]).all())
    raise InvalidFile(
        "a coordinate lies far outside any image" if finite else "a coordinate is not finite",
        where=f"{where}: segment {segment}, point {row - int(offsets[segment])}",
        expected=f"x and y in px, between {-COORDINATE_LIMIT:g} and {COORDINATE_LIMIT:g}",
        details={"bad_points": int(bad.sum())},
    )


def segments_from_arrays(
    arrays: Sequence[NDArray[np.generic]], *, where: str, limits: SegmentLimits = SEGMENT_LIMITS
) -> Segments:
    """Join polylines, each a numeric ``(n, 2)`` or ``(n, 1, 2)`` in px, into one `Segments` without scores.

    Args:
        arrays: One array per segment.
        where: The file, for messages.
        limits: How many segments and points are taken.

    Raises:
        InvalidFile: On a wrong shape, an empty segment, or a coordinate that isn't usable.
        TooLarge: Over a limit.
    """
    polylines = [_flat(array, index, where) for index, array in enumerate(arrays)]
    counts = np.array([len(polyline) for polyline in polylines], dtype=np.int64)
    check_counts(len(polylines), int(counts.sum()), where=where, limits=limits)
    offsets = np.concatenate([np.zeros(1, np.int64), np.cumsum(counts)])
    points = np.concatenate(polylines) if polylines else np.zeros((0, 2))
    check_coordinates(points, offsets, where=where)
    return Segments(points.astype(np.float32), offsets)


def _flat(array: NDArray[np.generic], index: int, where: str) -> NDArray[np.generic]:
    fits = array.ndim in (2, 3) and array.shape[-1] == 2 and (array.ndim == 2 or array.shape[1] == 1)
    if not fits:
        raise InvalidFile(
            f"a segment has shape {array.shape}", where=f"{where}: segment {index}", expected="(n, 1, 2) or (n, 2)"
        )
    if array.shape[0] == 0:
        raise InvalidFile("a segment has no points", where=f"{where}: segment {index}", expected="at least one point")
    return array.reshape(-1, 2)
