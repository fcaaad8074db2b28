"""Reading an image between its pixels."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

COLUMNS = 1024
ROWS = 16_384
"""cv2.remap takes maps of at most 32,767 rows and columns: many places are laid out as pictures of this size."""


def read_image(image: NDArray[np.float32], places: NDArray[np.float64]) -> NDArray[np.float32]:
    """Return an image's values at any places, interpolated linearly; beyond its border, the border's value.

    Args:
        image: float32 ``(H, W)``.
        places: float64 ``(..., 2)`` in px, x right, y down, pixel centre at integers.

    Returns:
        float32 ``(...)``.
    """
    flat = places.reshape(-1, 2).astype(np.float32)
    rows = -(-len(flat) // COLUMNS)
    padded = np.zeros((rows * COLUMNS, 2), np.float32)
    padded[: len(flat)] = flat
    x, y = (padded[:, axis].reshape(rows, COLUMNS) for axis in range(2))
    taken = np.empty((rows, COLUMNS), np.float32)
    for first in range(0, rows, ROWS):
        block = np.s_[first : first + ROWS]
        taken[block] = cv2.remap(image, x[block], y[block], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    return taken.reshape(-1)[: len(flat)].reshape(places.shape[:-1])
