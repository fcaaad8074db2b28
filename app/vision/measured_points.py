"""Looking up the measured edge points that lie along a given curve.

Along a curve that is nearer to horizontal each column has at most one point that counts, from the pass of edges along
x; where it is steeper, each row, from the pass along y. A point counts under the tolerances that the pipeline's own
walks along arcs use, so what is found here are the points that a candidate would have.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.vision.edges import EdgeMap, edge_map
from app.vision.equalisation import equalisation
from app.vision.parameters import DetectionParameters
from app.vision.pipeline import check_image
from app.vision.stages import WEAKEST_NORM
from app.vision.watch import Watch

Array = NDArray[np.float64]

HIT_TURN = 0.5
"""Tangent of the largest angle between an edge point's direction and the curve's: 26.6 degrees."""


@dataclass(frozen=True, eq=False)
class MeasuredPoints:
    """What was measured along a curve, at each column or row that it passes, in the order of the curve.

    Attributes:
        along: float64 ``(n,)``, where on the curve the column or row is passed, as a fractional index of its places.
        points: float64 ``(n, 2)`` px, the nearest edge point there; meaningless where there is none.
        distance: float64 ``(n,)`` px, how far that point is from the curve; infinite where there is none, or where its
            direction is another.
        axis: int64 ``(n,)``, the pass that it is of: 0 along x, 1 along y.
        row: int64 ``(n,)``, its row in that pass; -1 where there is none.
    """

    along: Array
    points: Array
    distance: Array
    axis: NDArray[np.int64]
    row: NDArray[np.int64]

    def hits(self, tolerance: float) -> NDArray[np.bool_]:
        """Return which columns and rows have a point within so many px of the curve, bool ``(n,)``."""
        return self.distance <= tolerance


def edges_of_image(gray: NDArray[Any]) -> EdgeMap:
    """Find the edge points of an image as a detection with default parameters does, weak ones included.

    Args:
        gray: ``(H, W)``, uint8, uint16 or floating point, 3 px and more a side.

    Raises:
        InvalidImage: On another rank or dtype, no or too many pixels, or values that aren't finite.
    """
    parameters = DetectionParameters()
    eight_bit = check_image(gray)
    tables = equalisation(eight_bit, parameters.clahe_clip, parameters.clahe_tile)
    edges = edge_map(eight_bit, tables, parameters.sigma, WEAKEST_NORM, Watch())
    # the points are views of memory with room for far more of them
    return replace(edges, points=(edges.points[0].copy(), edges.points[1].copy()))


def measured_along(edges: EdgeMap, places: Array) -> MeasuredPoints:
    """Look up the nearest edge point at each column or row that a curve passes.

    Args:
        edges: Of the image.
        places: float64 ``(m, 2)`` px, the curve, smooth, its places at most a few px apart.
    """
    tangent = np.gradient(places, axis=0)
    mostly_along_y = np.abs(tangent[:, 1]) > np.abs(tangent[:, 0])
    parts: list[MeasuredPoints] = []
    starts = np.flatnonzero(np.diff(mostly_along_y, prepend=~mostly_along_y[:1]))
    for start, stop in zip(starts, [*starts[1:], len(places)], strict=True):
        # one place more on either side, so that no column is lost between two parts
        first, last = max(int(start) - 1, 0), min(int(stop) + 1, len(places))
        part = _measured_in_pass(edges, int(mostly_along_y[start]), places[first:last], tangent[first:last])
        parts.append(replace(part, along=part.along + first))
    found = _joined(parts)
    # both sides of a change of passes may have found the same place
    keep = np.diff(found.along, prepend=-1.0) > 1e-9
    return MeasuredPoints(*(getattr(found, name)[keep] for name in ("along", "points", "distance", "axis", "row")))


def _measured_in_pass(edges: EdgeMap, axis: int, places: Array, tangent: Array) -> MeasuredPoints:
    progress = places[:, axis]
    falling = progress[-1] < progress[0]
    rising = np.maximum.accumulate(-progress if falling else progress)
    lines = np.arange(np.ceil(rising[0]), np.floor(rising[-1]) + 1)
    along = np.interp(lines, rising, np.arange(len(places), dtype=np.float64))
    lines = -lines if falling else lines
    index = np.arange(len(places))
    across = np.interp(along, index, places[:, 1 - axis])
    ahead, sideways = (np.interp(along, index, tangent[:, each]) for each in (axis, 1 - axis))
    ahead = np.where(np.abs(ahead) < 1e-9, 1e-9, ahead)
    row = _nearest(edges.points[axis], lines, across)
    point = edges.points[axis][np.maximum(row, 0)] if len(edges.points[axis]) else np.zeros(len(row), POINTLESS)
    measured, slope = point["across"].astype(np.float64), point["slope"].astype(np.float64)
    curve_slope = sideways / ahead
    distance = np.abs(measured - across) / np.hypot(1, curve_slope)
    turned = np.abs(slope - curve_slope) > HIT_TURN * np.abs(1 + slope * curve_slope)
    distance[turned | (row < 0)] = np.inf
    points = np.stack([lines, measured] if axis == 0 else [measured, lines], axis=1)
    return MeasuredPoints(along, points, distance, np.full(len(lines), axis), row)


POINTLESS = np.dtype([("across", "f4"), ("slope", "f4")])


def _nearest(points: NDArray[Any], lines: Array, across: Array) -> NDArray[np.int64]:
    """Return the row of the edge point nearest to `across` on each line; -1 on lines without one."""
    if not len(lines) or not len(points):
        return np.full(len(lines), -1, np.int64)
    low, high = np.searchsorted(points["along"], [lines.min(), lines.max() + 1])
    near = points[low:high]
    if not len(near):
        return np.full(len(lines), -1, np.int64)
    # line and place across it as one number that rises from row to row
    stride = 2.0 * max(float(near["across"].max()), float(across.max())) + 4
    keys = near["along"] * stride + np.maximum(near["across"], 0)
    after = np.searchsorted(keys, lines * stride + np.clip(across, 0, stride / 2))
    best, least = np.full(len(lines), -1, np.int64), np.full(len(lines), np.inf)
    for candidate in (after - 1, after):
        row = np.clip(candidate, 0, len(near) - 1)
        there = near["along"][row] == lines
        gap = np.where(there, np.abs(near["across"][row] - across), np.inf)
        best = np.where(gap < least, row + low, best)
        least = np.minimum(least, gap)
    return best


def _joined(parts: list[MeasuredPoints]) -> MeasuredPoints:
    return MeasuredPoints(
        *(
            np.concatenate([getattr(part, name) for part in parts])
            for name in ("along", "points", "distance", "axis", "row")
        )
    )
