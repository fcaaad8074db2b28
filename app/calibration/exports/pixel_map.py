"""Where each pixel of an image comes from, as an array: exact at every fourth pixel, interpolated between."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
PlaneMap = Callable[[Array], Array]

CELL = 4
"""px between the exact ones; what is between is good to some thousandths of a px."""
NOWHERE = -1e4
"""Coordinate in px that stands for "no source": far outside any image, where NaN would spread over neighbours."""


def pixel_map(lookup: PlaneMap, width: int, height: int) -> NDArray[np.float32]:
    """Look a map up at every pixel.

    Args:
        lookup: Maps points ``(N, 2)`` in px to points ``(N, 2)`` in px, NaN where there is none.
        width: Of the image in px.
        height: Of the image in px.

    Returns:
        float32 ``(H, W, 2)``: x and y in px, `NOWHERE` where there is none.
    """
    columns, rows = ((size - 1) // CELL + 2 for size in (width, height))
    x, y = np.meshgrid(CELL * np.arange(columns, dtype=np.float64), CELL * np.arange(rows, dtype=np.float64))
    nodes = lookup(np.stack([x, y], -1).reshape(-1, 2)).reshape(rows, columns, 2)
    across, down = np.arange(width), np.arange(height)
    found = np.empty((height, width, 2), np.float32)
    for axis in range(2):
        tall = _between(nodes[:, :, axis], down)
        found[:, :, axis] = _between(tall.T, across).T
    np.nan_to_num(found, copy=False, nan=NOWHERE)
    return found


def interpolated(lookup: PlaneMap, pixels: Array) -> Array:
    """Return what `pixel_map` holds at whole pixels ``(N, 2)``, without computing all of it; NaN for "nowhere"."""
    corner = CELL * (pixels // CELL)
    share = (pixels - corner) / CELL
    total = np.zeros_like(pixels)
    for right, below in ((0, 0), (1, 0), (0, 1), (1, 1)):
        weight = np.abs(1 - right - share[:, 0]) * np.abs(1 - below - share[:, 1])
        total += weight[:, None] * lookup(corner + CELL * np.array([right, below], np.float64))
    return total


def _between(nodes: Array, pixels: NDArray[np.int64]) -> Array:
    """Interpolate along the first axis."""
    at, share = pixels // CELL, (pixels % CELL) / CELL
    return nodes[at] * (1 - share)[:, None] + nodes[at + 1] * share[:, None]
