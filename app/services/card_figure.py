"""The figure of a dataset's card: three panels, as papers show a dataset: image, candidates, kept."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from app.evaluation.legend import Entry, legend_band
from app.evaluation.overlay import line_width
from app.evaluation.strokes import Pattern, Stroke, draw_stroke
from app.vision.segments import Segments

CANDIDATES = Stroke((40, 150, 255), Pattern.DASHED, 0.8)
KEPT = Stroke((90, 215, 60), Pattern.SOLID)
WHITE = 255


def draw_panels(image: NDArray[np.uint8], candidates: Segments, kept: Segments) -> NDArray[np.uint8]:
    """Draw image, candidates and kept segments at full resolution, with a legend below.

    Wide images stand below each other, others side by side.

    Args:
        image: uint8 ``(H, W)`` or BGR ``(H, W, 3)``.
        candidates: What the pipeline proposed, px.
        kept: What a person kept, px.

    Returns:
        uint8 BGR.
    """
    plain = cv2.cvtColor(image, cv2.COLOR_GRAY2BGR) if image.ndim == 2 else image
    height, width = plain.shape[:2]
    unit = line_width(width, height)
    panels = [np.ascontiguousarray(plain, np.uint8).copy() for _ in range(3)]
    draw_stroke(panels[1], list(candidates), CANDIDATES, unit)
    draw_stroke(panels[2], list(kept), KEPT, unit)
    joined = _joined(panels, round(4 * unit), axis=0 if width > 2 * height else 1)
    entries = [Entry(CANDIDATES, f"{len(candidates)} candidates"), Entry(KEPT, f"{len(kept)} kept")]
    band = legend_band(entries, "image, candidates, kept", joined.shape[1], unit)
    missing = band.shape[1] - joined.shape[1]
    return np.concatenate([np.pad(joined, ((0, 0), (0, missing), (0, 0)), constant_values=WHITE), band])


def _joined(panels: list[NDArray[np.uint8]], gap: int, *, axis: int) -> NDArray[np.uint8]:
    shape = list(panels[0].shape)
    shape[axis] = gap
    between = np.full(shape, WHITE, np.uint8)
    return np.concatenate([panels[0], between, panels[1], between, panels[2]], axis=axis)
