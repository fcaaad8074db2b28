"""What the colours, crossed cells and arrows of a map mean."""

from __future__ import annotations

from dataclasses import dataclass

from app.calibration.plots.arrows import arrow
from app.calibration.plots.map_frame import TOP
from app.calibration.plots.scales import ColorScale
from app.calibration.plots.svg import FAINT, INK, RULE, element, line, text

SWATCH = 12.0
NOTE = 14.0


@dataclass(frozen=True)
class Legend:
    """A legend.

    Attributes:
        drawn: Its elements.
        bottom: Where it ends, px of the plot.
    """

    drawn: list[str]
    bottom: float


def map_legend(
    scale: ColorScale, unit: str, *, left: float, crossed: str | None = None, enlarged: float | None = None
) -> Legend:
    """Draw the classes from the bottom up with the numbers between them, then notes.

    Args:
        scale: Classes and colours.
        unit: Of the numbers.
        left: Its left side, px of the plot.
        crossed: What crossed cells mean, if there are any.
        enlarged: How much longer arrows are than what they show, if there are any.
    """
    classes = len(scale.colors)
    top = TOP + 14
    bottom = top + classes * SWATCH
    drawn = [text(unit, left, TOP + 7, fill=INK)]
    for index, color in enumerate(scale.colors):
        y = bottom - (index + 1) * SWATCH
        drawn.append(element("rect", x=left, y=y, width=SWATCH, height=SWATCH, fill=color))
    edge = {"fill": "none", "stroke": RULE, "stroke_width": 0.7}
    drawn.append(element("rect", x=left, y=top, width=SWATCH, height=classes * SWATCH, **edge))
    for index, bound in enumerate(scale.labels):
        drawn.append(text(bound, left + SWATCH + 4, bottom - index * SWATCH + 3.5))
    bottom += 4
    if crossed is not None:
        bottom += NOTE
        drawn.append(element("rect", x=left, y=bottom - 9, width=10, height=10, **edge))
        drawn.append(line((left, bottom + 1), (left + 10, bottom - 9), stroke=FAINT, width=0.6))
        drawn.append(text(crossed, left + 14, bottom))
    if enlarged is not None:
        bottom += NOTE
        drawn.append(element("path", d=arrow((left, bottom), (left + 11, bottom - 6)), stroke=INK, fill="none"))
        drawn.append(text(f"× {enlarged:g}", left + 15, bottom))
    return Legend(drawn, bottom + 6)
