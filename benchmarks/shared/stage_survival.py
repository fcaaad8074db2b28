"""Which labelled lines every stage of detection leaves, and among how many candidates."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.evaluation.matching import match_segments
from app.vision import DetectionParameters, Segments
from app.vision.pipeline import choose, segments_of
from app.vision.stages import run_stages
from app.vision.watch import Watch

from .arc_polylines import arc_polylines
from .findable import are_covered, are_found, are_supported
from .strict_score import THRESHOLD

LONG_ENOUGH = 40.0
"""Shorter arcs and segments aren't counted as candidates, px."""


@dataclass(frozen=True, eq=False)
class Survival:
    """What is left of the L lines of one image.

    Attributes:
        findable: By stage, in order, which lines can still be found, bool ``(L,)``.
        candidates: By stage, how many arcs or segments of `LONG_ENOUGH` there are; ``"supported"`` has none.
    """

    findable: dict[str, NDArray[np.bool_]]
    candidates: dict[str, int]


def survival(gray: NDArray[np.uint8], labels: Segments, parameters: DetectionParameters) -> Survival:
    """Detect with copies of what every stage leaves, and look for each line in them.

    Args:
        gray: uint8 ``(H, W)``.
        labels: L lines, px.
        parameters: Of the detection.
    """
    stages = run_stages(np.ascontiguousarray(gray), parameters, Watch(), keep=True)
    arcs = {name: arc_polylines(records) for name, records in stages.alive.items()}
    findings = stages.selection.findings
    every = Segments(stages.selection.points, np.concatenate([[0], findings["last"]]).astype(np.int64))
    returned = segments_of(stages, choose(stages.selection, parameters))

    findable = {"supported": are_supported(labels, stages.edges), "chained": are_covered(labels, arcs["chained"])}
    findable |= {name: are_found(labels, arcs[name]) for name in arcs if name != "chained"}
    findable |= {"de-duplicated": are_found(labels, every), "validated": are_found(labels, returned)}
    matched = np.zeros(len(labels), np.bool_)
    matched[match_segments(returned, labels, THRESHOLD).column] = True

    lengths = {name: records["high"] - records["low"] for name, records in stages.alive.items()}
    lengths |= {"de-duplicated": findings["chord"], "validated": returned.extents(), "matched": returned.extents()}
    candidates = {name: int((each >= LONG_ENOUGH).sum()) for name, each in lengths.items()}
    return Survival(findable | {"matched": matched}, candidates)
