"""Following an arc beyond its ends where the edge goes on too weakly to have been chained."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from app.vision.arcs import Arcs
from app.vision.subpixel import EdgePoints
from app.vision.tracing import trace

_SHORTEST = 25.0
_MOST_MISSES = 3
_DENSITY = 0.7


def extend(arcs: Arcs, passes: tuple[EdgePoints, EdgePoints]) -> Arcs:
    """Move both ends of arcs outwards over measured points.

    The walk goes on along the arc until more than three steps in a row have no point; it may be as long as the arc
    itself, and 70 % of its steps must have a point. The fit stays as it is.

    Args:
        arcs: Arcs of one image; those shorter than 25 px stay as they are.
        passes: Edge points along x and along y, weak ones included.
    """
    index = np.flatnonzero(arcs.lengths >= _SHORTEST)
    length = arcs.lengths[index]
    low, high = arcs.low.copy(), arcs.high.copy()
    high[index] = _walk(arcs, index, arcs.high[index], arcs.high[index] + length, passes, outward=1)
    low[index] = _walk(arcs, index, arcs.low[index] - length, arcs.low[index], passes, outward=-1)
    return replace(arcs, low=low, high=high)


def _walk(
    arcs: Arcs,
    index: NDArray[np.int64],
    low: NDArray[np.float64],
    high: NDArray[np.float64],
    passes: tuple[EdgePoints, EdgePoints],
    outward: int,
) -> NDArray[np.float64]:
    """Tangent coordinates of the new ends."""
    reached = (high if outward < 0 else low).copy()
    samples = trace(arcs, index, low, high, passes)
    if outward < 0:
        samples = samples.take(np.lexsort((-samples.u, samples.walk)))
    if not len(samples.u):
        return reached
    bounds = samples.bounds(len(index))
    first = bounds[samples.walk]
    step = np.arange(len(samples.u))
    last_hit = np.maximum.accumulate(np.where(samples.hit, step, -1))
    misses = step - np.maximum(last_hit, first - 1)
    stopped = np.cumsum(misses > _MOST_MISSES)
    stopped -= (stopped - (misses > _MOST_MISSES))[first]
    hits = np.cumsum(samples.hit)
    hits = hits - (hits - samples.hit)[first]
    good = samples.hit & (stopped == 0) & (hits >= _DENSITY * (step - first + 1))
    chosen = np.flatnonzero(good)
    # the last one written, the farthest, stays
    reached[samples.walk[chosen]] = samples.u[chosen]
    return reached
