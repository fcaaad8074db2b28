"""Sub-pixel position of edge points.

The maximum of the parabola through three gradient norms across the edge: Devernay 1995 as corrected by Grompone von
Gioi & Randall, "A Sub-Pixel Edge Detector: an Implementation of the Canny/Devernay Algorithm", IPOL 2017.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.vision.edges import EdgePixels, Gradient


@dataclass(frozen=True, eq=False)
class EdgePoints:
    """Sub-pixel edge points of one pass and the way to find them by pixel.

    Attributes:
        axis: Coordinate the edges run along: 0 for x, 1 for y.
        along: int64 ``(n,)``, pixel coordinate along the axis.
        across: float64 ``(n,)``, sub-pixel coordinate across it.
        slope: float64 ``(n,)``, d across / d along of the edge, from the gradient's direction.
        sign: int8 ``(n,)``, +1 where the image gets brighter with rising ``across``, else -1.
        norm: float32 ``(n,)``, gradient norm of the equalised image.
        index: int32 ``(H, W)``, row of the point found at a pixel, -1 where there is none.
    """

    axis: int
    along: NDArray[np.int64]
    across: NDArray[np.float64]
    slope: NDArray[np.float64]
    sign: NDArray[np.int8]
    norm: NDArray[np.float32]
    index: NDArray[np.int32]

    def __len__(self) -> int:
        return len(self.along)

    def points(self, rows: NDArray[Any] | slice = slice(None)) -> NDArray[np.float64]:
        """Return x, y of the points chosen, float64 ``(n, 2)`` px."""
        pair = (self.along[rows].astype(np.float64), self.across[rows])
        return np.stack(pair if self.axis == 0 else pair[::-1], axis=1)

    def find(self, along: NDArray[np.int64], across: NDArray[np.int64]) -> NDArray[np.int32]:
        """Return the rows of the points at pixels, -1 where there is none or outside the image."""
        rows, columns = (across, along) if self.axis == 0 else (along, across)
        height, width = self.index.shape
        inside = (rows >= 0) & (rows < height) & (columns >= 0) & (columns < width)
        flat = np.where(inside, rows * width + columns, 0)
        return np.where(inside, self.index.ravel()[flat], -1)


def parabola_offset(
    before: NDArray[np.float64], centre: NDArray[np.float64], after: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Offset of the maximum of the parabola through values at -1, 0, +1: ``(a - c) / (2 (a - 2 b + c))``.

    In [-1/2, 1/2] where the centre is not below its neighbours; 0 where the three are equal.
    """
    bend = before - 2.0 * centre + after
    return np.where(bend < 0, 0.5 * (before - after) / np.where(bend < 0, bend, 1.0), 0.0)


def refine(pixels: EdgePixels, equalised: Gradient, plain: Gradient) -> EdgePoints:
    """Measure the position of edge pixels on the image before equalisation.

    Equalising raises the noise of a position by more than half and shifts maxima where tiles meet, so the maximum is
    looked for in the plain image, at most one pixel away and on the same side of the step; the equalised gradient
    gives the position only where the plain one has no maximum there.

    Args:
        pixels: Maxima of the equalised gradient.
        equalised: The gradient they were found in.
        plain: Gradient of the image as it is.
    """
    rows, columns = pixels.rows, pixels.columns
    width = equalised.norm.shape[1]
    step = width if pixels.axis == 0 else 1
    flat = rows * width + columns
    along, pixel_across = (columns, rows) if pixels.axis == 0 else (rows, columns)
    limit = equalised.norm.shape[pixels.axis] - 1
    component = (equalised.y, plain.y) if pixels.axis == 0 else (equalised.x, plain.x)
    sign = np.where(component[0].ravel()[flat] > 0, 1, -1).astype(np.int8)

    norm = equalised.norm.ravel()
    offset = parabola_offset(*(norm[flat + k * step].astype(np.float64) for k in (-1, 0, 1)))
    shift = np.zeros(len(flat), np.int64)
    plain_norm = plain.norm.ravel()
    around = {k: plain_norm[flat + np.clip(k, -pixel_across, limit - pixel_across) * step] for k in range(-2, 3)}
    strongest = np.zeros(len(flat), np.float32)
    settled = np.zeros(len(flat), bool)
    for k in (0, -1, 1):
        same_side = component[1].ravel()[flat + k * step] * sign > 0
        peak = (around[k] >= around[k - 1]) & (around[k] >= around[k + 1]) & same_side & (around[k] > strongest)
        peak &= ~settled  # the own pixel's maximum is never left for a neighbour's
        values = (around[k + j][peak].astype(np.float64) for j in (-1, 0, 1))
        offset[peak] = k + parabola_offset(*values)
        shift[peak] = k
        strongest[peak] = around[k][peak]
        if k == 0:
            settled = peak

    single = _single(flat, shift, step, offset, norm, equalised.norm.shape)
    flat, shift, sign = flat[single], shift[single], sign[single]
    nearest = flat + shift * step
    gx, gy = (part.ravel()[nearest].astype(np.float64) for part in (equalised.x, equalised.y))
    forward, sideways = (gy, gx) if pixels.axis == 0 else (gx, gy)
    steep = np.abs(sideways) <= 2.0 * np.abs(forward)
    slope = np.where(steep, -sideways / np.where(steep & (forward != 0), forward, 1.0), 0.0)
    across = (pixel_across + offset)[single]
    index = _index(flat, equalised.norm.shape)
    return EdgePoints(pixels.axis, along[single], across, slope, sign, norm[flat], index)


def _single(
    flat: NDArray[np.int64],
    shift: NDArray[np.int64],
    step: int,
    offset: NDArray[np.float64],
    norm: NDArray[np.float32],
    shape: tuple[int, int],
) -> NDArray[np.bool_]:
    """Mask without the weaker of two pixels that were led to one plain maximum between them."""
    moved = np.flatnonzero(shift)
    beyond = flat[moved] + 2 * shift[moved] * step
    inside = (beyond >= 0) & (beyond < shape[0] * shape[1])
    moved, beyond = moved[inside], beyond[inside]
    other = _index(flat, shape).ravel()[beyond]
    # an edge pixel has no edge pixel beside it, so only the next but one can have come to the same place
    met = (other >= 0) & (np.abs(offset[moved] - offset[other] - 2 * shift[moved]) < 0.25)
    moved, other = moved[met], other[met]
    single = np.ones(len(flat), bool)
    weaker = norm[flat[moved]] < norm[flat[other]]
    tied = norm[flat[moved]] == norm[flat[other]]
    single[moved[weaker | (tied & (moved > other))]] = False
    single[other[~weaker & (~tied | (moved < other))]] = False
    return single


def _index(flat: NDArray[np.int64], shape: tuple[int, int]) -> NDArray[np.int32]:
    index = np.full(shape, -1, np.int32)
    index.ravel()[flat] = np.arange(len(flat), dtype=np.int32)
    return index
