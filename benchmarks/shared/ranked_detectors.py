"""Detectors that differ enough for an order of them to mean something, all in this process."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

import cv2
import numpy as np
from numpy.typing import NDArray

from app.vision import DetectionParameters, Segments
from app.vision.stages import run_stages
from app.vision.watch import Watch

from .arc_polylines import arc_polylines
from .detectors import Detector, clearlines

SHORTEST_PIECE = 10.0
"""px; shorter arcs of the detector without its merging are left out."""


def ranked_detectors(min_length: float) -> Mapping[str, Detector]:
    """Return the detectors by the names they are printed with; what they find may be shorter than `min_length`."""
    ours = {f"ClearLines, {point}": clearlines(min_length, point) for point in ("recall", "balanced", "precise")}
    return ours | {
        "ClearLines, not merged": unmerged,
        "LSD": partial(lsd, refine=cv2.LSD_REFINE_STD, scale=0.8),
        "LSD, full scale": partial(lsd, refine=cv2.LSD_REFINE_STD, scale=1.0),
        "LSD, half scale": partial(lsd, refine=cv2.LSD_REFINE_STD, scale=0.5),
        "LSD, not refined": partial(lsd, refine=cv2.LSD_REFINE_NONE, scale=0.8),
        "Hough": hough,
    }


def unmerged(gray: NDArray[np.uint8]) -> Segments:
    """Our detector up to the arcs that its edges are split into: nothing is merged, extended or validated."""
    stages = run_stages(np.ascontiguousarray(gray), DetectionParameters(), Watch(), keep=True)
    arcs = stages.alive["chained"]
    return arc_polylines(arcs[arcs["high"] - arcs["low"] >= SHORTEST_PIECE])


def lsd(gray: NDArray[np.uint8], refine: int, scale: float) -> Segments:
    """LSD (von Gioi et al., IPOL 2012) as OpenCV has it."""
    lines = cv2.createLineSegmentDetector(refine, scale).detect(gray)[0]
    return Segments.from_list([] if lines is None else list(lines.reshape(-1, 2, 2)))


def hough(gray: NDArray[np.uint8]) -> Segments:
    """Canny's edges and the probabilistic Hough transform (Matas et al., CVIU 2000) as OpenCV has them."""
    edges = cv2.Canny(cv2.GaussianBlur(gray, (0, 0), 1.0), 50, 100)
    lines = cv2.HoughLinesP(edges, 1, np.pi / 180, 40, minLineLength=30, maxLineGap=4)
    return Segments.from_list([] if lines is None else list(lines.reshape(-1, 2, 2).astype(np.float32)))
