"""A picture of what an evaluation found: hits, false alarms and misses on the image.

Colours are those of the ClearLines paper (green, red, orange) in shades that differ in lightness; as a second sign for
people who can't tell them apart, hits are solid, false alarms dashed and misses dotted.
"""

from __future__ import annotations

from typing import Protocol

import cv2
import numpy as np
from numpy.typing import NDArray

from app.errors import InvalidImage
from app.evaluation.legend import Entry, legend_band
from app.evaluation.outcome import Outcome, Outcomes
from app.evaluation.strokes import Pattern, Stroke, draw_stroke
from app.vision.segments import Segments

STROKES = {
    Outcome.IGNORED: Stroke((190, 190, 190), Pattern.SOLID, 0.6),
    Outcome.FALSE_ALARM: Stroke((70, 60, 235), Pattern.DASHED, 0.9),
    Outcome.HIT: Stroke((90, 215, 60), Pattern.SOLID),
    Outcome.MISS: Stroke((0, 170, 255), Pattern.DOTTED, 1.15),
}
"""How each outcome is drawn, from the lowest layer to the highest."""

_NAMES = {
    Outcome.HIT: ("hit", "hits"),
    Outcome.FALSE_ALARM: ("false alarm", "false alarms"),
    Outcome.MISS: ("miss", "misses"),
    Outcome.IGNORED: ("not counted", "not counted"),
}


class Scored(Protocol):
    """What a picture needs of an image's score, whatever the protocol."""

    @property
    def protocol(self) -> str:
        """Name of the protocol."""
        ...

    @property
    def precision(self) -> float:
        """Precision of the image."""
        ...

    @property
    def recall(self) -> float | None:
        """Recall of the image, if defined."""
        ...

    @property
    def outcomes(self) -> Outcomes:
        """What became of each prediction and label."""
        ...


def draw_overlay(
    image: NDArray[np.uint8], labels: Segments, predictions: Segments, result: Scored
) -> NDArray[np.uint8]:
    """Draw true positives, false positives and false negatives on the image, which is shown in grey.

    Args:
        image: uint8 ``(H, W)`` or BGR ``(H, W, 3)``.
        labels: The L labels that ``result`` is about, ignored ones included, px.
        predictions: Its P predictions, px. The point (x, y) is drawn at the centre of pixel (x, y).
        result: The image's score.

    Returns:
        uint8 BGR: the picture at full resolution, from the upper left corner, and below it a legend. Wider than the
        image only where the legend needs it.

    Raises:
        InvalidImage: When the image has another type or shape.
    """
    canvas = _background(image)
    unit = line_width(canvas.shape[1], canvas.shape[0])
    outcomes = result.outcomes
    for outcome, stroke in STROKES.items():
        chosen = list(predictions.select(outcomes.predictions == outcome))
        if outcome is not Outcome.HIT:  # a found label lies under the prediction that found it
            chosen += list(labels.select(outcomes.labels == outcome))
        draw_stroke(canvas, chosen, stroke, unit)
    band = legend_band(_entries(outcomes), _caption(result), canvas.shape[1], unit)
    missing = band.shape[1] - canvas.shape[1]
    canvas = np.pad(canvas, ((0, 0), (0, missing), (0, 0)), constant_values=255)
    return np.concatenate([canvas, band])


def line_width(width: int, height: int) -> float:
    """Return the line width that suits a picture of this size, px: 2.2 up to about a megapixel, then in proportion."""
    return max(2.2, float(np.hypot(width, height)) / 640.0)


def _background(image: NDArray[np.uint8]) -> NDArray[np.uint8]:
    if image.dtype != np.uint8 or not (image.ndim == 2 or (image.ndim == 3 and image.shape[2] == 3)) or not image.size:
        raise InvalidImage(
            f"an image of {image.dtype} and shape {image.shape} can't be drawn on", expected="uint8 (H, W) or (H, W, 3)"
        )
    gray = image if image.ndim == 2 else cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)
    # a little less contrast leaves room above and below for the lines
    levels = np.rint(24 + np.arange(256) * (212 / 255)).astype(np.uint8)
    return cv2.cvtColor(cv2.LUT(gray, levels), cv2.COLOR_GRAY2BGR).astype(np.uint8)


def _entries(outcomes: Outcomes) -> list[Entry]:
    entries = []
    for outcome, (one, many) in _NAMES.items():
        count = outcomes.counted(outcome)
        if count or outcome is not Outcome.IGNORED:
            entries.append(Entry(STROKES[outcome], f"{count} {one if count == 1 else many}"))
    return entries


def _caption(result: Scored) -> str:
    recall = "-" if result.recall is None else f"{result.recall:.2f}"
    return f"{result.protocol}: P {result.precision:.2f}, R {recall}"
