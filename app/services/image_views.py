"""Other views of an image than its pixels as stored: equalised, and with the lens's distortion taken out."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from typing import Literal, get_args

import cv2
import numpy as np
from numpy.typing import NDArray
from sqlalchemy.orm import Session

from app.db.models import Image
from app.errors import Conflict
from app.images import decode_eight_bit
from app.images.browser import encode
from app.services.image_lens import lens_of_image
from app.vision.undistorted_view import UndistortedView, undistorted_view

View = Literal["plain", "clahe", "undistorted"]
VIEWS: tuple[View, ...] = get_args(View)

CLIP, TILE = 4.0, 64
"""Contrast limit, and side of a tile in px, of the equalised view: as strong as helps the eye in shadows."""
QUALITY = 92
"""Of the JPEG: it is looked at, never measured on."""


@dataclass(frozen=True)
class ViewedImage:
    """What a view is made of, read from the database at once.

    Attributes:
        tag: Changes whenever the view does.
        undistorted: The view without distortion; ``None`` for the others.
    """

    sha256: str
    tag: str
    view: View
    undistorted: UndistortedView | None


def viewed_image(session: Session, image: Image, view: View) -> ViewedImage:
    """Return what a view of an image is made of.

    Raises:
        Conflict: When the view without distortion is asked for and the lens isn't known.
    """
    if view != "undistorted":
        return ViewedImage(image.sha256, f"{image.sha256}-{view}", view, None)
    lens = lens_of_image(session, image)
    if lens is None or not lens.accepted:
        raise Conflict(
            "the lens of this image isn't known yet",
            where=image.name,
            expected="an accepted estimate of its camera's lens",
            hint="pre-label the images of this camera, or keep more straight lines and run again",
        )
    of_lens = hashlib.sha256(json.dumps(lens.as_dict(), sort_keys=True).encode()).hexdigest()[:16]
    return ViewedImage(image.sha256, f"{image.sha256}-{view}-{of_lens}", view, undistorted_view(lens.brown))


def render_view(viewed: ViewedImage, content: bytes, *, max_pixels: int) -> tuple[bytes, str]:
    """Return the view as a file that browsers show, and its media type.

    Args:
        viewed: The view.
        content: The image's file.
        max_pixels: Greatest number of pixels to decode.

    Raises:
        InvalidImage: If it can't be read.
        TooLarge: If it has more pixels than accepted.
    """
    pixels = decode_eight_bit(content, max_pixels=max_pixels)
    seen = equalised(pixels) if viewed.undistorted is None else viewed.undistorted.render(pixels)
    return encode(".jpg", seen, [cv2.IMWRITE_JPEG_QUALITY, QUALITY]), "image/jpeg"


def equalised(pixels: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Return an image whose brightness is equalised tile by tile (CLAHE), its colours kept.

    Args:
        pixels: uint8 ``(H, W)``, or ``(H, W, 3)`` in the order blue, green, red.
    """
    height, width = pixels.shape[:2]
    clahe = cv2.createCLAHE(CLIP, (max(1, round(width / TILE)), max(1, round(height / TILE))))
    if pixels.ndim == 2:
        return np.asarray(clahe.apply(pixels), np.uint8)
    lab = cv2.cvtColor(pixels, cv2.COLOR_BGR2LAB)
    lab[:, :, 0] = clahe.apply(np.ascontiguousarray(lab[:, :, 0]))
    return np.asarray(cv2.cvtColor(lab, cv2.COLOR_LAB2BGR), np.uint8)
