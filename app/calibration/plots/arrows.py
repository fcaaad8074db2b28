"""Displacements as arrows over a map, all enlarged by one round factor."""

from __future__ import annotations

import math
from collections.abc import Sequence

from app.calibration.plots.map_frame import MapFrame
from app.calibration.plots.svg import Point, element, number, path

Rows = Sequence[Sequence[float | None]]

NOTHING = 1e-9
"""Part of the gap between two arrows below which all displacements are rounding."""


def enlarged_arrows(
    x: Sequence[float], y: Sequence[float], arrows: tuple[Rows, Rows], frame: MapFrame
) -> tuple[str, float]:
    """Draw every so many cells' displacement, enlarged until the longest spans the gap between two.

    Returns:
        The arrows, and how much longer they are than the displacements.
    """
    every = max(1, round(len(x) / 12))
    picked = [
        (x[column], y[row], dx, dy)
        for row in range(every // 2, len(y), every)
        for column in range(every // 2, len(x), every)
        if (dx := arrows[0][row][column]) is not None and (dy := arrows[1][row][column]) is not None
    ]
    longest = max((math.hypot(dx, dy) for _, _, dx, dy in picked), default=0.0)
    gap = every * (x[1] - x[0]) if len(x) > 1 else 1.0
    enlarged = _round_down(gap / longest) if longest > NOTHING * gap else 1.0
    drawn = [
        arrow((frame.across(u), frame.down(v)), (frame.across(u + enlarged * dx), frame.down(v + enlarged * dy)))
        for u, v, dx, dy in picked
        if math.hypot(dx, dy) > 0.03 * longest
    ]
    halo = element("path", d="".join(drawn), stroke="#ffffff", stroke_width=2.2, stroke_opacity=0.7, fill="none")
    strokes = element("path", d="".join(drawn), stroke="#000000", stroke_width=0.9, fill="none")
    return _within(frame, halo + strokes), enlarged


def _within(frame: MapFrame, drawn: str) -> str:
    """Cut off at the frame's edge; an inner viewport does so without an id, which would have to be the page's only."""
    left, top = frame.across.start, frame.down.start
    width, height = frame.across.end - left, frame.down.end - top
    box = " ".join(map(number, (left, top, width, height)))
    return element("svg", drawn, x=left, y=top, width=width, height=height, viewBox=box)


def _round_down(value: float) -> float:
    power = 10 ** math.floor(math.log10(value))
    return max(step * power for step in (1, 2, 5) if step * power <= value * (1 + 1e-9))


def arrow(start: Point, end: Point) -> str:
    """Return the ``d`` of one arrow."""
    across, down = end[0] - start[0], end[1] - start[1]
    length = math.hypot(across, down) or 1.0
    head = min(3.5, 0.4 * length) / length
    sides = [
        (end[0] - head * (across + turn * 0.7 * down), end[1] - head * (down - turn * 0.7 * across)) for turn in (1, -1)
    ]
    return path([start, end]) + path([sides[0], end, sides[1]])
