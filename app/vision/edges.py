"""Directional Canny with sub-pixel positions: maxima of the gradient, once for edges along x, once for those along y.

Canny, IEEE TPAMI 8(6), 1986. Splitting the maxima by direction makes every edge of a pass single-valued (one point per
column, or per row), so that chaining meets no branches; edges up to 5 degrees beyond the diagonal belong to both
passes. A parabola through three norms gives the sub-pixel position (Devernay, INRIA RR-2724, 1995; along the axis as in
Grompone von Gioi & Randall, IPOL 7, 2017). Edges are found in the equalised image but measured in the plain one:
equalisation moves and roughens them.
"""

from __future__ import annotations

import ctypes
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.vision.equalisation import Equalisation
from app.vision.native.library import kernels
from app.vision.native.records import LINES_BEYOND, MARGIN, POINT, Scene, address
from app.vision.watch import Watch

POSITION_SIGMA = 0.6
"""px, blur of the image that edges are measured in."""


@dataclass(frozen=True, eq=False)
class Places:
    """Where the points of one pass were found: lines are columns in the pass along x, and rows in that along y.

    Attributes:
        occupied: uint8 ``(lines + 3, bytes)``, one bit per pixel, the lowest first, after a margin of 16 pixels.
        before: int32 of the same shape, how many points come before those of each byte.
    """

    occupied: NDArray[np.uint8]
    before: NDArray[np.int32]


@dataclass(frozen=True, eq=False)
class EdgeMap:
    """Image, gradient and edge points of both passes; index 0 is the pass of edges along x, 1 that along y.

    Attributes:
        gray: uint8 ``(H, W)``.
        gradients: int16 ``(2, H, W)``, derivatives of the equalised image to the right and downwards (3x3 Sobel without
            normalisation after the blur), in steps of 1 / 16 grey level.
        points: Two arrays of `POINT`, in the order of ``along``, those with the same in that of ``across``: ``along``,
            the pixel coordinate along the axis of the pass; ``across``, the sub-pixel one across it; ``slope``,
            d across / d along of the edge; ``norm`` of the equalised gradient, negative where the image gets darker
            with rising ``across``.
        places: Of both passes, the pixels that these were found at.
    """

    gray: NDArray[np.uint8]
    gradients: NDArray[np.int16]
    points: tuple[NDArray[Any], NDArray[Any]]
    places: tuple[Places, Places]

    @cached_property
    def scene(self) -> Scene:
        """The view that kernels take; this object must outlive it."""
        height, width = self.gray.shape
        pointers = ctypes.c_void_p * 2
        return Scene(
            width,
            height,
            address(self.gray),
            *(address(gradient) for gradient in self.gradients),
            pointers(*(address(each) for each in self.points)),
            pointers(*(address(each.occupied) for each in self.places)),
            pointers(*(address(each.before) for each in self.places)),
        )


def no_places(lines: int, pixels: int) -> Places:
    """Return room for the places of a pass with so many lines of so many pixels, none of which is occupied."""
    shape = (lines + LINES_BEYOND, (pixels + 2 * MARGIN + 15) // 8)
    return Places(np.zeros(shape, np.uint8), np.zeros(shape, np.int32))


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
    gradients = np.empty((2, height, width), np.int16)
    places = no_places(width, height), no_places(height, width)
    # of two neighbours across a pass one at most is a maximum; pages that stay untouched cost nothing
    room = max((height + 1) // 2 * width, (width + 1) // 2 * height)
    points, counts = np.empty((2, room), POINT), np.zeros(2, np.int64)
    rows, columns, _ = tables.tables.shape
    watch.call(
        kernels().cl_edge_points,
        *(address(gray), width, height),
        *(address(tables.tables), columns, rows, address(tables.left), address(tables.rightward)),
        *(sigma, POSITION_SIGMA, weakest),
        *(address(gradients[0]), address(gradients[1])),
        *(address(points[0]), address(points[1]), room),
        *(address(each.occupied) for each in places),
        *(address(each.before) for each in places),
        address(counts),
    )
    along_x, along_y = (each[:count] for each, count in zip(points, counts.tolist(), strict=True))
    return EdgeMap(gray, gradients, (along_x, along_y), places)
