"""What the segments of one image must be to be scored: shapes, numbers and sizes, every complaint by its place."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from app.formats.raw_segments import RawSegments
from app.formats.submission_limits import SubmissionLimits
from app.formats.submission_problems import Complaints, Problem
from app.vision.segments import Segments


def check_segments(
    raw: RawSegments, size: tuple[int, int], limits: SubmissionLimits, complaints: Complaints
) -> Segments | None:
    """Check the segments of one image.

    A coordinate may lie outside the image, by as much as the image's longer side: detectors extend lines over the rim.

    Args:
        raw: As the file gives them.
        size: Width and height of the image, px.
        limits: How much an image may have.
        complaints: Gets what is wrong, one complaint for each segment and kind.

    Returns:
        The segments; ``None`` if there was anything to complain of.
    """
    before = complaints.count
    if len(raw.counts) > limits.image_segments:
        message = f"{len(raw.counts):,} segments are too many for one image"
        complaints.add(Problem(message, raw.file, expected=f"at most {limits.image_segments:,}"))
        return None
    _check_counts(raw, limits, complaints)
    _check_points(raw, size, complaints)
    _check_scores(raw, complaints)
    if complaints.count > before or raw.told:
        return None
    offsets = np.concatenate([[0], np.cumsum(raw.counts)]).astype(np.int64)
    scores = None if raw.scores is None else raw.scores.astype(np.float32)
    segments = Segments(raw.points.astype(np.float32), offsets, scores)
    length = float(segments.lengths().sum())
    if length > limits.image_length:
        message = f"the segments of one image are {length:,.0f} px long together"
        complaints.add(Problem(message, raw.file, expected=f"at most {limits.image_length:,.0f} px"))
        return None
    return segments


def _check_counts(raw: RawSegments, limits: SubmissionLimits, complaints: Complaints) -> None:
    for index in np.flatnonzero(raw.counts == 0).tolist():
        if index not in raw.told:
            complaints.add(Problem("a segment has no points", raw.file, index, expected="at least one point"))
    for index in np.flatnonzero(raw.counts > limits.segment_points).tolist():
        message = f"a segment has {int(raw.counts[index]):,} points"
        complaints.add(Problem(message, raw.file, index, expected=f"at most {limits.segment_points:,}"))


def _check_points(raw: RawSegments, size: tuple[int, int], complaints: Complaints) -> None:
    width, height = size
    margin = max(size)
    low, high = np.array([-margin, -margin]), np.array([width + margin, height + margin])
    with np.errstate(invalid="ignore"):
        outside = ~((raw.points >= low) & (raw.points <= high)).all(axis=1)
    finite = np.isfinite(raw.points).all(axis=1)
    frame = f"x and y in px of an image of {width} x {height}"
    for bad, message, hint in (
        (~finite, "a coordinate is not finite", None),
        (
            outside & finite,
            "a point lies far outside the image",
            "x is to the right, y down, in px of the stored image",
        ),
    ):
        for segment, point, more in _first_of_each(np.asarray(bad), raw.counts):
            said = f"{message}, and {more} more of the segment" if more else message
            complaints.add(Problem(said, raw.file, segment, point, frame, hint))


def _first_of_each(bad: NDArray[np.bool_], counts: NDArray[np.int64]) -> list[tuple[int, int, int]]:
    """Return, of each segment with bad points, its index, the first such point and the number of others."""
    rows = np.flatnonzero(bad)
    starts = np.concatenate([[0], np.cumsum(counts)])
    owners = np.searchsorted(starts, rows, side="right") - 1
    segments, first, number = np.unique(owners, return_index=True, return_counts=True)
    places = rows[first] - starts[segments]
    return list(zip(segments.tolist(), places.tolist(), (number - 1).tolist(), strict=True))


def _check_scores(raw: RawSegments, complaints: Complaints) -> None:
    if raw.scores is None:
        return
    for index in np.flatnonzero(~((raw.scores >= 0) & (raw.scores <= 1))).tolist():
        message = f"the score {float(raw.scores[index]):g} is out of range"
        complaints.add(Problem(message, raw.file, index, expected="a number from 0 to 1"))
