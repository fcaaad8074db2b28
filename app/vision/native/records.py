"""The records that cross the border to C, field for field those of the headers, ``merging.c`` and ``selection.c``."""

from __future__ import annotations

import ctypes
from ctypes import c_int32, c_void_p
from typing import Any

import numpy as np
from numpy.typing import NDArray

POINT = np.dtype([("along", "i4"), ("across", "f4"), ("slope", "f4"), ("norm", "f4")])
"""A sub-pixel edge point of one pass."""

ARC = np.dtype(
    [
        ("origin", "f8", 2),
        ("sums", "f8", 9),
        ("traits", "f8", 3),
        ("foot", "f8", 2),
        ("tangent", "f8", 2),
        ("bend", "f8"),
        ("low", "f8"),
        ("high", "f8"),
        ("rms", "f8"),
        ("first_piece", "i4"),
        ("last_piece", "i4"),
        ("first_join", "i4"),
        ("last_join", "i4"),
    ]
)
"""A circular arc fitted to edge points; see `app.vision.arcs`."""

JOIN = np.dtype(
    [
        ("leave", "f4", 2),
        ("enter", "f4", 2),
        ("cost", "f4"),
        ("flipped", "i4"),
        ("next", "i4"),
    ]
)
"""How two arcs became one; see `app.vision.merging`."""

FINDING = np.dtype(
    [
        ("arc", "i4"),
        ("first", "i4"),
        ("last", "i4"),
        ("chord", "f4"),
        ("samples", "f4"),
        ("hits", "f4"),
        ("close", "f4"),
        ("rms", "f4"),
        ("mean_norm", "f4"),
        ("longest_gap", "f4"),
        ("contrast", "f4"),
    ]
)
"""What is known of a segment; see `app.vision.selection`."""

SURFACE = np.dtype(
    [
        ("lookup", "f8", 9),
        ("nearness", "f8", 3),
        ("clearness", "f8"),
        ("left", "i4"),
        ("top", "i4"),
        ("right", "i4"),
        ("bottom", "i4"),
        ("first_edge", "i4"),
        ("edges", "i4"),
        ("texture", "i4"),
        ("shadow", "i4"),
        ("colour", "f4", 3),
        ("opacity", "f4"),
    ]
)
"""A polygon to be painted; see `app.synthesis.rasteriser`."""

TEXTURE = np.dtype([("texels", "u8"), ("width", "i4"), ("height", "i4"), ("channels", "i4"), ("unused", "i4")])
"""A picture on such polygons; the address of its texels is that of an array that lives as long."""

CACHE_LINE = 64
"""Bytes."""

GRADIENT_SCALE = 16.0
"""Gradients are kept as integers, in steps of 1 / 16 grey level."""

SPAN = np.dtype([("before", "i4"), ("occupied", "u4")])
"""Pixels of a line; see `app.vision.edges.EdgeMap`."""

MARGIN, LINES_BEYOND, SPAN_PIXELS = 16, 3, 32
"""Pixels without points on either side of a line, such lines after the last, and pixels of a `SPAN`."""


class Scene(ctypes.Structure):
    """Image, gradient and edge points that arcs are looked at in; `app.vision.edges.EdgeMap` holds the memory."""

    _fields_ = (
        ("width", c_int32),
        ("height", c_int32),
        ("gray", c_void_p),
        ("gradient", c_void_p),
        ("points", c_void_p * 2),
        ("spans", c_void_p * 2),
    )


def aligned(count: int, record: np.dtype[Any]) -> NDArray[Any]:
    """Return room for records, beginning where a line of the processor's cache does."""
    memory = np.empty(count * record.itemsize + CACHE_LINE, np.uint8)
    begin = -memory.ctypes.data % CACHE_LINE
    return memory[begin : begin + count * record.itemsize].view(record)


def address(array: NDArray[Any]) -> int:
    """Return where an array's memory begins; C reads it in order.

    The number keeps nothing alive: whoever calls a kernel holds the array until that returns.

    Raises:
        ValueError: If the array isn't contiguous in C's order.
    """
    if not array.flags.c_contiguous:
        raise ValueError("a kernel reads contiguous memory only")
    return array.ctypes.data
