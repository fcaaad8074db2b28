"""The image frame: its centre, its half diagonal and grids of points on it (px, pixel centre at integers)."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray


def center_of(width: int, height: int) -> tuple[float, float]:
    """Return the middle of the image in px."""
    return (width - 1) / 2, (height - 1) / 2


def half_diagonal(width: int, height: int) -> float:
    """Return half the image's diagonal in px, the unit of all lens coefficients here."""
    return math.hypot(width, height) / 2


def frame_grid(width: int, height: int, columns: int = 40) -> NDArray[np.float64]:
    """Return a regular grid over the frame, corners included, float64 ``(N, 2)`` in px.

    Args:
        width: Image width in px.
        height: Image height in px.
        columns: Points along the width; along the height as many as keep the cells square, at least 8.
    """
    rows = max(8, int(columns * height / width))
    axes = np.meshgrid(np.linspace(0, width - 1, columns), np.linspace(0, height - 1, rows))
    return np.stack(axes, -1).reshape(-1, 2)
