"""The correlation of parameters as a matrix of squares."""

from __future__ import annotations

from collections.abc import Sequence

from app.calibration.plots.svg import INK, element, plot, text

SQUARE = 44.0
MARGIN = 30.0
POSITIVE, NEGATIVE = (27, 95, 168), (178, 90, 18)


def correlation_matrix(names: Sequence[str], values: Sequence[Sequence[float]]) -> str:
    """Draw the matrix: blue for together, orange for against each other, the number in each square."""
    size = MARGIN + SQUARE * len(names)
    drawn: list[str] = []
    for row, name in enumerate(names):
        middle = MARGIN + (row + 0.5) * SQUARE
        drawn.append(text(name, MARGIN - 6, middle + 3.5, anchor="end", fill=INK))
        drawn.append(text(name, middle, MARGIN - 8, anchor="middle", fill=INK))
        for column, value in enumerate(values[row]):
            x, y = MARGIN + column * SQUARE, MARGIN + row * SQUARE
            drawn.append(element("rect", x=x, y=y, width=SQUARE, height=SQUARE, fill=_color(value), stroke="#ffffff"))
            ink = "#ffffff" if abs(value) > 0.6 else INK
            number = f"{round(value, 2) + 0.0:.2f}".replace("-", "−")  # no negative zero
            drawn.append(text(number, x + SQUARE / 2, y + SQUARE / 2 + 3.5, anchor="middle", fill=ink))
    return plot(size, size, "Correlation of the parameters", drawn)


def _color(value: float) -> str:
    strength = min(abs(value), 1.0)
    end = POSITIVE if value >= 0 else NEGATIVE
    return "#" + "".join(f"{round(255 + strength * (channel - 255)):02x}" for channel in end)
