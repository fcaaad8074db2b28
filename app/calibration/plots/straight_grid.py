"""A grid of straight lines as the camera shows it, and the image as the correction straightens it."""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray

from app.calibration.lens import CameraLens
from app.calibration.plots.svg import BLUE, FAINT, INK, RULE, element, path, plot, text
from app.vision.frame import center_of

Array = NDArray[np.float64]
ACROSS = 12
STEPS = 41
GAP = 24.0
HEAD = 16.0
TALLEST = 160.0


def straight_grid(lens: CameraLens, *, width: float = 680.0) -> str:
    """Draw both, side by side: straight lines of the scene bend before the correction, the image's edge bends after.

    Chords in grey make the bend visible before; the frame's outline shows how the correction moves its corners after.
    """
    panel = (width - GAP) / 2
    border = _outline(lens)
    corrected = lens.undistort(border)
    corrected = corrected[np.isfinite(corrected).all(axis=1)]
    low, high = corrected.min(axis=0), corrected.max(axis=0)
    lines = _grid(low, high, lens)
    left = _panel(border, panel, 0.0)
    right = _panel(np.concatenate([corrected, border]), panel, panel + GAP)
    measured = [part for each in lines for part in _inside(lens.distort(each), lens)]
    chords = "".join(path(_points(left(part[[0, -1]]))) for part in measured)
    curves = "".join(path(_points(left(part))) for part in measured)
    straight = "".join(path(_points(right(lens.undistort(part)))) for part in measured)
    height = HEAD + max(left.height, right.height) + 2
    return plot(
        width,
        height,
        "A straight grid as the camera shows it, and after the correction",
        [
            text("as the camera shows straight lines (grey: chords)", 0, 10, fill=INK),
            text("after the correction (grey: the frame before)", panel + GAP, 10, fill=INK),
            element("path", d=path(_points(left(border)), closed=True), fill="none", stroke=INK),
            element("path", d=chords, fill="none", stroke=FAINT, stroke_width=0.6, stroke_dasharray="3 2"),
            element("path", d=curves, fill="none", stroke=BLUE, stroke_width=1.1),
            element("path", d=path(_points(right(border)), closed=True), fill="none", stroke=RULE),
            element("path", d=path(_points(right(corrected)), closed=True), fill="none", stroke=INK),
            element("path", d=straight, fill="none", stroke=BLUE, stroke_width=1.1),
        ],
    )


class _Panel:
    """From px of the image to a part of the plot."""

    def __init__(self, low: Array, scale: float, left: float, height: float) -> None:
        self.low, self.scale, self.left, self.height = low, scale, left, height

    def __call__(self, points: Array) -> Array:
        return self.scale * (points - self.low) + [self.left, HEAD]


def _panel(points: Array, width: float, left: float) -> _Panel:
    low, high = points.min(axis=0), points.max(axis=0)
    scale = min((width - 2) / (high[0] - low[0]), TALLEST / (high[1] - low[1]))
    return _Panel(low - 1 / scale, scale, left, scale * (high[1] - low[1]) + 2)


def _outline(lens: CameraLens) -> Array:
    """Return points along the frame's edge, clockwise."""
    right, bottom = lens.width - 1, lens.height - 1
    corners = np.array([[0, 0], [right, 0], [right, bottom], [0, bottom], [0, 0]], np.float64)
    steps = np.linspace(0, 1, STEPS)[:-1, None]
    return np.concatenate([a + steps * (b - a) for a, b in itertools.pairwise(corners)])


def _grid(low: Array, high: Array, lens: CameraLens) -> list[Array]:
    """Return straight lines over the corrected frame, a round number of squares across, through its centre."""
    step = lens.width / ACROSS
    center = np.array(center_of(lens.width, lens.height))
    lines: list[Array] = []
    for axis in (0, 1):
        other = 1 - axis
        first, last = np.ceil((low[axis] - center[axis]) / step), np.floor((high[axis] - center[axis]) / step)
        for index in np.arange(first, last + 1):
            points = np.empty((4 * STEPS, 2))
            points[:, axis] = center[axis] + index * step
            points[:, other] = np.linspace(low[other], high[other], 4 * STEPS)
            lines.append(points)
    return lines


def _inside(points: Array, lens: CameraLens) -> list[Array]:
    """Return the parts of a polyline that lie within the frame."""
    with np.errstate(invalid="ignore"):
        inner = (points >= 0) & (points <= [lens.width - 1, lens.height - 1])
    within = np.asarray(inner.all(axis=1))
    ends = np.flatnonzero(np.diff(within.astype(np.int8))) + 1
    parts = np.split(points, ends)
    return [part for part, first in zip(parts, [0, *ends.tolist()], strict=True) if within[first] and len(part) > 1]


def _points(points: Array) -> list[tuple[float, float]]:
    return [(x, y) for x, y in points.tolist()]
