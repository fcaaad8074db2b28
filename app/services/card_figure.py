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


def draw_panels(image: NDArray[np.uint8], candidates: Segments | None, kept: Segments) -> NDArray[np.uint8]:
    """Draw image, candidates and kept segments at full resolution, with a legend below.

    Wide images stand below each other, others side by side.

    Args:
        image: uint8 ``(H, W)`` or BGR ``(H, W, 3)``.
        candidates: What the pipeline proposed, px; ``None`` leaves their panel out.
        kept: What a person kept, px.

    Returns:
        uint8 BGR.
    """
    plain = cv2.cvtColor(image, cv2.COLOR_GRAY2BGR) if image.ndim == 2 else image
    height, width = plain.shape[:2]
    unit = line_width(width, height)
    parts = [(CANDIDATES, "candidates", candidates), (KEPT, "kept", kept)]
    shown = [(stroke, word, segments) for stroke, word, segments in parts if segments is not None]
    panels = [np.ascontiguousarray(plain, np.uint8)]
    for stroke, _, segments in shown:
        panels.append(panels[0].copy())
        draw_stroke(panels[-1], list(segments), stroke, unit)
    joined = _joined(panels, round(4 * unit), axis=0 if width > 2 * height else 1)
    entries = [Entry(stroke, f"{len(segments)} {word}") for stroke, word, segments in shown]
    caption = ", ".join(["image", *(word for _, word, _ in shown)])
    band = legend_band(entries, caption, joined.shape[1], unit)
    missing = band.shape[1] - joined.shape[1]
    return np.concatenate([np.pad(joined, ((0, 0), (0, missing), (0, 0)), constant_values=WHITE), band])


def _joined(panels: list[NDArray[np.uint8]], gap: int, *, axis: int) -> NDArray[np.uint8]:
    shape = list(panels[0].shape)
    shape[axis] = gap
    between = np.full(shape, WHITE, np.uint8)
    return np.concatenate([part for panel in panels for part in (between, panel)][1:], axis=axis)
