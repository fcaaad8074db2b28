"""Merging arcs that lie on one circle, the best pair first.

Two arcs become one when they follow each other: their facing ends point at each other, one circle fits the points of
both, and the gap between them is short for what the image shows in it. A gap counts for longer where the grey levels
beside the arcs or their contrasts differ, and for shorter where the gradient goes on through it and where no edge
crosses it. The cheapest pair of all is merged, and what it became is compared with its neighbours again.

How arcs became one is kept. Each arc has a list of the pieces (numbers of the arcs first fitted) and one of the joins;
an arc's record has the ends of both lists, `Merging` the links between.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.vision.edges import EdgeMap
from app.vision.native.library import kernels
from app.vision.native.records import JOIN, address
from app.vision.watch import Watch


@dataclass(frozen=True)
class MergeRule:
    """What two arcs must fulfil to become one; the order of the fields is that of the kernel.

    Attributes:
        same_polarity: Whether the bright side must be the same.
        angle: Largest angle in degrees between the facing directions.
        offset: Largest distance in px of an end from the other end's tangent...
        offset_per_gap: ...and how much it grows per px of the gap.
        rms: Largest root mean square distance in px of the points from the joint arc.
        largest: Largest distance in px of the four ends from it.
        reach: Longest gap in px.
        limit: Longest effective gap in px, the evidence in the image considered...
        limit_per_length: ...and how much it grows per px of both arcs together, up to 200 px.
    """

    same_polarity: bool
    angle: float
    offset: float
    offset_per_gap: float
    rms: float
    largest: float
    reach: float
    limit: float
    limit_per_length: float


# an edge that is interrupted: by a post before it, by a shadow across it
FOLLOWING = MergeRule(
    same_polarity=True,
    angle=12.0,
    offset=1.5,
    offset_per_gap=0.06,
    rms=0.5,
    largest=1.5,
    reach=80.0,
    limit=10.0,
    limit_per_length=0.05,
)
# an edge whose bright side changes: windows in a facade; stricter, as more arcs are tried
FLIPPING = MergeRule(
    same_polarity=False,
    angle=4.0,
    offset=1.0,
    offset_per_gap=0.03,
    rms=0.4,
    largest=1.0,
    reach=36.0,
    limit=12.0,
    limit_per_length=0.0,
)


@dataclass(frozen=True, eq=False)
class Merging:
    """Arcs on their way; the next round of merging works in the same memory, so only the newest may be used.

    Attributes:
        records: `ARC` ``(2 n + 1,)`` for n pieces, the arcs alive in front.
        count: How many are alive.
        next_piece: int32 ``(n,)``, the piece after each in its arc's list.
        joins: `JOIN` ``(n,)``: ``leave`` and ``enter``, the ends of the gap in px; ``cost``; ``flipped``, whether the
            bright side changes there; ``next`` in its arc's list.
        made: How many joins were made.
    """

    records: NDArray[Any]
    count: int
    next_piece: NDArray[np.int32]
    joins: NDArray[Any]
    made: int

    @property
    def arcs(self) -> NDArray[Any]:
        """Arcs alive, `ARC` ``(count,)``."""
        return self.records[: self.count]


def not_merged(records: NDArray[Any]) -> Merging:
    """Begin with the pieces of `app.vision.arcs.fit_pieces`."""
    pieces = len(records) // 2
    return Merging(records, pieces, np.full(max(pieces, 1), -1, np.int32), np.empty(max(pieces, 1), JOIN), 0)


def without_short(merging: Merging, least: float) -> Merging:
    """Leave out the arcs shorter than ``least`` px; the memory of the state given is used for the result."""
    return replace(merging, count=kernels().cl_leave_out_short(address(merging.records), merging.count, least))


def merge(merging: Merging, edges: EdgeMap, rule: MergeRule, watch: Watch) -> Merging:
    """Merge arcs until no pair fulfils the rule.

    Args:
        merging: The newest state; its memory is used for the result.
        edges: Of the image.
        rule: What a pair must fulfil.
        watch: Over this part of the detection.

    Raises:
        Cancelled: If that is wished.
    """
    # a name keeps the memory until the kernel is done
    conditions, made = np.array(list(vars(rule).values()), np.float64), np.array([merging.made], np.int64)
    left = watch.call(
        kernels().cl_merge,
        *(edges.scene, address(merging.records), merging.count, address(conditions)),
        *(address(merging.next_piece), address(merging.joins), address(made)),
    )
    return replace(merging, count=left, made=int(made[0]))
