"""How a candidate lies among the others: doubles, parallels, continuations, corners."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.review.strands import Strands

Array = NDArray[np.float64]

PARALLEL = np.deg2rad(4.0)
"""rad; candidates that differ by less run along one another."""
CORNER = np.deg2rad(25.0)
"""rad; candidates that differ by more may meet in a corner."""
ANGLES = 180
"""Directions that lengths are summed over, half a turn in all."""
DOUBLE, TWO_EDGES = 5.0, 1.5
"""px; parallel candidates nearer than this are one edge found twice; those farther apart are two edges."""
FAR = 200.0
"""px; farther neighbours count as this far."""
AROUND = 0.2
"""Image diagonals that parallel candidates are counted in."""

NEIGHBOURHOOD = (
    "double of a longer one",
    "double of a better one",
    "doubles",
    "parallel distance",
    "parallel length",
    "parallel score",
    "longer parallel distance",
    "parallels near",
    "parallels around",
    "parallel length around",
    "continuation gap",
    "continuation length",
    "corners",
    "crossings",
    "direction share",
    "density",
    "score around",
)


def neighbourhood(strands: Strands) -> Array:
    """Return the columns of `NEIGHBOURHOOD`, float64 ``(S, 17)``; distances as logarithms of px."""
    count = len(strands)
    if not count:
        return np.zeros((0, len(NEIGHBOURHOOD)))
    scores = np.where(np.isfinite(strands.scores), strands.scores, 0.5)
    weight = strands.length * (0.05 + scores)
    direction, middle = strands.direction.astype(np.float32), strands.middle.astype(np.float32)
    sine = np.abs(np.outer(direction[:, 0], direction[:, 1]) - np.outer(direction[:, 1], direction[:, 0]))
    near = np.abs(middle[:, None, 0] - middle[None, :, 0]) + np.abs(middle[:, None, 1] - middle[None, :, 1])
    half = (strands.length / 2).astype(np.float32)
    # |dx| + |dy| is up to sqrt(2) times the distance
    within = np.maximum(AROUND * strands.diagonal, FAR + half[:, None] + half[None])
    parallel = (sine < np.sin(PARALLEL)) & (near < 1.4143 * within)
    reach = half + np.float32(_CLOSE * strands.diagonal)
    meeting = (sine > np.sin(CORNER)) & (near < 1.4143 * (reach[:, None] + reach[None]))
    around = near < 0.15 * strands.diagonal
    for pairs in (parallel, around):
        np.fill_diagonal(pairs, False)
    number = around.sum(axis=1)
    return np.column_stack(
        [
            _along_others(strands, scores, weight, *np.nonzero(parallel)),
            *_meetings(strands, *np.nonzero(meeting)),
            _direction_share(strands, weight),
            number,
            (around @ scores.astype(np.float32)) / np.maximum(number, 1),
        ]
    )


_CLOSE = 0.012
"""Image diagonals; an end that is nearer to another candidate meets it."""


def _along_others(
    strands: Strands, scores: Array, weight: Array, row: NDArray[np.int64], other: NDArray[np.int64]
) -> Array:
    """Return the columns about parallel candidates, float64 ``(S, 12)``.

    Args:
        strands: The candidates.
        scores: float64 ``(S,)``.
        weight: float64 ``(S,)``.
        row: int64 ``(P,)``, rising: the candidate of each pair that is described.
        other: int64 ``(P,)``, the parallel one.
    """
    rows = Rows(row, len(strands))
    length = strands.length
    mine, its = length[row], length[other]
    offset = strands.middle[other] - strands.middle[row]
    direction = strands.direction[row]
    along = np.abs((offset * direction).sum(axis=1))
    across = np.abs(offset[:, 1] * direction[:, 0] - offset[:, 0] * direction[:, 1])
    distance = np.hypot(along, across)
    shorter = np.minimum(mine, its)
    gap = along - (mine + its) / 2
    overlap = np.clip(-gap, 0, shorter)
    beside = overlap > 0.3 * shorter
    double = beside & (across < DOUBLE)
    covered = np.where(double, overlap / np.maximum(mine, 1), 0.0)
    apart = np.where(beside & (across >= TWO_EDGES), across, np.inf)
    around = distance < AROUND * strands.diagonal
    follows = (across < np.maximum(3, 0.03 * mine)) & (gap > -0.15 * mine) & (gap < FAR)
    gaps = np.where(follows, np.maximum(gap, 0), np.inf)
    least, nearest = rows.least(apart)
    least_gap, following = rows.least(gaps)

    def of(pair: NDArray[np.int64], values: Array) -> Array:
        """Return values of the pairs chosen, one for each candidate; 0 where there is none."""
        return np.where(pair >= 0, values[np.maximum(pair, 0)], 0.0) if len(values) else np.zeros(len(strands))

    ratio = np.log((its + 1) / (mine + 1))
    columns = [
        rows.most(np.where(its > mine, covered, 0.0)),
        rows.most(np.where(scores[other] > scores[row], covered, 0.0)),
        rows.sum(double),
        np.log1p(np.minimum(least, FAR)),
        of(nearest, ratio),
        of(nearest, scores[other] - scores[row]),
        np.log1p(np.minimum(rows.least(np.where(its > 1.2 * mine, apart, np.inf))[0], FAR)),
        rows.sum(beside & (across < 0.03 * strands.diagonal)),
        rows.sum(around),
        rows.sum(np.where(around, weight[other], 0.0)) / strands.diagonal,
        np.log1p(np.minimum(least_gap, FAR)),
        of(following, ratio),
    ]
    return np.stack(columns, axis=1)


def _meetings(strands: Strands, row: NDArray[np.int64], other: NDArray[np.int64]) -> tuple[Array, Array]:
    """Return how many ends of each candidate meet others, and how many others cross it."""
    rows = Rows(row, len(strands))
    half = strands.length[other] / 2
    direction, middle = strands.direction[other], strands.middle[other]
    ends = np.zeros(len(strands))
    sides = []
    for end in (strands.start, strands.end):
        offset = end[row] - middle
        along = (offset * direction).sum(axis=1)
        across = offset[:, 1] * direction[:, 0] - offset[:, 0] * direction[:, 1]
        meets = np.hypot(across, np.maximum(np.abs(along) - half, 0)) < _CLOSE * strands.diagonal
        ends += rows.most(meets.astype(np.float64))
        sides.append((along, across))
    (along_start, start), (along_end, end) = sides
    crossing = start * end < 0
    share = np.where(crossing, start / np.where(crossing, start - end, 1.0), 0.0)
    at = along_start + share * (along_end - along_start)
    return ends, rows.sum(crossing & (np.abs(at) < half))


def _direction_share(strands: Strands, weight: Array) -> Array:
    """Return the share of all weight that runs like each candidate, give or take some degrees, float64 ``(S,)``."""
    angle = np.arctan2(strands.direction[:, 1], strands.direction[:, 0]) % np.pi
    width = np.pi / ANGLES
    centres = (np.arange(ANGLES) + 0.5) * width
    turn = np.abs(angle[:, None] - centres[None])
    near = np.exp(-0.5 * (np.minimum(turn, np.pi - turn) / np.deg2rad(3.0)) ** 2)
    spread = near / near.sum(axis=1, keepdims=True)
    return near @ (weight @ spread) / max(float(weight.sum()), 1e-9)


class Rows:
    """Pairs in rising order of their row, reduced to one value for each row."""

    def __init__(self, row: NDArray[np.int64], count: int) -> None:
        self._row, self._count = row, count
        self._present, self._starts = np.unique(row, return_index=True)

    def sum(self, values: NDArray[Any]) -> Array:
        """Return the sum of each row's values, float64 ``(count,)``."""
        return np.asarray(np.bincount(self._row, values.astype(np.float64), self._count), np.float64)

    def most(self, values: Array) -> Array:
        """Return the greatest of each row's values, which are 0 or more, float64 ``(count,)``; 0 without any."""
        found = np.zeros(self._count)
        if len(values):
            found[self._present] = np.maximum.reduceat(values, self._starts)
        return found

    def least(self, values: Array) -> tuple[Array, NDArray[np.int64]]:
        """Return the least of each row's values, infinite without any, and the pair that has it, -1 without any."""
        found, pair = np.full(self._count, np.inf), np.full(self._count, -1, np.int64)
        if len(values):
            found[self._present] = np.minimum.reduceat(values, self._starts)
            at = np.flatnonzero(np.isfinite(values) & (values == found[self._row]))
            pair[self._row[at[::-1]]] = at[::-1]  # of equal ones the first stays
        return found, pair
