"""What an image file says of itself, read before any memory is taken for its pixels."""

from __future__ import annotations

import io
import struct
from dataclasses import dataclass

from PIL import Image, TiffImagePlugin, UnidentifiedImageError

from app.errors import InvalidImage, TooLarge

MAX_PIXELS = 40_000_000
"""Largest image read unless told otherwise, in 10^6 px."""

MEDIA_TYPES = {
    "PNG": "image/png",
    "JPEG": "image/jpeg",
    "TIFF": "image/tiff",
    "BMP": "image/bmp",
    "WEBP": "image/webp",
    "PPM": "image/x-portable-anymap",
}
EXPECTED = "PNG, JPEG, TIFF, BMP, WebP, PGM or PPM of 8 or 16 bit"
ORIENTATION = 0x0112
BITS_PER_SAMPLE = 258
SAMPLE_FORMAT = 339
UNSIGNED = 1
PNG_SIGNATURE = b"\x89PNG\r\n\x1a\n"
PNG_METADATA = frozenset({b"eXIf", b"tEXt", b"zTXt", b"iTXt"})
"""Chunks that an orientation can stand in."""


@dataclass(frozen=True)
class ImageHeader:
    """An image file's header.

    Attributes:
        format: PNG, JPEG, TIFF, BMP, WEBP or PPM (which PGM and PBM are too).
        width: Of the pixels as stored, px.
        height: Of the pixels as stored, px.
        bits: Per channel as decoded, 8 or 16.
        channels: 1 to 4, alpha included.
        media_type: For HTTP, ``image/png``.
        orientation: 1 to 8 as in EXIF; how a viewer would turn it. Nothing here does.
    """

    format: str
    width: int
    height: int
    bits: int
    channels: int
    media_type: str
    orientation: int = 1


def describe(data: bytes, *, max_pixels: int = MAX_PIXELS) -> ImageHeader:
    """Read an image's header.

    Animations and files of several pages are refused, since labels of one would be labels of which picture? A JPEG
    that carries further pictures behind its first, as phones write them, counts as the first.

    Args:
        data: The file.
        max_pixels: Greatest width times height to accept.

    Raises:
        InvalidImage: If it is no image, a format or pixel type that isn't read, or several pictures.
        TooLarge: If it has more pixels than accepted.
    """
    _check_size(_webp_size(data), max_pixels)
    try:
        with Image.open(io.BytesIO(data), formats=list(MEDIA_TYPES)) as image:
            return _header(image, data, max_pixels)
    except (Image.DecompressionBombError, Image.DecompressionBombWarning) as error:
        raise TooLarge("the image has too many pixels", expected=f"at most {max_pixels:,} pixels") from error
    except (InvalidImage, TooLarge):
        raise
    except UnidentifiedImageError as error:
        raise InvalidImage("this is no image of a kind that is read", expected=EXPECTED) from error
    # Pillow's readers of broken headers complain in many types
    except Exception as error:
        raise InvalidImage("the image's header is broken", expected=EXPECTED) from error


def _header(image: Image.Image, data: bytes, max_pixels: int) -> ImageHeader:
    kind = "JPEG" if image.format == "MPO" else str(image.format)
    width, height = _stored_size(image)
    _check_size((width, height), max_pixels)
    if kind != "JPEG" and getattr(image, "is_animated", False):
        raise InvalidImage(
            "the file holds several pictures", expected="one", hint="save the one you mean as a file of its own"
        )
    orientation = _orientation(image, data)
    return ImageHeader(kind, width, height, _bits(image, data), _channels(image), MEDIA_TYPES[kind], orientation)


def _check_size(size: tuple[int, int] | None, max_pixels: int) -> None:
    if size is None:
        return
    width, height = size
    if width < 1 or height < 1:
        raise InvalidImage("the image has no pixels", expected="at least 1 x 1")
    if width * height > max_pixels:
        raise TooLarge(
            f"the image has {width} x {height} pixels",
            expected=f"at most {max_pixels:,} pixels",
            details={"width": width, "height": height},
        )


