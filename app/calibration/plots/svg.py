"""SVG as text: elements with escaped attributes and content, and the frame that every plot stands in."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape

INK = "#1f2937"
FAINT = "#667080"
RULE = "#c3cad4"
BLUE = "#1b5fa8"
PALE_BLUE = "#bcd3ea"
RED = "#b23a12"
FONT = 10
"""Size of text in the plots' own px, which are CSS px at the width a plot is made for: 7.5 pt on paper."""

Point = tuple[float, float]


def number(value: float) -> str:
    """Return a coordinate with two decimals at most."""
    text = f"{value:.2f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def element(name: str, *children: str, **attributes: str | float | None) -> str:
    """Return an element; ``stroke_width`` is written ``stroke-width``, and what is ``None`` is left out."""
    written = [
        f' {key.rstrip("_").replace("_", "-")}="{escape(value if isinstance(value, str) else number(value))}"'
        for key, value in attributes.items()
        if value is not None
    ]
    inner = "".join(children)
    return f"<{name}{''.join(written)}>{inner}</{name}>" if inner else f"<{name}{''.join(written)}/>"


def text(
    content: str, x: float, y: float, *, anchor: str = "start", fill: str = FAINT, size: float = FONT, turn: float = 0
) -> str:
    """Return a line of text; `y` is its base line, `turn` its angle in degrees."""
    turned = f"rotate({number(turn)} {number(x)} {number(y)})" if turn else None
    return element("text", escape(content), x=x, y=y, text_anchor=anchor, fill=fill, font_size=size, transform=turned)


def line(start: Point, end: Point, *, stroke: str = RULE, width: float = 1, dashes: str | None = None) -> str:
    """Return a straight line."""
    return element(
        "line", x1=start[0], y1=start[1], x2=end[0], y2=end[1], stroke=stroke, stroke_width=width,
        stroke_dasharray=dashes,
    )  # fmt: skip


def path(points: Iterable[Point], *, closed: bool = False) -> str:
    """Return the ``d`` of a polyline."""
    steps = [f"{number(x)} {number(y)}" for x, y in points]
    return f"M{'L'.join(steps)}{'Z' if closed else ''}" if steps else ""


def plot(width: float, height: float, title: str, children: Sequence[str]) -> str:
    """Return a whole plot: sized by its view box, so that it takes the width it is given.

    Args:
        width: In its own px, of which text has 10.
        height: Likewise.
        title: What it shows, for who can't see it.
        children: Its elements.
    """
    body = "".join(children)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {number(width)} {number(height)}" '
        f'width="{number(width)}" height="{number(height)}" role="img" '
        f'font-family="system-ui, \'Liberation Sans\', Arial, sans-serif" style="max-width:100%;height:auto">'
        f"<title>{escape(title)}</title>{body}</svg>"
    )
