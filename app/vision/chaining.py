"""Linking edge points into ordered open chains, and splitting these into runs that an arc fits.

Each pass is linked column to column (row to row): its edges are single-valued, so a chain holds at most one point per
column, no point twice, and has no branches. A point is followed by one with the same sign, one to three columns on,
near where the mean of both slopes puts it, if each is the other's nearest; nearer columns come first. Hysteresis
follows Canny, IEEE TPAMI 8(6), 1986.

Long contours bend and turn corners. A run of points that no arc fits to 0.7 px is cut where it is farthest from its
chord (Ramer 1972; Douglas & Peucker 1973) until every run is an arc or shorter than 6 points; the point of a cut
belongs to neither side, as a corner is no measurement of either edge. Short runs are the glue of merging.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.vision.edges import EdgeMap
from app.vision.native.library import kernels
from app.vision.native.records import address
from app.vision.watch import counted


@dataclass(frozen=True, eq=False)
class Runs:
    """Runs of points of one pass.

    Attributes:
        rows: int32 ``(m,)``, rows of the chained edge points, chain after chain, rising along the axis in each.
        chain_ends: int64 ``(c,)``, one past the last index into `rows` of each chain.
        bounds: int64 ``(r, 2)``, first and one past the last index into `rows` of each run, in rising order.
    """

    rows: NDArray[np.int32]
    chain_ends: NDArray[np.int64]
    bounds: NDArray[np.int64]

    def __len__(self) -> int:
        return len(self.bounds)


def find_runs(edges: EdgeMap, axis: int, low: float, high: float) -> Runs:
    """Chain the points of one pass and split the chains.

    Args:
        edges: Of the image.
        axis: 0 for the pass along x, 1 for that along y.
        low: Points with a gradient norm up to this are left out.
        high: A chain is kept when one of its points is above this.
    """
    points, spans, (height, width) = edges.points[axis], edges.spans[axis], edges.gray.shape
    count = len(points)
    rows, chain_ends = np.empty(count, np.int32), np.empty(count, np.int64)
    bounds, sizes = np.empty((count, 2), np.int64), np.zeros(2, np.int64)
    found = counted(
        kernels().cl_runs(
            *(address(points), count, address(spans)),
            *(axis, width, height, low, high),
            *(address(rows), address(chain_ends), address(bounds), address(sizes)),
        )
    )
    chained, chains = sizes.tolist()
    return Runs(rows[:chained], chain_ends[:chains], bounds[:found])
