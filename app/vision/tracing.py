"""Walking along arcs and picking up the measured points that support them."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.vision.arcs import Arcs
from app.vision.subpixel import EdgePoints

_TOLERANCE = 1.0
_ANGLE = float(np.tan(np.radians(20.0)))
_CLOSE_TOLERANCE = 0.5
_CLOSE_ANGLE = float(np.tan(np.radians(8.0)))


@dataclass(frozen=True, eq=False)
class Trace:
    """Samples along arcs, one per column (or row, for steep arcs), walk after walk, rising in ``u`` in each.

    Attributes:
        walk: int64 ``(m,)``, which walk a sample belongs to.
        u: float64 ``(m,)`` px, tangent coordinate on the arc.
        cells: int64 ``(m, 2)``, x and y of the pixel that the arc passes.
        points: float64 ``(m, 2)`` px, the measured point there; the arc's own position where there is none.
        norm: float32 ``(m,)``, gradient norm of the measured point, 0 where there is none.
        distance: float64 ``(m,)`` px, signed distance of the measured point from the arc, infinite where there is none.
        hit: bool ``(m,)``, whether there is a point within 1 px and 20 degrees.
        close: bool ``(m,)``, whether it is within 0.5 px and 8 degrees.
    """

    walk: NDArray[np.int64]
    u: NDArray[np.float64]
    cells: NDArray[np.int64]
    points: NDArray[np.float64]
    norm: NDArray[np.float32]
    distance: NDArray[np.float64]
    hit: NDArray[np.bool_]
    close: NDArray[np.bool_]

    def take(self, index: NDArray[Any]) -> Trace:
        """Return the samples chosen by a mask or by indices."""
        return Trace(*(getattr(self, field.name)[index] for field in fields(self)))

    def bounds(self, walks: int) -> NDArray[np.int64]:
        """Return where each of ``walks`` walks begins, and the end of the last, int64 ``(walks + 1,)``."""
        return np.searchsorted(self.walk, np.arange(walks + 1)).astype(np.int64)


def trace(
    arcs: Arcs,
    index: NDArray[np.int64],
    low: NDArray[np.float64],
    high: NDArray[np.float64],
    passes: tuple[EdgePoints, EdgePoints],
) -> Trace:
    """Walk along arcs and find the measured point at every step.

    Args:
        arcs: All arcs.
        index: int64 ``(w,)``, the arc of each walk.
        low: float64 ``(w,)`` px, tangent coordinate where a walk begins.
        high: float64 ``(w,)`` px, where it ends.
        passes: Edge points along x and along y.
    """
    flat = np.abs(arcs.tangent[index, 0]) >= np.abs(arcs.tangent[index, 1])
    parts = []
    for points, own in zip(passes, (flat, ~flat), strict=True):
        walks = np.flatnonzero(own)
        parts.append(_trace_pass(arcs, index[walks], low[walks], high[walks], walks, points))
    joined = Trace(*(np.concatenate([getattr(part, f.name) for part in parts]) for f in fields(Trace)))
    return joined.take(np.lexsort((joined.u, joined.walk)))


def _trace_pass(
    arcs: Arcs,
    index: NDArray[np.int64],
    low: NDArray[np.float64],
    high: NDArray[np.float64],
    walks: NDArray[np.int64],
    points: EdgePoints,
) -> Trace:
    axis = points.axis
    ends = np.sort(np.stack([arcs.positions(index, u)[:, axis] for u in (low, high)]), axis=0)
    # an end lies at a column up to rounding: half a column more keeps it in
    first, last = np.ceil(ends[0] - 0.5).astype(np.int64), np.floor(ends[1] + 0.5).astype(np.int64)
    counts = np.maximum(last - first + 1, 0)
    begin = np.cumsum(counts) - counts
    member = np.repeat(np.arange(len(index)), counts)
    arc = index[member]
    along = np.arange(counts.sum()) - begin[member] + first[member]

    # the tangent coordinate at which the arc passes this column: fixed-point steps converge as it bends little
    u = (along - arcs.foot[arc, axis]) / arcs.tangent[arc, axis]
    for _ in range(3):
        u += (along - arcs.positions(arc, u)[:, axis]) / arcs.tangent[arc, axis]
    position = arcs.positions(arc, u)
    direction = arcs.directions(arc, u)
    across = position[:, 1 - axis]
    slope = direction[:, 1 - axis] / direction[:, axis]
    cosine = np.abs(direction[:, axis])
    pixel = np.rint(across).astype(np.int64)

    row = np.full(len(u), -1, np.int64)
    distance = np.full(len(u), np.inf)
    for shift in (0, -1, 1):
        there = points.find(along, pixel + shift)
        found = np.flatnonzero(there >= 0)
        misfit = (points.across[there[found]] - across[found]) * cosine[found]
        nearer = np.abs(misfit) < np.abs(distance[found])
        row[found[nearer]] = there[found[nearer]]
        distance[found[nearer]] = misfit[nearer]

    known = np.flatnonzero(row >= 0)
    turn = np.full(len(u), np.inf)
    measured = points.slope[row[known]]
    turn[known] = np.abs(measured - slope[known]) / np.maximum(np.abs(1 + measured * slope[known]), 1e-9)
    hit = (np.abs(distance) <= _TOLERANCE) & (turn <= _ANGLE)
    close = (np.abs(distance) <= _CLOSE_TOLERANCE) & (turn <= _CLOSE_ANGLE)
    position[known] = points.points(row[known])
    norm = np.zeros(len(u), np.float32)
    norm[known] = points.norm[row[known]]
    cells = np.stack([along, pixel] if axis == 0 else [pixel, along], axis=1)
    return Trace(walks[member], u, cells, position, norm, distance, hit, close)
