"""Directional Canny: local maxima of the gradient, once for edges along x and once for edges along y.

Canny, IEEE TPAMI 8(6), 1986. Splitting the maxima by direction makes every edge of a pass single-valued (one point
per column, or per row), so that chaining meets no branches.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

# edges up to 5 degrees beyond the diagonal belong to both passes, or noise would chop those near 45 degrees
_SECTOR = float(np.tan(np.radians(50.0)))


@dataclass(frozen=True, eq=False)
class Gradient:
    """Gradient of an image: 3x3 Sobel without normalisation.

    Attributes:
        x: float32 ``(H, W)``, derivative to the right; a step of h grey levels gives 4 h before blurring.
        y: float32 ``(H, W)``, derivative downwards.
        norm: float32 ``(H, W)``, Euclidean norm.
    """

    x: NDArray[np.float32]
    y: NDArray[np.float32]
    norm: NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class EdgePixels:
    """Maxima of one pass, in raster order.

    Attributes:
        axis: Coordinate the edges run along: 0 for x (horizontal pass), 1 for y (vertical pass).
        rows: int64 ``(n,)``.
        columns: int64 ``(n,)``.
    """

    axis: int
    rows: NDArray[np.int64]
    columns: NDArray[np.int64]


def gradient(image: NDArray[np.uint8] | NDArray[np.float32], sigma: float) -> Gradient:
    """Blur with a Gaussian of ``sigma`` px and differentiate; the border is mirrored."""
    smooth = cv2.GaussianBlur(image.astype(np.float32, copy=False), (0, 0), sigma)
    x = cv2.Sobel(smooth, cv2.CV_32F, 1, 0, ksize=3)
    y = cv2.Sobel(smooth, cv2.CV_32F, 0, 1, ksize=3)
    return Gradient(_array(x), _array(y), _array(cv2.magnitude(x, y)))


def edge_pixels(field: Gradient, threshold: float, axis: int) -> EdgePixels:
    """Find the maxima of the gradient norm across one axis.

    A pixel is an edge pixel when its norm is above ``threshold``, above that of its neighbour before and not below
    that of its neighbour after it (across the edge), and its gradient points across the axis within 50 degrees.
    Of a tie the first pixel is taken; the parabola of the sub-pixel step then gives the same position from either.
    Pixels on the image border are left out.

    Args:
        field: Gradient of the image.
        threshold: Norm to be exceeded.
        axis: 0 for edges along x, 1 for edges along y.
    """
    norm = field.norm
    if min(norm.shape) < 3:
        none = np.zeros(0, np.int64)
        return EdgePixels(axis, none, none)
    inner = norm[1:-1, 1:-1]
    before, after = (norm[:-2, 1:-1], norm[2:, 1:-1]) if axis == 0 else (norm[1:-1, :-2], norm[1:-1, 2:])
    across, along = (field.y, field.x) if axis == 0 else (field.x, field.y)
    found = (inner > threshold) & (inner > before) & (inner >= after)
    rows, columns = (index + 1 for index in np.nonzero(found))
    inside = np.abs(across[rows, columns]) * _SECTOR >= np.abs(along[rows, columns])
    return EdgePixels(axis, rows[inside], columns[inside])


def _array(value: object) -> NDArray[np.float32]:
    return np.asarray(value, dtype=np.float32)
