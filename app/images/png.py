"""Whether a PNG is whole, told from its chunks: no memory is taken for its pixels, nor for what it only promises."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator

from app.errors import InvalidImage
from app.images.header import PNG_SIGNATURE

PIECE = 2**18
SURPLUS = 2**16
"""Bytes behind the last row that are overlooked; a decoder unpacks what is there, however much it is."""
LAST_FILTER = 4
SAMPLES = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}
"""Samples per pixel by colour type."""
PASSES = ((0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2), (0, 1, 1, 2))
"""Start and step in x and y of the seven pictures of an interlaced one: x, y, step of x, step of y."""


def check_chunks(data: bytes) -> None:
    """Refuse a PNG one of whose chunks is longer than the file: readers take memory for what a chunk says it holds.

    Chunks are length, type, content and checksum (ISO/IEC 15948, 5.3). What comes behind the last is left alone.

    Raises:
        InvalidImage: If the file is cut off or a length is wrong.
    """
    for _ in _chunks(data):
        pass


def check_png(data: bytes) -> None:
    """Refuse a PNG that isn't whole: checksums, an end, and as many rows of pixels as its header promises.

    Raises:
        InvalidImage: Saying what is wrong.
    """
    chunks = [(kind, start, end) for kind, start, end in _chunks(data)]
    for kind, start, end in chunks:
        if zlib.crc32(data[start - 4 : end]) != struct.unpack_from(">I", data, end)[0]:
            raise _broken(f"the checksum of its part {kind.decode('latin-1')} is wrong")
    if not chunks or chunks[0][0] != b"IHDR" or chunks[0][2] - chunks[0][1] != 13:
        raise _broken("it has no header")
    _check_pixels(data, [(start, end) for kind, start, end in chunks if kind == b"IDAT"], chunks[0][1])


def _chunks(data: bytes) -> Iterator[tuple[bytes, int, int]]:
    """Give type, and start and end of the content, of each chunk to the last, which is IEND."""
    at = len(PNG_SIGNATURE)
    while at + 12 <= len(data):
        length, kind = struct.unpack_from(">I4s", data, at)
        end = at + 8 + length
        if end + 4 > len(data):
            break
        yield kind, at + 8, end
        if kind == b"IEND":
            return
        at = end + 4
    raise InvalidImage("the PNG is cut off", expected="a file that ends with IEND", hint="is the file whole?")


def _check_pixels(data: bytes, places: list[tuple[int, int]], header: int) -> None:
    """Unpack the rows piece by piece; compare their number and look at the filter each begins with."""
    width, height, depth, colour, _, _, interlaced = struct.unpack_from(">IIBBBBB", data, header)
    bits = depth * SAMPLES.get(colour, 1)
    sizes = _pass_sizes(width, height) if interlaced else [(width, height)]
    rows = [(1 + (columns * bits + 7) // 8, lines) for columns, lines in sizes if columns and lines]
    expected = sum(stride * lines for stride, lines in rows)
    found = 0
    for piece in _unpacked(data, places):
        if not interlaced and max(piece[-found % rows[0][0] :: rows[0][0]], default=0) > LAST_FILTER:
            raise _broken("a row of its pixels is filtered in an unknown way")
        found += len(piece)
        if found > expected + SURPLUS:
            raise _broken("it unpacks to more pixels than its header says")
    if found < expected:
        raise _broken("some of its pixels are missing")


def _unpacked(data: bytes, places: list[tuple[int, int]]) -> Iterator[bytes]:
    unpacker = zlib.decompressobj()
    view = memoryview(data)
    try:
        for start, end in places:
            packed: bytes | memoryview = view[start:end]
            while piece := unpacker.decompress(packed, PIECE):
                yield piece
                packed = unpacker.unconsumed_tail
    except zlib.error as error:
        raise _broken("its pixels can't be unpacked") from error


def _pass_sizes(width: int, height: int) -> list[tuple[int, int]]:
    """Return width and height of each picture of an interlaced one (ISO/IEC 15948, 8.2)."""
    return [
        (max(0, width - x + right - 1) // right, max(0, height - y + down - 1) // down) for x, y, right, down in PASSES
    ]


def _broken(what: str) -> InvalidImage:
    return InvalidImage(f"the PNG is broken: {what}", hint="is the file whole?")
