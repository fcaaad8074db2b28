"""Contrast-limited adaptive histogram equalisation (CLAHE; Zuiderveld, Graphics Gems IV, 1994)."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray


def equalise(gray: NDArray[np.uint8], clip: float, tile: float) -> NDArray[np.float32]:
    """Equalise the local contrast of an image.

    Tiles have a size in px rather than a fixed number, so that a detail is treated alike in images of any size.
    OpenCV's interpolation between tiles is half a pixel off centre and pads at the right and bottom only; the mean
    over the four mirror images takes both away, so that an image and its mirror are equalised alike.

    Args:
        gray: uint8 ``(H, W)``.
        clip: Clip limit in multiples of a flat histogram.
        tile: Side of a tile in px; rounded so that whole tiles fill the image.

    Returns:
        float32 ``(H, W)``, grey levels in [0, 255].
    """
    height, width = gray.shape
    grid = (max(1, round(width / tile)), max(1, round(height / tile)))
    equaliser = cv2.createCLAHE(clipLimit=clip, tileGridSize=grid)
    mean = equaliser.apply(gray).astype(np.float32)
    for flip in (0, 1, -1):
        mean += cv2.flip(equaliser.apply(cv2.flip(gray, flip)), flip)
    mean *= 0.25
    return mean
