"""Large images with the content of a photo."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray


def mirrored(photo: NDArray[np.uint8], width: int, height: int) -> NDArray[np.uint8]:
    """Tile a photo, every other tile mirrored so that none has a seam, and cut the whole to size.

    Enlarging a photo would blur its edges; so the edges of a mosaic are as sharp and as dense as those of the photo.

    Args:
        photo: uint8 ``(H, W)``.
        width: Of the mosaic, at least that of the photo, px.
        height: Likewise.
    """
    rows, columns = photo.shape
    if height < rows or width < columns:
        raise ValueError(f"a mosaic of {width} x {height} doesn't hold a photo of {columns} x {rows}")
    return np.asarray(
        cv2.copyMakeBorder(photo, 0, height - rows, 0, width - columns, cv2.BORDER_REFLECT), dtype=np.uint8
    )
