"""Pixels as stored, from bytes whose header has been checked."""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from app.errors import InvalidImage
from app.images.header import MAX_PIXELS, ImageHeader, describe
from app.images.png import check_chunks
from app.images.tiff import as_stored
from app.vision.intensity import to_eight_bit

# a broken upload is told of by our error, to whom it concerns; OpenCV would write to the server's terminal
cv2.utils.logging.setLogLevel(cv2.utils.logging.LOG_LEVEL_SILENT)


def decode_gray(data: bytes, *, max_pixels: int = MAX_PIXELS) -> NDArray[np.uint8] | NDArray[np.uint16]:
    """Decode an image to grey.

    Args:
        data: The file.
        max_pixels: Greatest width times height to accept.

    Returns:
        uint8 or uint16 ``(H, W)`` as the file has it. Colour becomes luma (Rec. 601), alpha is ignored.

    Raises:
        InvalidImage: If it can't be read, is cut off, or isn't as large as its header says.
        TooLarge: If it has more pixels than accepted.
    """
    pixels = _decode(data, max_pixels)
    return pixels if pixels.ndim == 2 else _converted(pixels, cv2.COLOR_BGR2GRAY)


def decode_display(data: bytes, *, max_pixels: int = MAX_PIXELS) -> NDArray[np.uint8]:
    """Decode an image for drawing on it: uint8 ``(H, W, 3)``, channels in OpenCV's order blue, green, red.

    16 bit are brought to 8 by the 0.5 and 99.5 percentiles. Errors as `decode_gray`.
    """
    pixels = to_eight_bit(_decode(data, max_pixels))
    return _converted(pixels, cv2.COLOR_GRAY2BGR) if pixels.ndim == 2 else pixels


def decode_eight_bit(data: bytes, *, max_pixels: int = MAX_PIXELS) -> NDArray[np.uint8]:
    """As `decode_display`, but grey stays ``(H, W)``."""
    return to_eight_bit(_decode(data, max_pixels))


def _decode(data: bytes, max_pixels: int) -> NDArray[Any]:
    """Return uint8 or uint16 pixels as stored, ``(H, W)`` or blue, green, red ``(H, W, 3)``."""
    header = describe(data, max_pixels=max_pixels)
    if header.format == "PNG":
        check_chunks(data)
    elif header.format == "TIFF":
        data = as_stored(data)
    try:
        # "unchanged" keeps 16 bit and alpha, and leaves EXIF orientation alone
        pixels = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_UNCHANGED)
    except cv2.error as error:
        raise InvalidImage("the image can't be decoded", hint="is the file whole?") from error
    if pixels is None or pixels.size == 0:
        raise InvalidImage("the image is broken or cut off", hint="is the file whole?")
    return _as_promised(pixels, header)


def _converted(pixels: NDArray[Any], code: int) -> NDArray[Any]:
    return np.asarray(cv2.cvtColor(pixels, code), dtype=pixels.dtype)


def _as_promised(pixels: NDArray[Any], header: ImageHeader) -> NDArray[Any]:
    if pixels.shape[:2] != (header.height, header.width):
        raise InvalidImage(
            f"the image has {pixels.shape[1]} x {pixels.shape[0]} pixels",
            expected=f"{header.width} x {header.height} as its header says",
        )
    if pixels.dtype not in (np.uint8, np.uint16):
        raise InvalidImage(f"pixels of type {pixels.dtype}", expected="8 or 16 bit")
    if pixels.ndim == 3 and pixels.shape[2] in (1, 2):
        return np.ascontiguousarray(pixels[:, :, 0])
    return np.ascontiguousarray(pixels[:, :, :3]) if pixels.ndim == 3 else pixels
