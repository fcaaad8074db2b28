"""Bars: how residuals are spread, and how they compare from image to image."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from app.calibration.plots.chart import Chart
from app.calibration.plots.scales import Axis, inner_ticks, label, short
from app.calibration.plots.svg import BLUE, FAINT, INK, PALE_BLUE, RED, RULE, element, line, plot, text

BINS = 24
ROW = 13.5
NAME_LENGTH = 38


def histogram(
    values: ArrayLike, *, title: str, what: str, unit: str = "px", mark: float | None = None, mark_label: str = "",
    width: float = 332.0, height: float = 200.0,
) -> str:  # fmt: skip
    """Draw how often which number occurs; the last bar has everything from the 99th percentile on.

    Args:
        values: The numbers, at least 0, any length.
        title: What it shows.
        what: What is counted at the left.
        unit: Of the numbers.
        mark: A number to draw a rule at.
        mark_label: What it is.
        width: Of the plot.
        height: Likewise.
    """
    given = np.asarray(values, np.float64)
    given = given[np.isfinite(given)]
    high = float(np.quantile(given, 0.99)) if len(given) else 1.0
    high = max(high, mark or 0.0, 1e-3) * 1.02
    edges = np.linspace(0, high, BINS + 1)
    counts, _ = np.histogram(np.minimum(given, high), edges)
    chart = Chart.over((0.0, high), (0.0, float(max(counts.max(initial=0), 1))), width=width, height=height)
    bars = [
        element("rect", x=chart.across(left) + 0.5, y=chart.up(count), fill=BLUE,
                width=max(chart.across(right) - chart.across(left) - 1, 0.5), height=chart.up(0) - chart.up(count))
        for left, right, count in zip(edges.tolist(), edges[1:].tolist(), counts.tolist(), strict=False)
        if count
    ]  # fmt: skip
    drawn = [*chart.axes(f"{title}, {unit}", what), *bars]
    if mark is not None:
        at = chart.across(mark)
        right = at < (chart.across.start + chart.across.end) / 2
        drawn.append(line((at, chart.up.start), (at, chart.up.end), stroke=RED, width=1.2, dashes="4 3"))
        drawn.append(
            text(mark_label, at + (4 if right else -4), chart.up.end + 8, anchor="start" if right else "end", fill=RED)
        )
    return plot(chart.width, chart.height, f"{title}: {len(given)} values", drawn)


def image_bars(
    rows: Sequence[tuple[str, float | None, int, int]], *, noise: float | None = None, width: float = 680.0
) -> str:
    """Draw the residual of each image as a bar, with its name and how many of its lines count.

    Args:
        rows: Name, RMS residual in px or ``None``, lines that count, lines given; top first.
        noise: RMS of all, drawn as a rule.
        width: Of the plot.
    """
    left, right = 0.36 * width, width - 96
    highest = max((rms for _, rms, _, _ in rows if rms is not None), default=1.0)
    across = Axis(0.0, max(highest, noise or 0.0, 1e-6) * 1.02, left, right)
    height = 16 + ROW * len(rows) + 22
    drawn: list[str] = [
        text("RMS residual, px", left, 10, fill=INK),
        text("lines that count", width, 10, anchor="end", fill=INK),
    ]
    ticks = inner_ticks(0, across.high, 5)
    for tick in ticks:
        drawn.append(line((across(tick), 16), (across(tick), height - 20), stroke=RULE, width=0.6))
        drawn.append(text(label(tick, ticks[1]), across(tick), height - 9, anchor="middle"))
    for index, (name, rms, counted, given) in enumerate(rows):
        y = 16 + ROW * index
        drawn.append(text(_cut(name), left - 8, y + 10, anchor="end", fill=INK))
        if rms is not None:
            drawn.append(element("rect", x=left, y=y + 2.5, width=across(rms) - left, height=ROW - 4, fill=PALE_BLUE))
            drawn.append(text(short(rms), left + 4, y + 10, fill=INK))
        else:
            drawn.append(text("no line counts", left + 4, y + 10, fill=FAINT))
        drawn.append(text(f"{counted} of {given}", width, y + 10, anchor="end"))
    if noise is not None:
        drawn.append(line((across(noise), 16), (across(noise), height - 20), stroke=RED, width=1.2, dashes="4 3"))
    return plot(width, height, f"Residuals of {len(rows)} images", drawn)


def _cut(name: str) -> str:
    return name if len(name) <= NAME_LENGTH else f"…{name[-NAME_LENGTH + 1 :]}"
