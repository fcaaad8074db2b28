"""Two habits of TIFF readers that change pixels; both are switched off in the bytes, since no option does it.

OpenCV turns a TIFF by its orientation whatever it is told, and libtiff multiplies colour by "unassociated" alpha.
"""

from __future__ import annotations

import struct

ORIENTATION, TOP_LEFT = 274, 1
EXTRA_SAMPLES, UNASSOCIATED, ASSOCIATED = 338, 2, 1
SHORT = 3
ENTRY_LIMIT = 4096


def as_stored(data: bytes) -> bytes:
    """Return the TIFF with the tags of its first picture set so that its pixels are decoded as they are stored.

    Orientation becomes 1, and alpha that colour is to be multiplied by becomes alpha that it already is. Classic and
    BigTIFF, either byte order (TIFF 6.0, section 2, header and directory; sections 8 and 18, the tags). A file in
    which neither tag is found comes back as it is.
    """
    changed: bytearray | None = None
    order = "<" if data[:2] == b"II" else ">"
    for tag, at in _short_entries(data, order):
        (value,) = struct.unpack_from(order + "H", data, at)
        turns = tag == ORIENTATION and value != TOP_LEFT
        multiplies = tag == EXTRA_SAMPLES and value == UNASSOCIATED
        if turns or multiplies:
            changed = changed or bytearray(data)
            struct.pack_into(order + "H", changed, at, TOP_LEFT if turns else ASSOCIATED)
    return data if changed is None else bytes(changed)


def _short_entries(data: bytes, order: str) -> list[tuple[int, int]]:
    """Return tag and place of the first value, of each 16-bit entry of the first directory that holds its values."""
    if len(data) < 16:
        return []
    big = struct.unpack_from(order + "H", data, 2)[0] == 43
    number, start_at, size, value_at, inside = ("Q", 8, 20, 12, 4) if big else ("I", 4, 12, 8, 2)
    (start,) = struct.unpack_from(order + number, data, start_at)
    count_format = order + ("Q" if big else "H")
    first = start + struct.calcsize(count_format)
    if first > len(data):
        return []
    (count,) = struct.unpack_from(count_format, data, start)
    found: list[tuple[int, int]] = []
    for at in range(first, first + size * min(count, ENTRY_LIMIT), size):
        if at + size > len(data):
            break
        tag, kind = struct.unpack_from(order + "HH", data, at)
        (values,) = struct.unpack_from(order + number, data, at + 4)
        if kind == SHORT and values <= inside:
            found.append((tag, at + value_at))
    return found
