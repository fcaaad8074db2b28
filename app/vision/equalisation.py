"""Contrast-limited adaptive histogram equalisation (CLAHE; Zuiderveld, Graphics Gems IV, 1994).

Equalised rows are made where they are used, in `app.vision.edges`; here are the tables that they are made with.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.vision.native.library import kernels
from app.vision.native.records import address

LEVELS = 256


@dataclass(frozen=True, eq=False)
class Equalisation:
    """How the grey levels of an image are equalised.

    A pixel's level is looked up in the tables of the four tiles whose centres surround it, and interpolated.

    Attributes:
        tables: float32 ``(rows, columns, 256)``, equalised level of each level, in [0, 255], per tile.
        left: int32 ``(W,)``, column of the tiles whose centre lies left of each pixel column.
        rightward: float32 ``(W,)``, weight of the tiles to the right of these.
    """

    tables: NDArray[np.float32]
    left: NDArray[np.int32]
    rightward: NDArray[np.float32]


def equalisation(gray: NDArray[np.uint8], clip: float, tile: float) -> Equalisation:
    """Measure an image's tiles.

    Tiles have a size in px rather than a fixed number, so that a detail is treated alike in images of any size. They
    are symmetric: an image, its mirror image and its transpose are equalised alike.

    Args:
        gray: uint8 ``(H, W)``, contiguous.
        clip: Clip limit in multiples of a flat histogram.
        tile: Side of a tile in px; rounded so that whole tiles fill the image.
    """
    height, width = gray.shape
    columns, rows = (max(1, round(size / tile)) for size in (width, height))
    tables = np.empty((rows, columns, LEVELS), np.float32)
    left, rightward = np.empty(width, np.int32), np.empty(width, np.float32)
    library = kernels()
    library.cl_equalising_tables(address(gray), width, height, columns, rows, clip, address(tables))
    library.cl_tile_weights(width, columns, address(left), address(rightward))
    return Equalisation(tables, left, rightward)
