"""Splitting chains into arcs.

Long contours bend and turn corners. A run of points that no arc fits is cut where it is farthest from its chord
(Ramer 1972; Douglas & Peucker 1973), all runs of an image at once, until every run is an arc or too short.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

_TOLERANCE = 0.7
_SHORTEST = 6
_POINTS_FOR_CURVATURE = 24
_LARGEST_CURVATURE = 1 / 300


def split(
    along: NDArray[np.float64], across: NDArray[np.float64], offsets: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Split chains into runs that an arc fits to 0.7 px.

    The point of a cut belongs to neither side: a corner's position is no measurement of either edge.

    Args:
        along: float64 ``(m,)`` px, rising in each chain.
        across: float64 ``(m,)`` px.
        offsets: int64 ``(c + 1,)``, where the chains begin.

    Returns:
        First and one-past-last indices of the runs, int64 ``(r,)`` each, in rising order; each has 6 points or more.
    """
    start, stop = offsets[:-1].astype(np.int64), offsets[1:].astype(np.int64)
    done: list[tuple[NDArray[np.int64], NDArray[np.int64]]] = []
    while True:
        long_enough = stop - start >= _SHORTEST
        start, stop = start[long_enough], stop[long_enough]
        if not len(start):
            break
        fits, cut = _examine(along, across, start, stop)
        done.append((start[fits], stop[fits]))
        start, stop, cut = start[~fits], stop[~fits], cut[~fits]
        start, stop = np.concatenate([start, cut + 1]), np.concatenate([cut, stop])
    if not done:
        return np.zeros(0, np.int64), np.zeros(0, np.int64)
    first, last = (np.concatenate(part) for part in zip(*done, strict=True))
    order = np.argsort(first)
    return first[order], last[order]


def _examine(
    along: NDArray[np.float64], across: NDArray[np.float64], start: NDArray[np.int64], stop: NDArray[np.int64]
) -> tuple[NDArray[np.bool_], NDArray[np.int64]]:
    """Whether an arc fits each run, and the point farthest from its chord."""
    counts = stop - start
    bounds = np.concatenate([[0], np.cumsum(counts)])
    first = bounds[:-1]
    rows = np.arange(bounds[-1]) + np.repeat(start - first, counts)

    def spread(values: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.repeat(values, counts)

    def mean(values: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.add.reduceat(values, first) / counts

    u, v = along[rows], across[rows]
    u = u - spread(mean(u))
    v = v - spread(mean(v))
    uu = mean(u * u)
    tilt = mean(u * v) / uu
    cosine = 1 / np.sqrt(1 + tilt**2)
    residual = v - spread(tilt) * u
    # parabola by a polynomial orthogonal to 1 and u; curvature = 2 b cos^3
    square = u * u - spread(uu) - spread(mean(u**3) / uu) * u
    norm = mean(square * square)
    b = np.where(norm > 0, mean(residual * square) / np.where(norm > 0, norm, 1), 0)
    limit = np.where(counts >= _POINTS_FOR_CURVATURE, _LARGEST_CURVATURE / (2 * cosine**3), 0)
    residual -= spread(np.clip(b, -limit, limit)) * square
    fits = np.maximum.reduceat(np.abs(residual), first) * cosine <= _TOLERANCE

    chord = (v[bounds[1:] - 1] - v[first]) / (u[bounds[1:] - 1] - u[first])
    deviation = np.abs(v - spread(v[first]) - spread(chord) * (u - spread(u[first])))
    deviation[first] = deviation[bounds[1:] - 1] = -1
    largest = np.maximum.reduceat(deviation, first)
    at_largest = np.flatnonzero(deviation == spread(largest))
    _, position = np.unique(np.repeat(np.arange(len(counts)), counts)[at_largest], return_index=True)
    return fits, rows[at_largest[position]]
