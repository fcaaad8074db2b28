"""Keeping one segment per edge, and the points measured along it.

Arcs are painted into the image, the longest and best supported first. One that runs over the paint of arcs in its
direction for more than 40 % of its way goes; of the others the painted ends go, and what has no point at the ends.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.vision.edges import EdgeMap
from app.vision.merging import Merging
from app.vision.native.library import kernels
from app.vision.native.records import FINDING, address
from app.vision.watch import Watch

PAINT_WIDTH = 1.4
"""px beside an arc that belong to its edge; the next edge of a thin bar is 2 px away."""


@dataclass(frozen=True, eq=False)
class Selection:
    """Segments, one per edge, and what speaks for each.

    Attributes:
        findings: `FINDING` ``(S,)``: ``arc``, its number among the arcs alive; ``first`` and one past ``last`` of its
            points; ``chord`` px; ``samples``, the columns (rows) it passes, ``hits``, those with a point within
            tolerance, ``close``, those with one within half a pixel and 8 degrees; ``rms`` px of the hits from the arc;
            ``mean_norm`` of their gradient; ``longest_gap`` in samples; ``contrast`` of both sides, grey levels.
        points: float32 ``(N, 2)`` px, measured points in order along each segment.
    """

    findings: NDArray[Any]
    points: NDArray[np.float32]


def select(merging: Merging, edges: EdgeMap, least: float, watch: Watch) -> Selection:
    """De-duplicate the arcs alive and measure what is left.

    Args:
        merging: The newest state.
        edges: Of the image.
        least: Shortest arc to look at, px.
        watch: Over this part of the detection.

    Raises:
        Cancelled: If that is wished.
    """
    room = kernels().cl_count_samples(address(merging.records), merging.count, least)
    points, findings = np.empty((room, 2), np.float32), np.empty(merging.count, FINDING)
    found = watch.call(
        kernels().cl_select,
        *(edges.scene, address(merging.records), merging.count, least, PAINT_WIDTH),
        *(address(findings), address(points), room),
    )
    findings = findings[:found]
    return Selection(findings, points[: int(findings["last"][-1]) if found else 0])
