"""From numbers to places and colours: round ticks, axes, and a scale of few colours that print and eyes keep apart."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass

COLORS = ("#fdf6d8", "#f1d793", "#d9bd7c", "#a9a184", "#74858d", "#456790", "#1f4678", "#0c2447")
"""From paper to ink, each clearly darker than the one before, yellow to blue: grey print and colour-blind eyes see the
same order."""
NOTHING = 1e-9
"""Largest value of a map that is rounding alone."""
STEPS = (1, 2, 2.5, 5, 10)
UNEVEN = 5.0
"""Largest over middle value from which even classes would show a map of one colour."""


def nice_ticks(low: float, high: float, count: int = 5) -> list[float]:
    """Return round numbers from at or below `low` to at or above `high`, about `count` steps."""
    if not (math.isfinite(low) and math.isfinite(high)) or high <= low:
        high = low + 1 if math.isfinite(low) else 1.0
        low = low if math.isfinite(low) else 0.0
    raw = (high - low) / count
    power = 10 ** math.floor(math.log10(raw))
    step = next(each * power for each in STEPS if each * power >= raw * (1 - 1e-9))
    first, last = math.floor(low / step + 1e-9), math.ceil(high / step - 1e-9)
    return [index * step for index in range(first, last + 1)]


def inner_ticks(low: float, high: float, count: int = 5) -> list[float]:
    """Return round numbers that lie within the range."""
    slack = 1e-9 * (high - low)
    return [tick for tick in nice_ticks(low, high, count) if low - slack <= tick <= high + slack]


def label(value: float, step: float) -> str:
    """Return a tick's number with the decimals its step needs."""
    decimals = next((count for count in range(9) if _is_whole(step * 10**count)), 9)
    return f"{value:.{decimals}f}".replace("-", "−") if abs(value) < 1e6 else f"{value:.0e}"


def _is_whole(value: float) -> bool:
    return abs(value - round(value)) < 1e-6 * abs(value)


def short(value: float) -> str:
    """Return a number with about three digits, for a label of its own."""
    if value == 0 or abs(value) >= 100:
        return f"{value:,.0f}".replace(",", " ")
    return f"{value:.3g}" if abs(value) >= 0.001 else f"{value:.1e}"


@dataclass(frozen=True)
class Axis:
    """A straight map from numbers to px.

    Attributes:
        low: Number at `start`.
        high: Number at `end`.
        start: px.
        end: px.
    """

    low: float
    high: float
    start: float
    end: float

    def __call__(self, value: float) -> float:
        """Return the place of a number in px."""
        return self.start + (value - self.low) / (self.high - self.low) * (self.end - self.start)


@dataclass(frozen=True)
class ColorScale:
    """Numbers in classes of one colour each.

    Attributes:
        bounds: Ends of the classes, ascending; one more than there are classes.
    """

    bounds: tuple[float, ...]

    @classmethod
    def up_to(cls, values: Sequence[float]) -> ColorScale:
        """Return the scale from nothing to the largest of the values.

        In even steps; where few values are far above the rest, in steps of 1, 2, 5, 10..., so that both can be read.
        """
        highest = max(values, default=0.0)
        if highest < NOTHING:
            return cls(tuple(nice_ticks(0.0, 1.0, 6)))
        middle = sorted(values)[len(values) // 2] if values else highest
        if highest < UNEVEN * middle or middle <= 0:
            return cls(tuple(nice_ticks(0.0, highest, 6)))
        power = math.ceil(math.log10(highest))
        steps = [factor * 10.0**exponent for exponent in range(power - 4, power + 1) for factor in (1, 2, 5)]
        above = next(index for index, step in enumerate(steps) if step >= highest * (1 - 1e-9))
        return cls((0.0, *steps[max(above - len(COLORS) + 2, 0) : above + 1]))

    @property
    def colors(self) -> tuple[str, ...]:
        """One colour for each class, spread over the whole scale."""
        count = len(self.bounds) - 1
        return tuple(COLORS[round(index * (len(COLORS) - 1) / max(count - 1, 1))] for index in range(count))

    @property
    def labels(self) -> tuple[str, ...]:
        """The bounds as they are written."""
        steps = [high - low for low, high in zip(self.bounds, self.bounds[1:], strict=False)]
        even = max(steps) < 1.5 * min(steps)
        return tuple(label(bound, steps[0]) if even else f"{bound:g}" for bound in self.bounds)

    def color(self, value: float) -> str:
        """Return the colour of a number's class; beyond the ends, the last one's."""
        place = bisect_right(self.bounds, value) - 1
        return self.colors[min(max(place, 0), len(self.bounds) - 2)]
