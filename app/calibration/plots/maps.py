"""A map over the image frame: cells in classes of colour, a legend with its unit, arrows if wanted."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

from app.calibration.plots.arrows import Rows, enlarged_arrows
from app.calibration.plots.legend import map_legend
from app.calibration.plots.map_frame import MapFrame, frame_axes
from app.calibration.plots.scales import ColorScale
from app.calibration.plots.svg import FAINT, element, path, plot

OVERLAP = 0.3
"""px that cells reach into each other, since viewers show seams between edges that meet."""


def map_plot(
    x: Sequence[float],
    y: Sequence[float],
    values: Rows,
    size: tuple[int, int],
    *,
    title: str,
    unit: str = "px",
    empty: str | None = None,
    arrows: tuple[Rows, Rows] | None = None,
    width: float = 332.0,
) -> str:
    """Draw numbers over the frame.

    Args:
        x: Columns of the grid, image px.
        y: Rows of the grid, image px.
        values: One number for each row and column; ``None`` where there is none.
        size: Width and height of the image in px.
        title: What it shows.
        unit: Of the numbers.
        empty: What a cell of nothing means, to mark cells of zero: "no line", say.
        arrows: Displacement along x and y at each cell, px; drawn enlarged, the scale is said below the legend.
        width: Of the plot.
    """
    frame = MapFrame.fit(*size, width)
    known = [value for row in values for value in row if _is_known(value)]
    scale = ColorScale.up_to([value for value in known if value is not None])
    across, down = _edges(x, size[0]), _edges(y, size[1])
    cells: list[str] = []
    marked: list[str] = []
    for row, (top, bottom) in zip(values, itertools.pairwise(down), strict=True):
        for value, (left, right) in zip(row, itertools.pairwise(across), strict=True):
            box = (frame.across(left), frame.down(top), frame.across(right), frame.down(bottom))
            if value is None or not math.isfinite(value) or (empty is not None and value <= 0):
                marked.append(path([(box[0], box[3]), (box[2], box[1])]))
            else:
                cells.append(_cell(box, scale.color(value)))
    drawn = [element("g", *cells), *_crossed(marked), *frame_axes(frame, size)]
    enlarged: float | None = None
    if arrows is not None:
        vectors, enlarged = enlarged_arrows(x, y, arrows, frame)
        drawn.append(vectors)
    legend = map_legend(
        scale, unit, left=frame.across.end + 10, crossed=(empty or "unknown") if marked else None, enlarged=enlarged
    )
    height = max(frame.plot_height, legend.bottom)
    return plot(frame.plot_width, height, title, [*drawn, *legend.drawn])


def _is_known(value: float | None) -> bool:
    return value is not None and math.isfinite(value)


def _edges(centers: Sequence[float], size: int) -> list[float]:
    """Return the edges of cells around grid points, ending at the image's."""
    between = [(first + second) / 2 for first, second in itertools.pairwise(centers)]
    return [-0.5, *between, size - 0.5]


def _cell(box: tuple[float, float, float, float], fill: str) -> str:
    left, top, right, bottom = box
    return element("rect", x=left, y=top, width=right - left + OVERLAP, height=bottom - top + OVERLAP, fill=fill)


def _crossed(marked: Sequence[str]) -> list[str]:
    return [element("path", d="".join(marked), stroke=FAINT, stroke_width=0.6, fill="none")] if marked else []
