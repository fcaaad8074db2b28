"""Bringing what cameras deliver to 8 bit."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.errors import InvalidImage

_LOW_PERCENTILE, _HIGH_PERCENTILE = 0.5, 99.5
_BLOCK_PIXELS = 1 << 20


def to_eight_bit(image: NDArray[Any]) -> NDArray[np.uint8]:
    """Bring an image to 8 bit.

    uint8 is returned as it is. Every other kind is stretched linearly so that its 0.5 and 99.5 percentiles
    become 0 and 255; a colour image is stretched over all channels together, which keeps its hue. An image whose
    two percentiles are equal is stretched between its extremes; a constant one becomes black.

    Args:
        image: uint8, uint16 or floating point, ``(H, W)`` or ``(H, W, C)``.

    Returns:
        uint8, same shape.

    Raises:
        InvalidImage: On another dtype or rank, no pixels, or values that aren't finite.
    """
    if image.ndim not in (2, 3) or image.size == 0:
        raise InvalidImage(f"an array of shape {image.shape} is no image", expected="(H, W) or (H, W, C), not empty")
    if image.dtype == np.uint8:
        return image
    if image.dtype != np.uint16 and not np.issubdtype(image.dtype, np.floating):
        raise InvalidImage(f"pixels of type {image.dtype} aren't read", expected="uint8, uint16 or float")
    if image.dtype != np.uint16 and not np.isfinite(image).all():
        row, column = np.argwhere(~np.isfinite(image))[0][:2]
        raise InvalidImage("a pixel is not finite", where=f"x {column}, y {row}", expected="no NaN, no infinity")
    low, high = _range(image)
    result = np.zeros(image.shape, np.uint8)
    if high <= low:
        return result
    for rows in _blocks(image):
        result[rows] = _stretch(image[rows], low, high)
    return result


def _blocks(image: NDArray[Any]) -> Iterator[slice]:
    """Rows that are worked on at once: what is computed meanwhile takes 8 bytes and more a pixel."""
    step = max(1, _BLOCK_PIXELS * len(image) // image.size)
    return (slice(row, row + step) for row in range(0, len(image), step))


def _stretch(image: NDArray[Any], low: float, high: float) -> NDArray[np.uint8]:
    if image.dtype == np.uint16:
        table = (np.arange(65536) - low) * (255.0 / (high - low))
        return np.rint(np.clip(table, 0, 255)).astype(np.uint8)[image]
    # dividing first: a range near the largest double must not overflow
    scaled = (image.astype(np.float64) / (high - low) - low / (high - low)) * 255.0
    return np.rint(np.clip(scaled, 0, 255)).astype(np.uint8)


def _range(image: NDArray[Any]) -> tuple[float, float]:
    if image.dtype == np.uint16:
        # a histogram takes 65536 counts where sorting would take a copy of the image
        histogram = np.zeros(65536, np.int64)
        for rows in _blocks(image):
            histogram += np.bincount(image[rows].ravel(), minlength=65536)
        counts = np.cumsum(histogram)
        ranks = np.array([_LOW_PERCENTILE, _HIGH_PERCENTILE]) / 100 * (counts[-1] - 1)
        below = np.searchsorted(counts, np.floor(ranks), side="right")
        above = np.searchsorted(counts, np.ceil(ranks), side="right")
        low, high = (below + (above - below) * (ranks - np.floor(ranks))).tolist()
    else:
        low, high = (float(v) for v in np.percentile(image, [_LOW_PERCENTILE, _HIGH_PERCENTILE]))
    if high <= low:
        low, high = float(image.min()), float(image.max())
    return low, high
