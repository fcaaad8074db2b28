import io
import struct
import zlib

import cv2
import numpy as np
import pytest
from PIL import Image

from app.errors import ClearLinesError, InvalidImage, TooLarge
from app.images import describe

RNG = np.random.default_rng(5)
COLOUR = RNG.integers(0, 256, (6, 9, 3), dtype=np.uint8)
GREY = COLOUR[..., 0]
DEEP = RNG.integers(0, 65536, (6, 9), dtype=np.uint16)
DEEP_COLOUR = RNG.integers(0, 65536, (6, 9, 3), dtype=np.uint16)


def pillow(array, kind, mode=None, **options):
    stream = io.BytesIO()
    image = Image.fromarray(array)
    (image.convert(mode) if mode else image).save(stream, kind, **options)
    return stream.getvalue()


def opencv(array, extension):
    return cv2.imencode(extension, array)[1].tobytes()


def png_header(width, height, depth=8, colour=0):
    head = struct.pack(">IIBBBBB", width, height, depth, colour, 0, 0, 0)
    chunk = b"IHDR" + head
    return b"\x89PNG\r\n\x1a\n" + struct.pack(">I", 13) + chunk + struct.pack(">I", zlib.crc32(chunk)) + b"\0\0\1\0IDAT"


@pytest.mark.parametrize(
    ("data", "kind", "bits", "channels"),
    [
        (pillow(COLOUR, "PNG"), "PNG", 8, 3),
        (pillow(GREY, "PNG"), "PNG", 8, 1),
        (pillow(COLOUR, "PNG", "RGBA"), "PNG", 8, 4),
        (pillow(COLOUR, "PNG", "LA"), "PNG", 8, 2),
        (pillow(COLOUR, "PNG", "P"), "PNG", 8, 3),
        (pillow(COLOUR, "PNG", "P", transparency=0), "PNG", 8, 4),
        (pillow(COLOUR, "PNG", "1"), "PNG", 8, 1),
        (opencv(DEEP, ".png"), "PNG", 16, 1),
        (opencv(DEEP_COLOUR, ".png"), "PNG", 16, 3),
        (pillow(COLOUR, "JPEG"), "JPEG", 8, 3),
        (pillow(GREY, "JPEG"), "JPEG", 8, 1),
        (pillow(COLOUR, "JPEG", "CMYK"), "JPEG", 8, 3),
        (pillow(COLOUR, "TIFF"), "TIFF", 8, 3),
        (opencv(DEEP, ".tiff"), "TIFF", 16, 1),
        (opencv(DEEP_COLOUR, ".tiff"), "TIFF", 16, 3),
        (pillow(COLOUR, "BMP"), "BMP", 8, 3),
        (pillow(COLOUR, "WEBP"), "WEBP", 8, 3),
        (pillow(COLOUR, "WEBP", lossless=True), "WEBP", 8, 3),
        (pillow(COLOUR, "PPM"), "PPM", 8, 3),
        (pillow(GREY, "PPM"), "PPM", 8, 1),
        (pillow(COLOUR, "PPM", "1"), "PPM", 8, 1),
        (opencv(DEEP, ".pgm"), "PPM", 16, 1),
        (b"P5 # width\n9 # and height\n 6\n65535\n" + DEEP.tobytes(), "PPM", 16, 1),
    ],
)
def test_headers(data, kind, bits, channels):
    header = describe(data)
    assert (header.format, header.width, header.height, header.bits, header.channels) == (kind, 9, 6, bits, channels)
    assert header.media_type.startswith("image/")


def test_only_the_header_is_needed():
    assert describe(png_header(8000, 5000)).width == 8000


@pytest.mark.parametrize("size", [(8000, 5001), (40_000_001, 1), (20_000, 20_000), (2**31 - 1, 2**31 - 1)])
def test_too_many_pixels(size):
    with pytest.raises(TooLarge):
        describe(png_header(*size))


def test_the_limit_can_be_set():
    assert describe(png_header(100, 100), max_pixels=10_000).width == 100
    with pytest.raises(TooLarge):
        describe(png_header(100, 101), max_pixels=10_000)


def webp(chunk):
    chunk += bytes(64)
    return b"RIFF" + struct.pack("<I", len(chunk) + 4) + b"WEBP" + chunk


@pytest.mark.parametrize(
    "chunk",
    [
        b"VP8X" + struct.pack("<IB3xHBHB", 10, 0, 16382, 0, 16382, 0),
        b"VP8L" + struct.pack("<IBI", 10, 0x2F, 16382 | 16382 << 14),
        b"VP8 " + struct.pack("<I3s3sHH", 20, b"\x10\0\0", b"\x9d\x01\x2a", 16383, 16383),
    ],
)
def test_a_huge_webp_is_refused_before_pillow_takes_memory_for_it(chunk, monkeypatch):
    monkeypatch.setattr(Image, "open", lambda *args, **kwargs: pytest.fail("the file reached Pillow"))
    with pytest.raises(TooLarge) as caught:
        describe(webp(chunk))
    assert "16383 x 16383" in caught.value.message


@pytest.mark.parametrize("kind", ["PNG", "WEBP", "TIFF"])
def test_several_pictures_are_refused(kind):
    frames = [Image.fromarray(RNG.integers(0, 256, (6, 9, 3), dtype=np.uint8)) for _ in range(3)]
    stream = io.BytesIO()
    frames[0].save(stream, kind, save_all=True, append_images=frames[1:])
    with pytest.raises(InvalidImage) as caught:
        describe(stream.getvalue())
    assert "several pictures" in caught.value.message


def test_a_phones_jpeg_with_a_second_picture_counts_as_the_first():
    frames = [Image.fromarray(COLOUR), Image.fromarray(255 - COLOUR)]
    stream = io.BytesIO()
    frames[0].save(stream, "MPO", save_all=True, append_images=frames[1:])
    assert describe(stream.getvalue()).format == "JPEG"


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"\x89PNG",
        b"no image at all",
        b"<svg xmlns='http://www.w3.org/2000/svg'/>",
        b"%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 9 9\n",
        pillow(COLOUR, "GIF"),
        pillow(COLOUR, "ICO"),
        png_header(0, 5),
        b"P5\n0 5\n255\n",
        b"P5\n9 6\n",
        b"II*\0" + b"\xff" * 12,
        opencv(COLOUR.astype(np.float32), ".tiff"),
        pillow(RNG.integers(0, 2**30, (6, 9), dtype=np.int32), "TIFF"),
        b"Pf\n9 6\n-1.0\n" + bytes(9 * 6 * 4),
    ],
)
def test_what_is_not_read(data):
    with pytest.raises(InvalidImage):
        describe(data)


@pytest.mark.parametrize("kind", ["PNG", "JPEG", "TIFF", "BMP", "WEBP", "PPM"])
def test_mutated_headers_are_read_or_refused_and_nothing_else(kind):
    whole = pillow(COLOUR, kind)
    for _ in range(150):
        data = bytearray(whole)
        for _ in range(3):
            data[RNG.integers(0, min(len(data), 120))] = RNG.integers(0, 256)
        try:
            header = describe(bytes(data))
        except ClearLinesError:
            continue
        assert header.width * header.height <= 40e6
