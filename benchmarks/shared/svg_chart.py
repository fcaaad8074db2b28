"""A line chart with marked points as SVG: enough for curves over two shares in [0, 1]."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.etree.ElementTree import Element, ElementTree, SubElement, indent

import numpy as np
from numpy.typing import NDArray

WIDTH, HEIGHT = 720, 480
LEFT, RIGHT, TOP, BOTTOM = 64, 24, 44, 56
LETTER_WIDTH = 7
COLORS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#000000")
"""Told apart by colour-blind people too (Okabe and Ito, 2008)."""


@dataclass(frozen=True, eq=False)
class Curve:
    """A curve through points ``(x, y)``, float64 ``(N,)`` each."""

    name: str
    x: NDArray[np.float64]
    y: NDArray[np.float64]


@dataclass(frozen=True)
class Mark:
    """A point with its name beside it."""

    name: str
    x: float
    y: float


def write_chart(
    path: Path, title: str, axes: tuple[str, str], curves: Sequence[Curve], marks: Sequence[Mark], highest: float = 1.0
) -> None:
    """Draw curves and marks over [0, 1] to the right and [0, ``highest``] upwards.

    Args:
        path: Where to write it.
        title: Stands above.
        axes: What is drawn to the right, and upwards.
        curves: In the order of their colours; their names stand in a legend.
        marks: Drawn over the curves.
        highest: Upper end, a multiple of 0.1; what lies above is cut.
    """

    def place(x: float, y: float) -> tuple[float, float]:
        right = LEFT + x * (WIDTH - LEFT - RIGHT)
        down = HEIGHT - BOTTOM - min(y / highest, 1.0) * (HEIGHT - TOP - BOTTOM)
        return round(right, 1), round(down, 1)

    svg = Element("svg", xmlns="http://www.w3.org/2000/svg", viewBox=f"0 0 {WIDTH} {HEIGHT}", width=str(WIDTH))
    svg.set("font-family", "sans-serif")
    svg.set("font-size", "13")
    SubElement(svg, "rect", width="100%", height="100%", fill="#fff")
    _text(svg, (LEFT, 26), title, weight="bold")
    _text(svg, (WIDTH / 2, HEIGHT - 14), axes[0], anchor="middle")
    upwards = _text(svg, (0, 0), axes[1], anchor="middle")
    upwards.set("transform", f"translate(18 {HEIGHT / 2}) rotate(-90)")
    for tenth in range(11):
        value = tenth / 10
        _line(svg, place(value, 0), place(value, highest))
        _text(svg, (place(value, 0)[0], HEIGHT - BOTTOM + 18), f"{value:.1f}", anchor="middle")
        if value <= highest + 1e-9:
            _line(svg, place(0, value), place(1, value))
            _text(svg, (LEFT - 8, place(0, value)[1] + 4), f"{value:.1f}", anchor="end")

    for index, curve in enumerate(curves):
        color = COLORS[index % len(COLORS)]
        points = " ".join("{},{}".format(*place(x, y)) for x, y in zip(curve.x, curve.y, strict=True))
        SubElement(svg, "polyline", {"points": points, "fill": "none", "stroke": color, "stroke-width": "2"})
        height = TOP + 18 + 20 * index
        swatch = _line(svg, (WIDTH - 210, height), (WIDTH - 180, height), color)
        swatch.set("stroke-width", "2")
        _text(svg, (WIDTH - 172, height + 4), curve.name)
    _draw_marks(svg, [(mark.name, *place(mark.x, mark.y)) for mark in marks])
    indent(svg)
    ElementTree(svg).write(path, encoding="utf-8")


def _draw_marks(svg: Element, marks: Sequence[tuple[str, float, float]]) -> None:
    """Draw points with their names: beneath, above or to the right, wherever no other name stands."""
    taken = [(x - 4, y - 4, x + 4, y + 4) for _, x, y in marks]
    for name, x, y in marks:
        SubElement(svg, "circle", {"cx": str(x), "cy": str(y), "r": "4", "fill": "#222"})
        width = LETTER_WIDTH * len(name)
        places = [(x - width / 2, y + 20), (x - width / 2, y - 10), (x + 8, y - 5), (x + 8, y + 12), (x + 8, y + 28)]
        boxes = [(left, base - 11, left + width, base + 3) for left, base in places]
        free = [box for box in boxes if not any(_overlap(box, other) for other in taken)]
        box = (free or boxes)[0]
        taken.append(box)
        words = _text(svg, (round(box[0], 1), round(box[3] - 3, 1)), name)
        words.attrib |= {"stroke": "#fff", "stroke-width": "3", "paint-order": "stroke"}


def _overlap(a: tuple[float, float, float, float], b: tuple[float, float, float, float]) -> bool:
    return a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]


def _line(svg: Element, begin: tuple[float, float], end: tuple[float, float], color: str = "#ddd") -> Element:
    ends = {"x1": str(begin[0]), "y1": str(begin[1]), "x2": str(end[0]), "y2": str(end[1])}
    return SubElement(svg, "line", {**ends, "stroke": color})


def _text(
    svg: Element, at: tuple[float, float], words: str, *, anchor: str = "start", weight: str = "normal"
) -> Element:
    element = SubElement(svg, "text", {"x": str(at[0]), "y": str(at[1]), "text-anchor": anchor, "font-weight": weight})
    element.text = words
    return element
