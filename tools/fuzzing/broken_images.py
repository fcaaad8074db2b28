"""Images that are broken, odd, or made to harm: each a small file, with what becomes of it."""

from __future__ import annotations

import io
import struct
import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from PIL import Image

from tools.fuzzing.image_files import (
    LONG,
    SHORT,
    bmp,
    png,
    png_chunk,
    png_end,
    png_head,
    riff,
    tiff,
    tiff_entries,
)

Fate = Literal["shown", "invalid", "too large"]
WIDTH, HEIGHT = 24, 18
HUGE = 60_000
"""Side of images that would take 10 GB of memory as colour."""


@dataclass(frozen=True)
class BrokenImage:
    """A file and what becomes of it.

    Attributes:
        name: With the extension it comes under.
        data: Its bytes.
        fate: It is shown, or refused as invalid or as too large.
        size: Width and height in px, of what is shown.
    """

    name: str
    data: bytes
    fate: Fate
    size: tuple[int, int] = (WIDTH, HEIGHT)


def pixels(mode: str = "RGB") -> Image.Image:
    """Return a small picture that isn't alike anywhere."""
    random = np.random.default_rng(3)
    return Image.fromarray(random.integers(0, 256, (HEIGHT, WIDTH, 3), dtype=np.uint8)).convert(mode)


def saved(kind: str, mode: str = "RGB", **options: Any) -> bytes:
    """Return the picture as a file."""
    stream = io.BytesIO()
    pixels(mode).save(stream, kind, **options)
    return stream.getvalue()


def without(data: bytes, count: int) -> bytes:
    """Return the file without its last bytes."""
    return data[: len(data) - count]


def bomb(megabytes: int) -> bytes:
    """Return a stream that unpacks to so much: a thousandth of it long."""
    packer = zlib.compressobj(9)
    return b"".join(packer.compress(bytes(2**20)) for _ in range(megabytes)) + packer.flush()


