"""The two axes that curves and bars stand on."""

from __future__ import annotations

from dataclasses import dataclass

from app.calibration.plots.scales import Axis, inner_ticks, label, nice_ticks
from app.calibration.plots.svg import FAINT, INK, RULE, line, text

LEFT, RIGHT, TOP, BOTTOM = 44.0, 12.0, 10.0, 36.0


@dataclass(frozen=True)
class Chart:
    """The area of a plot, with numbers along both sides.

    Attributes:
        across: Number to plot x.
        up: Number to plot y.
        across_ticks: Numbers below.
        up_ticks: Numbers at the left.
        width: Of the whole plot.
        height: Of the whole plot.
    """

    across: Axis
    up: Axis
    across_ticks: tuple[float, ...]
    up_ticks: tuple[float, ...]
    width: float
    height: float

    @classmethod
    def over(
        cls, x: tuple[float, float], y: tuple[float, float], *, width: float = 332.0, height: float = 200.0
    ) -> Chart:
        """Return a chart of these ranges, the upright one widened to round numbers."""
        across_ticks, up_ticks = inner_ticks(*x), nice_ticks(*y)
        return cls(
            Axis(*x, LEFT, width - RIGHT),
            Axis(up_ticks[0], up_ticks[-1], height - BOTTOM, TOP),
            tuple(across_ticks),
            tuple(up_ticks),
            width,
            height,
        )

    def axes(self, across_label: str, up_label: str) -> list[str]:
        """Draw rules, numbers and what they count."""
        left, right, bottom = self.across.start, self.across.end, self.up.start
        step = self.up_ticks[1] - self.up_ticks[0]
        drawn: list[str] = []
        for tick in self.up_ticks:
            at_zero = abs(tick) < 1e-9 * step
            drawn.append(line((left, self.up(tick)), (right, self.up(tick)), stroke=FAINT if at_zero else RULE,
                              width=1 if at_zero else 0.6))  # fmt: skip
            drawn.append(text(label(tick, step), left - 6, self.up(tick) + 3.5, anchor="end"))
        step = self.across_ticks[1] - self.across_ticks[0]
        for tick in self.across_ticks:
            drawn.append(line((self.across(tick), bottom), (self.across(tick), bottom + 4), stroke=FAINT))
            drawn.append(text(label(tick, step), self.across(tick), bottom + 14, anchor="middle"))
        drawn.append(text(across_label, (left + right) / 2, self.height - 6, anchor="middle", fill=INK))
        drawn.append(text(up_label, 9, (self.up.start + self.up.end) / 2, anchor="middle", fill=INK, turn=-90))
        return drawn
