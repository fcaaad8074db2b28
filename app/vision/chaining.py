"""Linking edge points into ordered open chains.

Each pass is linked column to column (row to row): its edges are single-valued, so a chain holds at most one point per
column, no point twice, and has no branches. Hysteresis follows Canny, IEEE TPAMI 8(6), 1986.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.vision.subpixel import EdgePoints

_LONGEST_STEP = 3
_SHORTEST_CHAIN = 5
_LARGEST_TURN = 0.8


@dataclass(frozen=True, eq=False)
class Chains:
    """Ordered chains of points of one pass.

    Attributes:
        rows: int64 ``(m,)``, rows of the edge points, chain after chain, rising along the axis in each.
        offsets: int64 ``(c + 1,)``; chain ``i`` is ``rows[offsets[i]:offsets[i + 1]]``.
    """

    rows: NDArray[np.int64]
    offsets: NDArray[np.int64]


def chain(points: EdgePoints, low: float, high: float) -> Chains:
    """Link edge points and keep the chains that are strong somewhere.

    Args:
        points: Edge points of one pass.
        low: Points with a gradient norm up to this are left out.
        high: A chain is kept when one of its points is above this.
    """
    following = link(points, points.norm > low)
    first = _first_of_chain(following)
    sizes = np.bincount(first, minlength=len(points))
    strongest = np.zeros(len(points), np.float32)
    np.maximum.at(strongest, first, points.norm)
    kept = (sizes >= _SHORTEST_CHAIN) & (strongest > high)
    rows = np.flatnonzero(kept[first])
    rows = rows[np.lexsort((points.along[rows], first[rows]))]
    starts = np.flatnonzero(np.diff(first[rows], prepend=-1))
    return Chains(rows, np.append(starts, len(rows)).astype(np.int64))


def link(points: EdgePoints, usable: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Find the point that follows each point, -1 where a chain ends.

    A point is followed by one with the same sign, one to three columns on, that lies within ``0.7 + 0.3 k`` px of
    where the mean of both slopes puts it; the slopes differ by at most 0.8. Two points are linked when each is the
    other's nearest; nearer columns come first.

    Args:
        points: Edge points of one pass.
        usable: bool ``(n,)``, the points that may be linked.
    """
    count = len(points)
    following = np.full(count, -1, np.int64)
    preceded = ~usable
    for step in range(1, _LONGEST_STEP + 1):
        open_ends = np.flatnonzero(usable & (following < 0))
        source, target, distance = _pairs(points, open_ends, step)
        free = ~preceded[target]
        source, target, distance = source[free], target[free], distance[free]
        nearest_target = np.full(count, np.inf)
        nearest_source = np.full(count, np.inf)
        np.minimum.at(nearest_target, source, distance)
        np.minimum.at(nearest_source, target, distance)
        mutual = (distance == nearest_target[source]) & (distance == nearest_source[target])
        source, target = _one_to_one(source[mutual], target[mutual])
        following[source] = target
        preceded[target] = True
    return following


def _pairs(
    points: EdgePoints, source: NDArray[np.int64], step: int
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]:
    """Pairs of points ``step`` columns apart that may follow each other, with their misfit in px."""
    ahead = points.along[source] + step
    expected = np.rint(points.across[source] + points.slope[source] * step).astype(np.int64)
    found = []
    # wide enough for every pair that both slopes allow, or the direction of linking would matter
    for shift in (-2, -1, 0, 1, 2):
        target = points.find(ahead, expected + shift)
        there = target >= 0
        found.append((source[there], target[there].astype(np.int64)))
    first, second = (np.concatenate(part) for part in zip(*found, strict=True))
    slope = 0.5 * (points.slope[first] + points.slope[second])
    distance = np.abs(points.across[second] - points.across[first] - slope * step)
    good = (points.sign[first] == points.sign[second]) & (distance <= 0.7 + 0.3 * step)
    good &= np.abs(points.slope[first] - points.slope[second]) <= _LARGEST_TURN
    return first[good], second[good], distance[good]


def _one_to_one(source: NDArray[np.int64], target: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Break the ties: of several pairs with one source or one target the first stays."""
    _, first = np.unique(source, return_index=True)
    source, target = source[first], target[first]
    _, first = np.unique(target, return_index=True)
    return source[first], target[first]


def _first_of_chain(following: NDArray[np.int64]) -> NDArray[np.int64]:
    """First point of each point's chain, by pointer jumping (rounds: logarithm of the longest chain)."""
    first = np.arange(len(following))
    linked = np.flatnonzero(following >= 0)
    first[following[linked]] = linked
    while True:
        further = first[first]
        if np.array_equal(further, first):
            return first
        first = further