def of_png() -> Iterator[BrokenImage]:
    """Give broken and odd PNGs."""
    whole = saved("PNG")
    ends = {"in the signature": 5, "in the header": 20, "behind the header": 33, "in the length of the pixels": 35}
    for words, end in ends.items():
        yield BrokenImage(f"cut {words}.png", whole[:end], "invalid")
    yield BrokenImage("cut in the pixels.png", whole[: len(whole) // 2], "invalid")
    wrong = png_chunk(b"IHDR", struct.pack(">IIBBBBB", WIDTH, HEIGHT, 8, 0, 0, 0, 0), checksum=1)
    yield BrokenImage("wrong checksum of the header.png", whole[:8] + wrong + png_end(zlib.compress(b"")), "invalid")
    rows = bytes(HEIGHT * (WIDTH + 1))
    broken = png_chunk(b"IDAT", zlib.compress(rows), checksum=1) + png_chunk(b"IEND", b"")
    yield BrokenImage("wrong checksum of the pixels.png", png_head(WIDTH, HEIGHT) + broken, "invalid")
    yield BrokenImage("no pixels at all.png", png_head(WIDTH, HEIGHT) + png_chunk(b"IEND", b""), "invalid")
    yield BrokenImage("pixels that are no zlib.png", png_head(WIDTH, HEIGHT) + png_end(b"no zlib"), "invalid")
    yield BrokenImage("too few rows.png", png(WIDTH, HEIGHT, bytes(3 * (WIDTH + 1))), "invalid")
    yield BrokenImage("a filter that is none.png", png(WIDTH, HEIGHT, (b"\x09" + bytes(WIDTH)) * HEIGHT), "invalid")
    yield BrokenImage("a chunk of 2 GiB.png", png_head(WIDTH, HEIGHT) + b"\x7f\xff\xff\xffIDAT1234", "invalid")
    yield BrokenImage("depth 3.png", png_head(WIDTH, HEIGHT, depth=3) + png_end(zlib.compress(rows)), "invalid")
    yield BrokenImage("no width.png", png(0, HEIGHT, b""), "invalid")
    yield BrokenImage("no height.png", png(WIDTH, 0, b""), "invalid")
    yield BrokenImage("huge.png", png_head(HUGE, HUGE) + png_end(zlib.compress(b"")), "too large")
    yield BrokenImage("widest of all.png", png_head(2**31 - 1, 2**31 - 1) + png_end(b""), "too large")
    yield BrokenImage("more pixels than said.png", png_head(WIDTH, HEIGHT) + png_end(bomb(8)), "invalid")
    text = png_chunk(b"zTXt", b"Comment\0\0" + bomb(8))
    yield BrokenImage("a text that unpacks to 8 MiB.png", png_head(WIDTH, HEIGHT) + text + whole[33:], "invalid")
    yield BrokenImage("16 bit.png", saved("PNG", "I;16"), "shown")
    yield BrokenImage("palette.png", saved("PNG", "P"), "shown")
    yield BrokenImage("two colours.png", saved("PNG", "1"), "shown")
    frames = [pixels(), pixels().rotate(180)]
    yield BrokenImage("animated.png", saved("PNG", save_all=True, append_images=frames), "invalid")


def of_jpeg() -> Iterator[BrokenImage]:
    """Give broken and odd JPEGs."""
    whole = saved("JPEG", quality=95)
    for words, end in {"in the first marker": 3, "in a table": 60, "behind the tables": 600}.items():
        yield BrokenImage(f"cut {words}.jpg", whole[:end], "invalid")
    yield BrokenImage("cut in the pixels.jpg", whole[: len(whole) * 2 // 3], "invalid")
    progressive = saved("JPEG", progressive=True, quality=95)
    yield BrokenImage("progressive.jpg", progressive, "shown")
    yield BrokenImage("progressive, cut.jpg", progressive[: len(progressive) * 2 // 3], "invalid")
    start = whole.index(b"\xff\xc0")
    for words, size in {"huge": (65500, 65500), "no height": (0, WIDTH), "no width": (HEIGHT, 0)}.items():
        sized = whole[: start + 5] + struct.pack(">HH", *size) + whole[start + 9 :]
        yield BrokenImage(f"{words}.jpg", sized, "too large" if words == "huge" else "invalid")
    yield BrokenImage("CMYK.jpg", saved("JPEG", "CMYK"), "shown")
    yield BrokenImage("grey.jpg", saved("JPEG", "L"), "shown")
    exif = Image.Exif()
    exif[0x0112] = 6
    yield BrokenImage("to be turned.jpg", saved("JPEG", exif=exif), "shown")
    yield BrokenImage("nonsense for EXIF.jpg", saved("JPEG", exif=b"Exif\0\0MM\0*\xff\xff\xff\xff"), "shown")
    yield BrokenImage("something behind it.jpg", whole + b"PK\x03\x04" * 200, "shown")


def of_tiff() -> Iterator[BrokenImage]:
    """Give broken and odd TIFFs."""
    grey = pixels("L").tobytes()
    entries = tiff_entries(WIDTH, HEIGHT)
    yield BrokenImage("by hand.tif", tiff(entries, grey), "shown")
    yield BrokenImage("cut in the directory.tif", tiff(entries, grey)[:40], "invalid")
    yield BrokenImage("cut in the pixels.tif", tiff(entries, grey[: len(grey) // 2]), "invalid")
    yield BrokenImage("a directory that comes after itself.tif", tiff(entries, grey, next_directory=8), "shown")
    yield BrokenImage("a next directory outside.tif", tiff(entries, grey, next_directory=2**31), "invalid")
    yield BrokenImage("a directory outside.tif", b"II*\0" + struct.pack("<I", 2**31) + grey, "invalid")
    yield BrokenImage("no width.tif", tiff(tiff_entries(0, HEIGHT), grey), "invalid")
    yield BrokenImage("no entries.tif", tiff([], grey), "invalid")
    wide = [(256, LONG, HUGE), (257, LONG, HUGE), *(entry for entry in entries if entry[0] > 257)]
    yield BrokenImage("huge.tif", tiff(wide, grey), "too large")
    yield BrokenImage("strips outside.tif", tiff(tiff_entries(WIDTH, HEIGHT, t279=2**31), grey), "shown")
    yield BrokenImage("no place of pixels.tif", tiff(tiff_entries(WIDTH, HEIGHT, t273=-1), grey), "invalid")
    yield BrokenImage("floating point.tif", saved("TIFF", "F"), "invalid")
    yield BrokenImage("packing 60000.tif", tiff(tiff_entries(WIDTH, HEIGHT, t259=60000), grey), "invalid")
    tiled = [
        (256, SHORT, 32), (257, SHORT, 32), (258, SHORT, 8), (259, SHORT, 1), (262, SHORT, 1), (277, SHORT, 1),
        (322, SHORT, 32), (323, SHORT, 32), (324, LONG, 0), (325, LONG, 1024),
    ]  # fmt: skip
    yield BrokenImage("tiled.tif", tiff(tiled, bytes(range(256)) * 4, places=324), "shown", (32, 32))
    for words, tag in {"no tile width": 322, "tiles of 64k": 323}.items():
        changed = [(t, k, {322: 0, 323: 65520}[tag] if t == tag else v) for t, k, v in tiled]
        yield BrokenImage(f"{words}.tif", tiff(changed, bytes(1024), places=324), "invalid", (32, 32))
    yield BrokenImage("two pages.tif", saved("TIFF", save_all=True, append_images=[pixels()]), "invalid")
    for packing in ("tiff_lzw", "tiff_adobe_deflate", "packbits", "jpeg"):
        yield BrokenImage(f"{packing}.tif", saved("TIFF", compression=packing), "shown")
    yield BrokenImage("lzw, cut.tif", without(saved("TIFF", compression="tiff_lzw"), 400), "invalid")


def of_webp() -> Iterator[BrokenImage]:
    """Give broken and odd WebPs."""
    lossy, lossless = saved("WEBP"), saved("WEBP", lossless=True)
    yield BrokenImage("lossless.webp", lossless, "shown")
    yield BrokenImage("with alpha.webp", saved("WEBP", "RGBA"), "shown")
    for words, data in {"lossy": lossy, "lossless": lossless}.items():
        yield BrokenImage(f"{words}, cut in the header.webp", data[:24], "invalid")
        yield BrokenImage(f"{words}, cut in the pixels.webp", data[: len(data) // 2], "invalid")
    animation = saved("WEBP", save_all=True, append_images=[pixels().rotate(180)])
    yield BrokenImage("animated.webp", animation, "invalid")
    canvas = struct.pack("<IHBHB", 0, 0xFFFF, 0, 0xFFFF, 0)
    yield BrokenImage("huge canvas.webp", riff((b"VP8X", canvas), (b"VP8L", lossless[20:])), "too large")
    yield BrokenImage("a canvas without a picture.webp", riff((b"VP8X", bytes(10))), "invalid")


def of_other_kinds() -> Iterator[BrokenImage]:
    """Give broken and odd BMPs and PNMs, and what is no image at all."""
    colour = pixels().tobytes()
    yield BrokenImage("from the top.bmp", bmp(WIDTH, -HEIGHT, colour), "shown")
    yield BrokenImage("cut.bmp", bmp(WIDTH, HEIGHT, colour[: len(colour) // 2]), "invalid")
    yield BrokenImage("huge.bmp", bmp(HUGE, HUGE, b""), "too large")
    yield BrokenImage("negative width.bmp", bmp(-WIDTH, HEIGHT, colour), "too large")
    yield BrokenImage("lowest height.bmp", bmp(WIDTH, -(2**31), colour), "too large")
    runs = b"".join(bytes([WIDTH, row, 0, 0]) for row in range(HEIGHT)) + b"\0\1"
    yield BrokenImage("run lengths.bmp", bmp(WIDTH, HEIGHT, runs, depth=8, packing=1, colours=256), "shown")
    away = b"\0\2\xff\xff" * 200 + b"\0\1"
    yield BrokenImage("runs that leave it.bmp", bmp(WIDTH, HEIGHT, away, depth=8, packing=1, colours=256), "shown")
    yield BrokenImage("palette.bmp", saved("BMP", "P"), "shown")
    yield BrokenImage("comments.ppm", b"P6 # a\n# b\n24 # c\n18\n# d\n255\n" + colour, "shown")
    yield BrokenImage("16 bit.pgm", b"P5 24 18 65535\n" + colour[: 2 * WIDTH * HEIGHT], "shown")
    yield BrokenImage("text.pgm", b"P2\n3 2\n255\n1 2 3\n4 5 6\n", "shown", (3, 2))
    yield BrokenImage("maximum of 70000.pgm", b"P5 24 18 70000\n" + colour, "invalid")
    yield BrokenImage("maximum of nothing.pgm", b"P5 24 18 0\n" + colour, "invalid")
    yield BrokenImage("huge.ppm", b"P6 60000 60000 255\n" + colour, "too large")
    yield BrokenImage("a width without end.ppm", b"P6 " + b"9" * 5000 + b" 2 255\n", "invalid")
    yield BrokenImage("a comment without end.ppm", b"P6 #" + b"x" * 100_000, "invalid")
    yield BrokenImage("cut.ppm", b"P6 24 18 255\n" + colour[:100], "invalid")
    yield BrokenImage("floating point.ppm", b"Pf\n2 2\n-1.0\n" + bytes(16), "invalid")
    strangers = {
        "empty": b"",
        "one byte": b"\x89",
        "a drawing": b'<svg xmlns="http://www.w3.org/2000/svg"><script>alert(1)</script></svg>',
        "a page": b"<!doctype html><script>alert(1)</script>",
        "a program": b"#!/bin/sh\necho hello\n",
        "a GIF": saved("GIF", "P"),
        "an icon": saved("ICO"),
        "an EPS": b"%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 10 10\n(hello) show\n",
        "zeros": bytes(4096),
        "ones": b"\xff" * 4096,
        "a zip": b"PK\x03\x04" + bytes(60),
    }
    yield from (BrokenImage(f"{name}.png", data, "invalid") for name, data in strangers.items())


MAKERS: tuple[Callable[[], Iterator[BrokenImage]], ...] = (of_png, of_jpeg, of_tiff, of_webp, of_other_kinds)


def broken_images() -> list[BrokenImage]:
    """Return all of them."""
    return [image for make in MAKERS for image in make()]
