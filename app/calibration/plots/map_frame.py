"""Where the image lies in a plot, with its px along two sides."""

from __future__ import annotations

from dataclasses import dataclass

from app.calibration.plots.scales import Axis, inner_ticks, label
from app.calibration.plots.svg import INK, element, line, text

LEFT, TOP, BOTTOM, LEGEND = 34.0, 8.0, 22.0, 66.0


@dataclass(frozen=True)
class MapFrame:
    """Where the image lies in a plot.

    Attributes:
        across: Image x in px to plot x.
        down: Image y in px to plot y.
        plot_width: Of the whole plot.
        plot_height: Of the whole plot.
    """

    across: Axis
    down: Axis
    plot_width: float
    plot_height: float

    @classmethod
    def fit(cls, image_width: int, image_height: int, plot_width: float, tallest: float = 150.0) -> MapFrame:
        """Return the frame of an image: as wide as the plot lets it, unless it would be too tall."""
        width = plot_width - LEFT - LEGEND
        scale = min(width / image_width, tallest / image_height)
        right, bottom = LEFT + scale * image_width, TOP + scale * image_height
        return cls(
            Axis(-0.5, image_width - 0.5, LEFT, right),
            Axis(-0.5, image_height - 0.5, TOP, bottom),
            plot_width,
            bottom + BOTTOM,
        )


def frame_axes(frame: MapFrame, size: tuple[int, int]) -> list[str]:
    """Draw the frame's edge and its px."""
    across, down = frame.across, frame.down
    drawn = [
        element("rect", x=across.start, y=down.start, width=across.end - across.start, height=down.end - down.start,
                fill="none", stroke=INK, stroke_width=1)
    ]  # fmt: skip
    ticks = inner_ticks(0, size[0], 4)
    step = ticks[1] - ticks[0]
    for tick in ticks:
        drawn.append(line((across(tick), down.end), (across(tick), down.end + 3), stroke=INK))
        drawn.append(text(label(tick, step), across(tick), down.end + 13, anchor="middle"))
    ticks = inner_ticks(0, size[1], 4 if down.end - down.start > 90 else 2)
    step = ticks[1] - ticks[0] if len(ticks) > 1 else 1
    for tick in ticks:
        drawn.append(line((across.start - 3, down(tick)), (across.start, down(tick)), stroke=INK))
        drawn.append(text(label(tick, step), across.start - 5, down(tick) + 3.5, anchor="end"))
    return drawn
