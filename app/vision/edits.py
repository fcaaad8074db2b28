"""Edits of segments by hand, as pure geometry: cutting in two, trimming an end, joining two.

Measured points are never moved and none is made up: a join leaves a gap without points where nothing was measured, as
the pipeline does.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from app.errors import InvalidInput

Array = NDArray[np.float64]
Points = NDArray[np.float32]

LARGEST_TURN = 20.0
"""Degrees; two segments that turn more than this against each other are no straight line."""
MOST_SIDEWAYS = 3.0
"""px beside the line of one segment that the other may begin, and...."""
SIDEWAYS_PER_GAP = 0.1
"""...how much farther per px of the gap."""

_DIRECTION = 60.0


@dataclass(frozen=True, eq=False)
class Junction:
    """Two segments that follow each other.

    Attributes:
        before: float32 ``(n, 2)`` px, ends at the gap.
        after: float32 ``(m, 2)`` px, starts behind it; what would overlap the other is left out.
        gap: Its length, px.
    """

    before: Points
    after: Points
    gap: float


def cut(points: NDArray[Any], place: ArrayLike) -> tuple[Points, Points]:
    """Cut a segment in two at the place on it that is nearest to a given one.

    Args:
        points: ``(n, 2)`` px in order.
        place: float ``(2,)`` px.

    Returns:
        Both parts, each of two points or more: together all points, in order.

    Raises:
        InvalidInput: When a part would have less than two points.
    """
    given = _checked(points)
    after = _leg_near(given, place) + 1
    if not 2 <= after <= len(given) - 2:
        raise InvalidInput(
            "the cut is too near an end of the segment",
            where="at",
            expected="at least two points on either side",
            hint="point at the place to cut at",
        )
    return given[:after].copy(), given[after:].copy()


def trim(points: NDArray[Any], place: ArrayLike) -> Points:
    """Take off the shorter of the two parts that a segment has on either side of a place.

    Args:
        points: ``(n, 2)`` px in order.
        place: float ``(2,)`` px.

    Returns:
        What is left, float32 ``(m, 2)``.

    Raises:
        InvalidInput: When nothing would be taken off, or less than two points left.
    """
    given = _checked(points)
    after = _leg_near(given, place) + 1
    first, second = given[:after], given[after:]
    kept, taken = (second, first) if _length(first) < _length(second) else (first, second)
    if len(kept) < 2 or not len(taken):
        raise InvalidInput("nothing is left to trim there", where="at", hint="point at the segment, inside its ends")
    return kept.copy()


def junction(one: NDArray[Any], other: NDArray[Any]) -> Junction:
    """Turn and order two segments so that the second follows the first.

    Args:
        one: ``(n, 2)`` px in order.
        other: ``(m, 2)`` px in order.

    Raises:
        InvalidInput: When they don't follow each other on one line.
    """
    both = [_checked(one), _checked(other)]
    spans = [each[-1].astype(np.float64) - each[0] for each in both]
    along = max(spans, key=lambda span: float(np.hypot(*span)))
    # both run the same way, the one that starts farther on comes second
    both = [each if span @ along >= 0 else each[::-1] for each, span in zip(both, spans, strict=True)]
    before, after = sorted(both, key=lambda each: float(each[0] @ along))
    outward, inward = -_direction(before[::-1]), _direction(after)
    turn = float(np.degrees(np.arccos(np.clip(outward @ inward, -1, 1))))
    if turn > LARGEST_TURN:
        raise InvalidInput(
            f"the two segments turn {turn:.0f} degrees against each other",
            where="replaces",
            expected=f"at most {LARGEST_TURN:.0f} degrees",
            hint="only parts of one straight edge can be joined",
        )
    beyond = (after.astype(np.float64) - before[-1]) @ outward > 0
    rest = after[int(np.argmax(beyond)) :] if beyond.any() else after[:0]
    if len(rest) < 2:
        raise InvalidInput(
            "the two segments lie beside each other",
            where="replaces",
            expected="segments that follow each other",
            hint="reject the one that is too much",
        )
    vector = rest[0].astype(np.float64) - before[-1]
    gap, sideways = float(np.hypot(*vector)), abs(float(outward[0] * vector[1] - outward[1] * vector[0]))
    if sideways > MOST_SIDEWAYS + SIDEWAYS_PER_GAP * gap:
        raise InvalidInput(
            f"the second segment begins {sideways:.0f} px beside the line of the first",
            where="replaces",
            expected=f"at most {MOST_SIDEWAYS + SIDEWAYS_PER_GAP * gap:.0f} px over a gap of {gap:.0f} px",
            hint="only parts of one straight edge can be joined",
        )
    return Junction(before.copy(), rest.copy(), gap)


def joined(junction: Junction, between: NDArray[Any] | None = None) -> Points:
    """Return a junction as one segment.

    Args:
        junction: The two segments.
        between: ``(k, 2)`` px, points measured in the gap, in order; none where no edge runs there.
    """
    if between is None or not len(between):
        return np.concatenate([junction.before, junction.after])
    start, stop = junction.before[-1].astype(np.float64), junction.after[0].astype(np.float64)
    chord = stop - start
    share = (np.asarray(between, np.float64) - start) @ chord / max(float(chord @ chord), 1e-12)
    # what was measured beside the ends is theirs already
    margin = 0.5 / max(float(np.hypot(*chord)), 1.0)
    inside = np.asarray(between, np.float32)[(share > margin) & (share < 1 - margin)]
    return np.concatenate([junction.before, inside, junction.after])


def _checked(points: NDArray[Any]) -> Points:
    given = np.ascontiguousarray(points, dtype=np.float32)
    if given.ndim != 2 or given.shape[1] != 2 or len(given) < 2:
        raise InvalidInput("a segment of less than two points can't be edited", where="replaces")
    return given


def _leg_near(points: Points, place: ArrayLike) -> int:
    """Return the index of the point that the polyline's leg nearest to a place begins at."""
    start = points[:-1].astype(np.float64)
    leg = points[1:] - start
    relative = np.asarray(place, np.float64).reshape(2) - start
    squares = np.maximum((leg * leg).sum(axis=1), 1e-12)
    share = np.clip((relative * leg).sum(axis=1) / squares, 0, 1)
    return int(np.argmin(np.hypot(*(relative - share[:, None] * leg).T)))


def _length(points: Points) -> float:
    return float(np.hypot(*np.diff(points.astype(np.float64), axis=0).T).sum()) if len(points) > 1 else 0.0


def _direction(points: Points) -> Array:
    """Return the unit vector from a segment's first point into it, over a stretch that noise doesn't turn."""
    away = points.astype(np.float64) - points[0]
    far = int(np.argmax(np.hypot(*away.T) >= min(_DIRECTION, float(np.hypot(*away[-1])))))
    vector = away[far] if np.hypot(*away[far]) > 0 else away[-1]
    return vector / max(float(np.hypot(*vector)), 1e-12)
