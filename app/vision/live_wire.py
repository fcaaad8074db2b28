"""The live-wire: the cheapest path along an edge between clicked points, good to a pixel.

After Mortensen & Barrett, "Intelligent Scissors for Image Composition" (SIGGRAPH 1995), a step of the path costs the
less the stronger the gradient across it. Here the path stays in a corridor along the points and never turns back, so
the graph has no cycles and one sweep over its stages finds the shortest path (Bellman, "Dynamic Programming", 1957) in
place of Dijkstra's algorithm over the whole image.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from app.vision.corridor import Corridor
from app.vision.edges import EdgeMap
from app.vision.native.records import GRADIENT_SCALE

Array = NDArray[np.float64]

# gradient norm at which a step costs half as much as one over a flat place: a weak edge where the person has clicked
# must cost little more than a strong one beside it
_HALF_COST = 25.0
# what a step costs more at the corridor's side than in its middle
_SIDE_COST = 0.5
# passing a clicked point at the full reach costs as much as so many stages over a flat place
_PULL = 4.0
_MOST_STAGES = 1024
_DIAGONAL = np.sqrt(2.0)


@dataclass(frozen=True, eq=False)
class Path:
    """The cheapest path through a corridor.

    Attributes:
        along: float64 ``(n,)`` px, the stages, evenly spaced from 0 to the corridor's length.
        across: float64 ``(n,)`` px, where the path passes each.
        certainty: float64 ``(n,)`` in [0, 1), rising with the gradient there.
    """

    along: Array
    across: Array
    certainty: Array


def cheapest_path(edges: EdgeMap, corridor: Corridor) -> Path:
    """Return the cheapest path from the corridor's first point to its last, near those in between.

    Args:
        edges: Of the image.
        corridor: Where the path may run.
    """
    stages = int(np.ceil(min(corridor.length, _MOST_STAGES))) + 1
    along = np.linspace(0, corridor.length, stages)
    middle, limits = corridor.middle(along), corridor.half_width(along)
    widest = int(np.ceil(limits.max()))
    lanes = np.arange(-widest, widest + 1, dtype=np.float64)
    cost = _cost(edges, corridor, along, middle[:, None] + lanes)
    certainty = 1 - cost
    off = lanes / limits[:, None]
    cost += _SIDE_COST * off * off
    cost[np.abs(off) > 1] = np.inf
    clicked = np.rint(corridor.clicks[:, 0] / corridor.length * (stages - 1)).astype(np.int64)
    cost[clicked] += _PULL * (lanes / corridor.reach) ** 2
    lane = _sweep(cost)
    return Path(along, middle + lanes[lane], certainty[np.arange(stages), lane])


def _cost(edges: EdgeMap, corridor: Corridor, along: Array, across: Array) -> Array:
    """Return what a step costs at places across each stage ``(n, m)``: near 0 on a strong edge, 1 where it is flat."""
    places = corridor.places(np.broadcast_to(along[:, None], across.shape), across)
    x, y = (np.ascontiguousarray(places[..., each], dtype=np.float32) for each in (0, 1))
    # the coordinate system is that of the chord: an edge that runs along it has its gradient across it
    normal = corridor.normal / GRADIENT_SCALE
    strength = np.zeros(x.shape, np.float32)
    for gradient, share in zip(edges.gradients, normal.tolist(), strict=True):
        values = cv2.remap(gradient, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT, borderValue=0)
        strength += np.float32(share) * values
    return _HALF_COST / (np.abs(strength).astype(np.float64) + _HALF_COST)


def _sweep(cost: Array) -> NDArray[np.int64]:
    """Return the lane ``(n,)`` that the cheapest path takes at each stage of costs ``(n, m)``.

    From stage to stage the path keeps its lane or changes to a neighbouring one.
    """
    stages, lanes = cost.shape
    came_from = np.zeros((stages, lanes), np.int8)
    # one lane more on either side that can't be reached
    total = np.full(lanes + 2, np.inf)
    total[1:-1] = cost[0]
    for stage in range(1, stages):
        best, step = total[1:-1] + cost[stage], came_from[stage]
        sideways = _DIAGONAL * cost[stage]
        for change, before in ((-1, total[:-2]), (1, total[2:])):
            other = before + sideways
            nearer = other < best
            step[nearer] = change
            best = np.where(nearer, other, best)
        total[1:-1] = best
    lane = np.empty(stages, np.int64)
    lane[-1] = int(np.argmin(total[1:-1]))
    for stage in range(stages - 1, 0, -1):
        lane[stage - 1] = lane[stage] + came_from[stage, lane[stage]]
    return lane