def _webp_size(data: bytes) -> tuple[int, int] | None:
    """Return the canvas size of a WebP: Pillow takes memory for the canvas before it tells the size.

    Container and bit layout: RFC 9649, sections 2.3 to 2.7.
    """
    if len(data) < 30 or data[:4] != b"RIFF" or data[8:12] != b"WEBP":
        return None
    match data[12:16]:
        case b"VP8X":
            low_w, high_w, low_h, high_h = struct.unpack_from("<HBHB", data, 24)
            return (low_w | high_w << 16) + 1, (low_h | high_h << 16) + 1
        case b"VP8L":
            (packed,) = struct.unpack_from("<I", data, 21)
            return (packed & 0x3FFF) + 1, (packed >> 14 & 0x3FFF) + 1
        case b"VP8 ":
            width, height = struct.unpack_from("<HH", data, 26)
            return width & 0x3FFF, height & 0x3FFF
    return None


def _orientation(image: Image.Image, data: bytes) -> int:
    try:
        value = _exif(image, data).get(ORIENTATION, 1)
    # a broken EXIF block is no reason to refuse the pixels
    except Exception:
        return 1
    return value if isinstance(value, int) and 1 <= value <= 8 else 1


def _exif(image: Image.Image, data: bytes) -> Image.Exif:
    """Return the EXIF block; of a PNG without decoding its pixels, which Pillow does in search of a late one."""
    if image.format == "PNG" and not _tells_late(data):
        return Image.Image.getexif(image)
    return image.getexif()


def _tells_late(data: bytes) -> bool:
    """Whether a PNG has metadata behind its pixels (ISO/IEC 15948, 5.3: length, type, content, CRC of each chunk)."""
    at, pixels_seen = len(PNG_SIGNATURE), False
    while at + 8 <= len(data):
        length, kind = struct.unpack_from(">I4s", data, at)
        if pixels_seen and kind in PNG_METADATA:
            return True
        pixels_seen |= kind == b"IDAT"
        at += length + 12
    return False


def _stored_size(image: Image.Image) -> tuple[int, int]:
    """Return width and height as stored: Pillow swaps those of a TIFF that a viewer would turn by 90 degrees."""
    if isinstance(image, TiffImagePlugin.TiffImageFile):
        return int(image.tag_v2[TiffImagePlugin.IMAGEWIDTH]), int(image.tag_v2[TiffImagePlugin.IMAGELENGTH])
    return image.size


def _channels(image: Image.Image) -> int:
    colours = {"P": 3, "PA": 3, "CMYK": 3, "YCbCr": 3}.get(image.mode, len(image.getbands()))
    veiled = image.mode == "PA" or "transparency" in image.info  # the latter: one colour, or palette entries
    return colours + veiled


def _bits(image: Image.Image, data: bytes) -> int:
    if isinstance(image, TiffImagePlugin.TiffImageFile):
        bits, formats = (image.tag_v2.get(tag, (UNSIGNED,)) for tag in (BITS_PER_SAMPLE, SAMPLE_FORMAT))
        if not set(bits) <= {1, 2, 4, 8, 16} or not set(formats) <= {UNSIGNED}:
            raise InvalidImage(
                f"pixels of {max(bits)} bit or of another kind than unsigned integers", expected=EXPECTED
            )
        return 16 if max(bits) == 16 else 8
    if image.format == "PNG":
        return 16 if data[24] == 16 else 8  # IHDR comes first; its bit depth follows width and height
    if image.format == "PPM":
        if image.mode == "F":
            raise InvalidImage("pixels are floating point", expected=EXPECTED)
        return 16 if _ppm_maximum(data) > 255 else 8
    return 8


def _ppm_maximum(data: bytes) -> int:
    """Return the largest value a PGM or PPM may hold; 1 for a bitmap."""
    if data[1:2] in b"14":
        return 1
    lines = (line.split(b"#", 1)[0] for line in data[2:4096].split(b"\n"))
    numbers = b" ".join(lines).split()
    return int(numbers[2])
