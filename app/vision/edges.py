"""Directional Canny with sub-pixel positions: maxima of the gradient, once for edges along x, once for those along y.

Canny, IEEE TPAMI 8(6), 1986. Splitting the maxima by direction makes every edge of a pass single-valued (one point per
column, or per row), so that chaining meets no branches; edges up to 5 degrees beyond the diagonal belong to both
passes. A parabola through three norms gives the sub-pixel position (Devernay, INRIA RR-2724, 1995; along the axis as in
Grompone von Gioi & Randall, IPOL 7, 2017). Edges are found in the equalised image but measured in the plain one:
equalisation moves and roughens them.
"""

from __future__ import annotations

import ctypes
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.vision.equalisation import Equalisation
from app.vision.native.library import kernels
from app.vision.native.records import LINES_BEYOND, MARGIN, POINT, SPAN, SPAN_PIXELS, Scene, address
from app.vision.watch import Watch

POSITION_SIGMA = 0.6
"""px, blur of the image that edges are measured in."""


@dataclass(frozen=True, eq=False)
class EdgeMap:
    """Image, gradient and edge points of both passes; index 0 is the pass of edges along x, 1 that along y.

    Attributes:
        gray: uint8 ``(H, W)``.
        gradients: int16 ``(2, H, W)``, derivatives of the equalised image to the right and downwards (3x3 Sobel without
            normalisation after the blur), in steps of 1 / 16 grey level. Both of a pixel are side by side in memory:
            it is a view of ``(H, W, 2)``.
        points: Two arrays of `POINT`, in the order of ``along``, those with the same in that of ``across``: ``along``,
            the pixel coordinate along the axis of the pass; ``across``, the sub-pixel one across it; ``slope``,
            d across / d along of the edge; ``norm`` of the equalised gradient, negative where the image gets darker
            with rising ``across``.
        spans: Of both passes, where these were found: `SPAN` ``(lines + 3, spans)``. A line is a column in the pass
            along x, a row in that along y; after a margin of 16 pixels, ``occupied`` has one bit per pixel, the lowest
            first; ``before`` tells how many points come before those of the span.
    """

    gray: NDArray[np.uint8]
    gradients: NDArray[np.int16]
    points: tuple[NDArray[Any], NDArray[Any]]
    spans: tuple[NDArray[Any], NDArray[Any]]

    @cached_property
    def scene(self) -> Scene:
        """The view that kernels take; this object must outlive it."""
        height, width = self.gray.shape
        pointers = ctypes.c_void_p * 2
        return Scene(
            width,
            height,
            address(self.gray),
            address(np.moveaxis(self.gradients, 0, 2)),
            pointers(*(address(each) for each in self.points)),
            pointers(*(address(each) for each in self.spans)),
        )


def no_spans(lines: int, pixels: int) -> NDArray[Any]:
    """Return the `SPAN` of a pass with so many lines of so many pixels, none of which is occupied."""
    # an odd number: lines a power of two apart would share few places of the processor's cache
    return np.zeros((lines + LINES_BEYOND, (pixels + 2 * MARGIN) // SPAN_PIXELS + 1 | 1), SPAN)


def edge_map(gray: NDArray[np.uint8], tables: Equalisation, sigma: float, weakest: float, watch: Watch) -> EdgeMap:
    """Find the edge points of both passes, in strips so that no float image of full size is held.

    Args:
        gray: uint8 ``(H, W)``, contiguous, both 3 or more.
        tables: Of the same image.
        sigma: Blur of the equalised image in px.
        weakest: Gradient norm that an edge point exceeds.
        watch: Over this part of the detection.

    Raises:
        Cancelled: If that is wished.
    """
    height, width = gray.shape
    # more than photos or noise have; memory for all that there can be would be too much to be kept for the next image
    found = _find(gray, tables, sigma, weakest, gray.size // 4 + width, watch)
    if found is not None:
        return found
    # of two neighbours across a pass one at most is a maximum
    most = max((height + 1) // 2 * width, (width + 1) // 2 * height) + width
    found = _find(gray, tables, sigma, weakest, most, replace(watch, progress=None))
    if found is None:
        raise RuntimeError("more edge points than there can be")
    return found


def _find(
    gray: NDArray[np.uint8], tables: Equalisation, sigma: float, weakest: float, room: int, watch: Watch
) -> EdgeMap | None:
    """Return the edge points, or none where there are more of a pass than there is room for."""
    height, width = gray.shape
    gradient = np.empty((height, width, 2), np.int16)
    spans = no_spans(width, height), no_spans(height, width)
    points, counts = (np.empty(room, POINT), np.empty(room, POINT)), np.zeros(2, np.int64)
    rows, columns, _ = tables.tables.shape
    enough = watch.call(
        kernels().cl_edge_points,
        *(address(gray), width, height),
        *(address(tables.tables), columns, rows, address(tables.left), address(tables.rightward)),
        *(sigma, POSITION_SIGMA, weakest),
        address(gradient),
        *(*(address(each) for each in points), room),
        *(address(each) for each in spans),
        address(counts),
    )
    along_x, along_y = (each[:count] for each, count in zip(points, counts.tolist(), strict=True))
    return EdgeMap(gray, np.moveaxis(gradient, 2, 0), (along_x, along_y), spans) if enough else None
