"""How an edge looks along a segment: the step of brightness across it, point by point."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.errors import InvalidInput

Array = NDArray[np.float64]

SIDE = 2.0
"""px; how far from the edge, to either side, the brightness is taken: beyond the blur of a sharp image."""
TANGENT = 4
"""Points to either side that a tangent is taken over, so that sub-pixel noise isn't a turn."""


@dataclass(frozen=True, eq=False)
class EdgeProfile:
    """Brightness across a segment.

    Attributes:
        along: float64 ``(N,)``, arc length at each point, px.
        step: float64 ``(N,)``, brightness to the right of the way minus to the left, grey levels (0 to 255); y points
            down, so right of a line that runs to the right is below it.
    """

    along: Array
    step: Array

    @property
    def contrast(self) -> float:
        """Median of the step's size, grey levels."""
        return float(np.median(np.abs(self.step)))

    @property
    def evenness(self) -> float:
        """Lower quartile of the step's size over its median: 1 for an edge that is alike all along, 0 for gaps."""
        quartile, median = np.quantile(np.abs(self.step), (0.25, 0.5))
        return float(quartile / median) if median > 0 else 0.0

    @property
    def polarity(self) -> float:
        """Share of the points whose bright side is the one that most have, 0.5 to 1."""
        bright_right = float(np.mean(self.step > 0))
        return max(bright_right, 1 - bright_right)


def edge_profile(gray: NDArray[np.uint8], points: NDArray[np.float32]) -> EdgeProfile:
    """Measure the brightness on both sides of a segment.

    Args:
        gray: uint8 ``(H, W)``.
        points: float32 ``(N, 2)`` in px, in order, at least two.

    Raises:
        InvalidInput: On fewer than two points.
    """
    if len(points) < 2:
        raise InvalidInput(f"{len(points)} points", where="points", expected="at least 2")
    path = points.astype(np.float64)
    steps = np.hypot(*np.diff(path, axis=0).T)
    along = np.concatenate([[0.0], np.cumsum(steps)])
    index = np.arange(len(path))
    ahead, behind = np.minimum(index + TANGENT, len(path) - 1), np.maximum(index - TANGENT, 0)
    tangent = path[ahead] - path[behind]
    length = np.hypot(*tangent.T)
    tangent /= np.where(length > 0, length, 1.0)[:, None]
    right = SIDE * np.stack([-tangent[:, 1], tangent[:, 0]], -1)
    return EdgeProfile(along, _brightness(gray, path + right) - _brightness(gray, path - right))


def _brightness(gray: NDArray[np.uint8], places: Array) -> Array:
    """Interpolate linearly; beyond the frame the nearest pixel counts."""
    height, width = gray.shape
    x, y = (np.clip(values, 0, size - 1) for values, size in zip(places.T, (width, height), strict=True))
    left, top = (
        np.minimum(values.astype(np.int64), size - 2 if size > 1 else 0) for values, size in ((x, width), (y, height))
    )
    right, bottom = np.minimum(left + 1, width - 1), np.minimum(top + 1, height - 1)
    u, v = x - left, y - top
    upper = (1 - u) * gray[top, left] + u * gray[top, right]
    lower = (1 - u) * gray[bottom, left] + u * gray[bottom, right]
    return (1 - v) * upper + v * lower
