"""Whether an image's file is whole, before it is stored: a browser would show half of it, and say nothing."""

from __future__ import annotations

import struct

from app.errors import InvalidImage
from app.images.header import ImageHeader
from app.images.png import check_png

END_OF_JPEG = b"\xff\xd9"
START_OF_SCAN = b"\xff\xda"


def check_whole(data: bytes, header: ImageHeader) -> None:
    """Refuse a file that is cut off or broken, as far as that is told without decoding its pixels.

    A PNG is looked at to its last row; of the other kinds that browsers get as they are, whether the end is there.
    TIFF and PNM are decoded whenever they are shown, which tells as much.

    Args:
        data: The file.
        header: As `describe` has read it.

    Raises:
        InvalidImage: If something is missing.
    """
    match header.format:
        case "PNG":
            check_png(data)
        case "JPEG":
            # a thumbnail in its EXIF block has an end of its own, which comes before the pixels
            _check_end(data.rfind(END_OF_JPEG) > data.find(START_OF_SCAN), "JPEG")
        case "WEBP":
            _check_end(len(data) >= 8 + struct.unpack_from("<I", data, 4)[0], "WebP")
        case "BMP":
            _check_end(len(data) >= _bmp_size(data), "BMP")
        case _:
            pass


def _check_end(there: bool, kind: str) -> None:
    if not there:
        raise InvalidImage(f"the {kind} is cut off", hint="is the file whole?")


def _bmp_size(data: bytes) -> int:
    """Return the bytes a BMP needs at least; of packed ones, those before its pixels (BITMAPINFOHEADER)."""
    if len(data) < 34:
        return 34
    offset, _, width, height, _, depth, packing = struct.unpack_from("<IIiiHHI", data, 10)
    stride = (width * depth + 31) // 32 * 4
    return offset if packing in (1, 2) else offset + stride * abs(height)
