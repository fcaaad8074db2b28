"""The legend of a picture: a band below it, so that nothing of the picture is hidden."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from app.evaluation.strokes import Stroke, draw_stroke

_BACKGROUND = 250
_INK = (35, 35, 35)
_PALE_INK = (110, 110, 110)


@dataclass(frozen=True)
class Entry:
    """One line of a legend: a sample of the stroke and what it means."""

    stroke: Stroke
    text: str


def legend_band(entries: Sequence[Entry], caption: str, width: int, unit: float) -> NDArray[np.uint8]:
    """Draw a legend of the given width; entries that don't fit beside each other go below.

    Args:
        entries: What to explain, from left to right.
        caption: Pale text at the right, or in a row of its own.
        width: Width of the picture, px; a band is wider where a single entry needs it.
        unit: Line width of the picture, px, which sets the size of everything.

    Returns:
        uint8 ``(h, w, 3)``, BGR, ``w >= width``.
    """
    font = ImageFont.load_default(size=max(11.0, 5.8 * unit))
    text_height = font.getbbox("Hg")[3]
    margin, swatch, gap = round(4 * unit), round(15 * unit), round(2.5 * unit)
    row_height = round(1.7 * text_height)

    widths = [swatch + gap + round(font.getlength(entry.text)) for entry in entries]
    caption_width = round(font.getlength(caption))
    rows = _rows([*widths, caption_width], width - 2 * margin, round(7 * unit))
    band_width = max(width, 2 * margin + max([*widths, caption_width]))
    height = row_height * (1 + max(row for row, _ in rows)) + margin

    picture = Image.new("RGB", (band_width, height), (_BACKGROUND,) * 3)
    pen = ImageDraw.Draw(picture)
    middles = [margin // 2 + row * row_height + row_height / 2 for row, _ in rows]
    for entry, (_, x), middle in zip(entries, rows, middles, strict=False):
        pen.text((margin + x + swatch + gap, middle), entry.text, fill=_INK, font=font, anchor="lm")
    pen.text((band_width - margin, middles[-1]), caption, fill=_PALE_INK, font=font, anchor="rm")

    band = np.array(picture)[..., ::-1].copy()
    for entry, (_, x), middle in zip(entries, rows, middles, strict=False):
        line = np.array([[margin + x + unit, middle], [margin + x + swatch - unit, middle]])
        draw_stroke(band, [line], entry.stroke, unit)
    return band


def _rows(widths: Sequence[int], available: int, gap: int) -> list[tuple[int, int]]:
    """Lay out items from left to right: row and x of each."""
    places, row, x = [], 0, 0
    for width in widths:
        if x and x + width > available:
            row, x = row + 1, 0
        places.append((row, x))
        x += width + gap
    return places
