"""Image files built piece by piece, so that each piece can be wrong."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterable

PNG_SIGNATURE = b"\x89PNG\r\n\x1a\n"
SHORT, LONG = 3, 4
TIFF_SIZES = {SHORT: 2, LONG: 4}


def png_chunk(kind: bytes, content: bytes, *, length: int | None = None, checksum: int | None = None) -> bytes:
    """Return a chunk of a PNG (ISO/IEC 15948, 5.3); length and checksum as they should be unless given."""
    said = len(content) if length is None else length
    total = zlib.crc32(kind + content) if checksum is None else checksum
    return struct.pack(">I", said) + kind + content + struct.pack(">I", total)


def png_head(width: int, height: int, *, depth: int = 8, colour: int = 0, interlace: int = 0) -> bytes:
    """Return the signature and the IHDR chunk."""
    return PNG_SIGNATURE + png_chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, depth, colour, 0, 0, interlace))


def png(width: int, height: int, rows: bytes | None = None, *, depth: int = 8, colour: int = 0) -> bytes:
    """Return a PNG whose pixel data are the rows, each with its filter byte; grey zeros unless given."""
    content = bytes(height * (1 + width * depth // 8)) if rows is None else rows
    return png_head(width, height, depth=depth, colour=colour) + png_end(zlib.compress(content, 9))


def png_end(packed: bytes) -> bytes:
    """Return the chunks IDAT and IEND."""
    return png_chunk(b"IDAT", packed) + png_chunk(b"IEND", b"")


def tiff(
    entries: Iterable[tuple[int, int, int]],
    pixels: bytes,
    *,
    next_directory: int = 0,
    order: str = "<",
    places: int = 273,
) -> bytes:
    """Return a TIFF of one directory at byte 8, its pixels behind it (TIFF 6.0, section 2).

    Args:
        entries: Tag, kind and value of each; the value of tag ``places`` becomes where the pixels begin.
        pixels: As they are stored.
        next_directory: Where the next directory would be; 8 is this one again.
        order: Of the bytes, < or >.
        places: 273 for strips, 324 for tiles.
    """
    rows = sorted(entries)
    start = 8 + 2 + 12 * len(rows) + 4
    mark = b"II" if order == "<" else b"MM"
    data = mark + struct.pack(order + "HI", 42, 8) + struct.pack(order + "H", len(rows))
    for tag, kind, value in rows:
        number = start if tag == places else value
        stored = struct.pack(order + ("H" if kind == SHORT else "I"), number).ljust(4, b"\0")
        data += struct.pack(order + "HHI", tag, kind, 1) + stored
    return data + struct.pack(order + "I", next_directory) + pixels


def tiff_entries(width: int, height: int, *, depth: int = 8, **changes: int) -> list[tuple[int, int, int]]:
    """Return the entries of a grey TIFF in one strip; ``t256=0`` changes a value, ``t258=-1`` leaves an entry out."""
    values = {256: width, 257: height, 258: depth, 259: 1, 262: 1, 273: 0, 277: 1, 278: height, 279: width * height}
    values |= {int(name[1:]): value for name, value in changes.items()}
    return [(tag, LONG if tag in (273, 279, 324, 325) else SHORT, value) for tag, value in values.items() if value >= 0]


def bmp(width: int, height: int, pixels: bytes, *, depth: int = 24, packing: int = 0, colours: int = 0) -> bytes:
    """Return a BMP with the header of 40 bytes; a negative height means that rows come from the top."""
    head = struct.pack("<IiiHHIIiiII", 40, width, height, 1, depth, packing, len(pixels), 2835, 2835, colours, 0)
    table = b"".join(bytes([grey, grey, grey, 0]) for grey in range(colours))
    offset = 14 + len(head) + len(table)
    return b"BM" + struct.pack("<IHHI", offset + len(pixels), 0, 0, offset) + head + table + pixels


def riff(*chunks: tuple[bytes, bytes]) -> bytes:
    """Return a WebP container of the chunks (RFC 9649, 2.3)."""
    body = b"".join(kind + struct.pack("<I", len(data)) + data + b"\0" * (len(data) % 2) for kind, data in chunks)
    return b"RIFF" + struct.pack("<I", 4 + len(body)) + b"WEBP" + body
