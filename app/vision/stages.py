"""The stages of detection, one after another, on an 8-bit image."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.vision.arcs import fit_pieces
from app.vision.chaining import find_runs
from app.vision.edges import EdgeMap, edge_map
from app.vision.equalisation import equalisation
from app.vision.extension import extend
from app.vision.merging import FLIPPING, FOLLOWING, Merging, merge, not_merged, without_short
from app.vision.parameters import DetectionParameters, OperatingPoint
from app.vision.selection import Selection, select
from app.vision.watch import Watch

# weaker edges than this neither support nor extend a segment
WEAKEST_NORM = 30.0
# by how much an edge may be weaker than asked for where nothing should be missed
_WEAKER: dict[OperatingPoint, float] = {"recall": 0.85, "balanced": 1.0, "precise": 1.0}
# pieces of a few px are the glue of the first round of merging; what is shorter than these shares of the shortest
# segment asked for, and than these px, after it and after extension can't become one by what is left to do
_LEAST_SHARE_MERGED, _LEAST_MERGED = 0.25, 12.0
_LEAST_SHARE, _LEAST_EXTENDED = 0.5, 25.0
# share of the time at which each stage ends, measured on photos
_EDGES_END, _CHAINING_END, _FOLLOWING_END, _FLIPPING_END, _SELECTION_BEGIN = 0.28, 0.54, 0.74, 0.77, 0.85


@dataclass(frozen=True, eq=False)
class Stages:
    """What each stage of detection gave.

    Attributes:
        edges: Edge points of the image.
        merging: Arcs after the last round of merging.
        joins_made: By round of merging, how many joins existed after it: ``"following"``, ``"flipping"``,
            ``"after extension"``.
        selection: Segments after de-duplication.
        alive: Copies of the arcs (`ARC`) alive after ``"chained"``, ``"merged"``, ``"extended"`` and
            ``"merged after extension"``; empty unless asked for.
    """

    edges: EdgeMap
    merging: Merging
    joins_made: dict[str, int]
    selection: Selection
    alive: dict[str, NDArray[Any]] = field(default_factory=dict[str, NDArray[Any]])


def run_stages(gray: NDArray[np.uint8], parameters: DetectionParameters, watch: Watch, *, keep: bool = False) -> Stages:
    """Detect, up to the choice of what is returned.

    Args:
        gray: uint8 ``(H, W)``, contiguous, both 3 or more.
        parameters: Of the detection.
        watch: Over all stages.
        keep: Whether copies of the arcs alive after each stage are wanted.

    Raises:
        Cancelled: If that is wished.
    """
    alive: dict[str, NDArray[Any]] = {}
    joins_made: dict[str, int] = {}

    def note(stage: str, merging: Merging) -> None:
        if keep:
            alive[stage] = merging.arcs.copy()

    watch.tell(0)
    tables = equalisation(gray, parameters.clahe_clip, parameters.clahe_tile)
    weaker = _WEAKER[parameters.operating_point]
    low, high = weaker * parameters.low_threshold, weaker * parameters.high_threshold
    edges = edge_map(gray, tables, parameters.sigma, min(weaker * WEAKEST_NORM, low), watch.part(0, _EDGES_END))
    merging = _pieces(edges, low, high, watch.part(_EDGES_END, _CHAINING_END))
    note("chained", merging)

    merging = merge(merging, edges, FOLLOWING, watch.part(_CHAINING_END, _FOLLOWING_END))
    joins_made["following"] = merging.made
    merging = without_short(merging, min(_LEAST_SHARE_MERGED * parameters.min_length, _LEAST_MERGED))
    merging = merge(merging, edges, FLIPPING, watch.part(_FOLLOWING_END, _FLIPPING_END))
    joins_made["flipping"] = merging.made
    note("merged", merging)
    watch.tell(_FLIPPING_END)
    extend(merging, edges)
    note("extended", merging)
    least = _LEAST_SHARE * parameters.min_length
    merging = without_short(merging, min(least, _LEAST_EXTENDED))
    merging = merge(merging, edges, FOLLOWING, watch.part(_FLIPPING_END, _SELECTION_BEGIN))
    joins_made["after extension"] = merging.made
    note("merged after extension", merging)

    selection = select(merging, edges, least, watch.part(_SELECTION_BEGIN, 1))
    watch.tell(1)
    return Stages(edges, merging, joins_made, selection, alive)


def _pieces(edges: EdgeMap, low: float, high: float, watch: Watch) -> Merging:
    runs = []
    for axis in (0, 1):
        watch.tell(axis / 3)
        runs.append(find_runs(edges, axis, low, high))
    watch.tell(2 / 3)
    return not_merged(fit_pieces(edges, (runs[0], runs[1])))
