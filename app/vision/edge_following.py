"""Extending a segment along its edge at both ends, by the pipeline's own extension.

The measured points along an end of the segment are fitted with an arc, as a run of chained points is; the extension of
`app.vision.extension` walks on along it, and what it reaches is measured as the points of a candidate are.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.errors import NoEdge
from app.vision.arcs import fit_pieces, project
from app.vision.chaining import Runs
from app.vision.edges import EdgeMap
from app.vision.extension import extend
from app.vision.measured_points import MeasuredPoints, measured_along
from app.vision.merging import not_merged
from app.vision.selection import select
from app.vision.watch import Watch

Array = NDArray[np.float64]

FITTED = 400.0
"""px of the segment at an end that tell how it goes on."""
LEAST_POINTS = 24
"""Measured points there; fewer say nothing of a curvature."""

_TOLERANCE = 1.5
_ROUNDS = 3
# px without a point beside the arc; points farther off may keep the walk going, but soon they are another edge's
_LONGEST_GAP = 8.0
_SPACING = 1.0


def follow_edge(edges: EdgeMap, points: NDArray[Any]) -> NDArray[np.float32]:
    """Extend a segment over measured points at both ends, as far as its edge goes on.

    Args:
        edges: Of the image; see `app.vision.measured_points.edges_of_image`.
        points: ``(n, 2)`` px in order.

    Returns:
        The same points, with others before and after them, float32 ``(m, 2)``; just these where the edge ends there.

    Raises:
        NoEdge: When the segment doesn't lie on an edge at either end.
    """
    given = np.ascontiguousarray(points, dtype=np.float32)
    before, after = (_beyond_end(edges, each.astype(np.float64)) for each in (given[::-1], given))
    if before is None and after is None:
        raise NoEdge(
            "the segment doesn't lie on an edge, so there is nothing to follow",
            where=f"at ({given[0, 0]:.0f}, {given[0, 1]:.0f}) and ({given[-1, 0]:.0f}, {given[-1, 1]:.0f})",
            expected=f"{LEAST_POINTS} edge points along one of its ends",
            hint="trace the line anew between two points",
        )
    none = np.zeros((0, 2), np.float32)
    return np.concatenate([(none if before is None else before)[::-1], given, none if after is None else after])


def _beyond_end(edges: EdgeMap, points: Array) -> NDArray[np.float32] | None:
    """Return measured points beyond the last point, outwards ``(k, 2)``; None where the end isn't on an edge."""
    found = np.zeros((0, 2), np.float32)
    for turn in range(_ROUNDS):
        further = _one_step(edges, np.concatenate([points, found.astype(np.float64)]))
        if further is None:
            return None if turn == 0 else found
        if not len(further):
            break
        found = np.concatenate([found, further])
    return found


def _one_step(edges: EdgeMap, points: Array) -> NDArray[np.float32] | None:
    """Return the points that one extension of the arc along the end adds; None where there is no arc."""
    measured = measured_along(edges, _evenly(_tail(points)))
    runs = _runs(measured)
    if runs is None:
        return None
    merging = not_merged(fit_pieces(edges, runs))
    extend(merging, edges)
    selection = select(merging, edges, 0.0, Watch())
    if not len(selection.findings):
        return None
    arc = merging.arcs[selection.findings["arc"][:1]]
    found = selection.points.astype(np.float64)
    ends, reached = (project(np.repeat(arc, len(each)), each) for each in (points[[-2, -1]], found))
    outward = 1.0 if ends[1] >= ends[0] else -1.0
    # the points come in the order of the arc
    beyond = found[outward * reached > outward * ends[1] + _SPACING / 2]
    beyond = beyond[:: int(outward)]
    gaps = np.hypot(*np.diff(np.concatenate([points[-1:], beyond]), axis=0).T)
    wide = np.flatnonzero(gaps > _LONGEST_GAP)
    return beyond[: wide[0] if wide.size else None].astype(np.float32)


def _runs(measured: MeasuredPoints) -> tuple[Runs, Runs] | None:
    """Return the edge points along the end as one run of the pass that most of them are of."""
    hits = measured.hits(_TOLERANCE)
    axis = int(np.bincount(measured.axis[hits], minlength=2).argmax())
    rows = np.unique(measured.row[hits & (measured.axis == axis)]).astype(np.int32)
    if len(rows) < LEAST_POINTS:
        return None
    none = Runs(np.zeros(0, np.int32), np.zeros(0, np.int64), np.zeros((0, 2), np.int64))
    own = Runs(rows, np.array([len(rows)], np.int64), np.array([[0, len(rows)]], np.int64))
    return (own, none) if axis == 0 else (none, own)


def _tail(points: Array) -> Array:
    steps = np.hypot(*np.diff(points, axis=0).T)
    left = np.append(np.cumsum(steps[::-1])[::-1], 0.0)
    first = int(np.searchsorted(-left, -FITTED))
    return points[min(first, len(points) - 2) :]


def _evenly(points: Array) -> Array:
    """Return places about a px apart along a polyline, smoothed over the noise of single points."""
    steps = np.hypot(*np.diff(points, axis=0).T)
    arc = np.insert(np.cumsum(steps), 0, 0.0)
    places = np.linspace(0, arc[-1], max(int(arc[-1] / _SPACING), 2) + 1)
    whole = max(float(arc[-1]), 1e-9)
    degree = min(1 if whole < 3 * LEAST_POINTS else 3, len(points) - 1)
    curves = [np.polynomial.Legendre.fit(arc, each, degree, domain=[0, whole]) for each in points.T]
    return np.stack([curve(places) for curve in curves], axis=1)
