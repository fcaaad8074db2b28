"""Images as a browser is shown them."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from app.errors import InvalidImage, InvalidInput
from app.images.decode import decode_eight_bit
from app.images.header import MAX_PIXELS, describe

SHOWN_AS_STORED = frozenset({"PNG", "JPEG", "WEBP", "BMP"})
THUMBNAIL_TYPE = "image/webp"
THUMBNAIL_QUALITY = 80


def shown_as_stored(data: bytes, *, max_pixels: int = MAX_PIXELS) -> str | None:
    """Return the media type of a file that a browser shows as it is; ``None`` where its pixels must be decoded.

    Such a file is 8-bit PNG, JPEG, WebP or BMP that no EXIF orientation turns and no alpha veils.

    Raises:
        InvalidImage: If it can't be read.
        TooLarge: If it has more pixels than accepted.
    """
    header = describe(data, max_pixels=max_pixels)
    opaque = header.channels in (1, 3)
    as_stored = header.format in SHOWN_AS_STORED and header.bits == 8 and header.orientation == 1 and opaque
    return header.media_type if as_stored else None


def for_browser(data: bytes, *, max_pixels: int = MAX_PIXELS) -> tuple[bytes, str]:
    """Return bytes that a browser shows pixel by pixel as the image is stored, and their media type.

    The file itself where a browser shows it as it is; else an 8-bit PNG of its pixels.

    Raises:
        InvalidImage: If it can't be read.
        TooLarge: If it has more pixels than accepted.
    """
    media_type = shown_as_stored(data, max_pixels=max_pixels)
    if media_type is not None:
        return data, media_type
    # filtering and a quick deflate: a page waits for this
    fast = [cv2.IMWRITE_PNG_COMPRESSION, 2]
    return encode(".png", decode_eight_bit(data, max_pixels=max_pixels), fast), "image/png"


def thumbnail(data: bytes, size: int = 320, *, max_pixels: int = MAX_PIXELS) -> tuple[bytes, str]:
    """Return a WebP whose longer side has at most ``size`` px, and its media type. A small image isn't enlarged.

    Raises:
        InvalidImage: If it can't be read.
        InvalidInput: On a size outside 16 to 2048.
        TooLarge: If it has more pixels than accepted.
    """
    if not 16 <= size <= 2048:
        raise InvalidInput(f"a thumbnail of {size} px", where="size", expected="16 to 2048")
    pixels = decode_eight_bit(data, max_pixels=max_pixels)
    height, width = pixels.shape[:2]
    scale = size / max(width, height)
    if scale < 1:
        target = (max(1, round(width * scale)), max(1, round(height * scale)))
        pixels = cv2.resize(pixels, target, interpolation=cv2.INTER_AREA).astype(np.uint8, copy=False)
    return encode(".webp", pixels, [cv2.IMWRITE_WEBP_QUALITY, THUMBNAIL_QUALITY]), THUMBNAIL_TYPE


def encode(extension: str, pixels: NDArray[np.uint8], options: list[int]) -> bytes:
    """Return pixels as the bytes of a file.

    Args:
        extension: Says the format, ".png".
        pixels: uint8 ``(H, W)``, or ``(H, W, 3)`` in the order blue, green, red.
        options: OpenCV's, in pairs.

    Raises:
        InvalidImage: If the format doesn't take them.
    """
    done, encoded = cv2.imencode(extension, pixels, options)
    if not done:
        raise InvalidImage("the image can't be encoded for the browser")
    return encoded.tobytes()
