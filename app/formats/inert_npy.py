"""Read the paper's label files, NumPy object arrays, without unpickling them.

`numpy.load(..., allow_pickle=True)` runs whatever program the file holds. Here the header is read by
`numpy.lib.format`, the pickle by `pickle_gate` and `inert_pickle`, and the numbers are taken from its bytes.
"""

from __future__ import annotations

import io
import math
from typing import Any

import numpy as np
from numpy.lib import format as npy_format
from numpy.typing import NDArray

from app.errors import InvalidFile
from app.formats.inert_pickle import InertArray, interpret, is_usable_shape
from app.formats.limits import SEGMENT_LIMITS, SegmentLimits
from app.formats.pickle_gate import walk
from app.formats.polylines import check_counts, check_file_size, segments_from_arrays
from app.vision.segments import Segments

HEADER_LIMIT = 4096
HEADER_READERS = {(1, 0): npy_format.read_array_header_1_0, (2, 0): npy_format.read_array_header_2_0}
"""By version of the format; 3.0 is for field names beyond Latin-1, and arrays with fields aren't read."""
CODES = frozenset({"f2", "f4", "f8", *(f"{kind}{size}" for kind in "iu" for size in (1, 2, 4, 8))})
ORDERS = ("<", ">", "=", "|")
FOUND = "an object array of (n, 1, 2) coordinates"


def read_label_npy(data: bytes, *, where: str = "file", limits: SegmentLimits = SEGMENT_LIMITS) -> Segments:
    """Read a label file: an object array of ``(n, 1, 2)`` or ``(n, 2)`` coordinates in px.

    Also read are what NumPy makes of segments that all have as many points: a plain or an object array ``(S, n, 1, 2)``
    or ``(S, n, 2)``; and an empty array of any kind, which is no segments.

    Args:
        data: The file.
        where: Its name, for messages.
        limits: How many bytes, segments and points are taken.

    Returns:
        The segments in the file's order, float32, without scores.

    Raises:
        InvalidFile: If it is anything else, broken, or names code.
        TooLarge: Over a limit.
    """
    return segments_from_arrays(read_label_arrays(data, where=where, limits=limits), where=where, limits=limits)


def read_label_arrays(
    data: bytes, *, where: str = "file", limits: SegmentLimits = SEGMENT_LIMITS
) -> list[NDArray[np.generic]]:
    """As `read_label_npy`, but each segment as the file has it: its own shape and dtype, in native byte order."""
    check_file_size(len(data), where=where, limit=limits.file_bytes)
    shape, _, dtype, start = read_npy_header(data, where=where)
    if not dtype.hasobject:
        plain = array_from_npy(data, where=where)
        return _split(plain, where, limits)
    if dtype != np.dtype(object):
        raise InvalidFile("the array has fields", where=where, expected=FOUND)
    found = interpret(walk(data[start:], where=where), encoded_limit=len(data), where=where)
    if not isinstance(found, InertArray) or found.type is None:
        raise InvalidFile("the pickle holds no array", where=where, expected=FOUND)
    if not (found.type.code in ("O8", "O4", "O") and isinstance(found.data, list)):
        raise InvalidFile("the pickle holds no object array", where=where, expected=FOUND)
    if found.shape != shape or math.prod(found.shape) != len(found.data):
        raise InvalidFile(
            f"the header promises shape {shape}, the file holds {found.shape} with {len(found.data)} elements",
            where=where,
        )
    check_counts(shape[0] if shape else 1, 0, where=where, limits=limits)
    if len(shape) == 1:
        check_counts(0, sum(_points(item) for item in found.data), where=where, limits=limits)
        return [_numeric(item, index, where) for index, item in enumerate(found.data)]
    return _split(_from_elements(found.data, shape, where), where, limits)


def read_npy_header(data: bytes, *, where: str) -> tuple[tuple[int, ...], bool, np.dtype[Any], int]:
    """Read the header of a ``.npy`` file, given at least its first bytes.

    Returns:
        Shape, whether in Fortran order, dtype, and where the array begins.

    Raises:
        InvalidFile: If it isn't such a header, or is longer than any array of coordinates needs.
    """
    stream = io.BytesIO(data[: HEADER_LIMIT + 16])
    try:
        read = HEADER_READERS[npy_format.read_magic(stream)]
        shape, fortran, dtype = read(stream, max_header_size=HEADER_LIMIT)
    except Exception as error:  # numpy gives the header to tokenize and literal_eval, which complain in many types
        raise InvalidFile("this is no .npy file, or its header is broken", where=where, expected=FOUND) from error
    if not is_usable_shape(shape):
        raise InvalidFile("the header has no usable shape", where=where, expected=FOUND)
    return shape, bool(fortran), dtype, stream.tell()


def array_from_npy(data: bytes, *, where: str) -> NDArray[Any]:
    """Read a plain ``.npy`` array; the bytes that its header promises must be there, no more and no fewer.

    Raises:
        InvalidFile: If it isn't one, or needs unpickling.
    """
    shape, fortran, dtype, start = read_npy_header(data, where=where)
    if dtype.hasobject:
        raise InvalidFile("the array holds Python objects", where=where, expected="numbers or text")
    promised = math.prod(shape) * dtype.itemsize
    if len(data) - start != promised:
        raise InvalidFile(
            f"the header promises {promised:,} bytes, {len(data) - start:,} follow",
            where=where,
            hint="the file was cut off or changed",
        )
    array = np.frombuffer(data, dtype, math.prod(shape), start) if promised else np.zeros(math.prod(shape), dtype)
    return array.reshape(shape, order="F" if fortran else "C")


def _points(item: Any) -> int:
    return math.prod(item.shape) // 2 if isinstance(item, InertArray) else 0


def _numeric(item: Any, index: int, where: str) -> NDArray[np.generic]:
    here = f"{where}: segment {index}"
    if not isinstance(item, InertArray) or item.type is None:
        raise InvalidFile("a segment is no array", where=here, expected="(n, 1, 2) float64")
    if item.type.code not in CODES or item.type.order not in ORDERS or not isinstance(item.data, bytes | bytearray):
        raise InvalidFile(f"a segment has data type {item.type.code!r:.40}", where=here, expected="(n, 1, 2) float64")
    dtype = np.dtype(item.type.order + item.type.code)
    if len(item.data) != math.prod(item.shape) * dtype.itemsize:
        raise InvalidFile(f"a segment of shape {item.shape} has {len(item.data)} bytes", where=here)
    if len(item.shape) > 3:
        raise InvalidFile(f"a segment has shape {item.shape}", where=here, expected="(n, 1, 2) or (n, 2)")
    array = np.frombuffer(item.data, dtype) if item.data else np.zeros(0, dtype)
    return array.astype(dtype.newbyteorder("=")).reshape(item.shape, order="F" if item.fortran else "C")


def _from_elements(elements: list[Any], shape: tuple[int, ...], where: str) -> NDArray[np.float64]:
    if not all(type(element) in (float, int) for element in elements):
        raise InvalidFile(f"an object array of shape {shape} holds no numbers", where=where, expected=FOUND)
    return np.array(elements, dtype=np.float64).reshape(shape)


def _split(array: NDArray[Any], where: str, limits: SegmentLimits) -> list[NDArray[np.generic]]:
    if array.size == 0 and (array.ndim == 0 or array.shape[0] == 0):
        return []
    if array.dtype.kind not in "fiu" or array.dtype.itemsize > 8:
        raise InvalidFile(f"the array has data type {array.dtype}", where=where, expected=FOUND)
    stacked = (array.ndim == 4 and array.shape[2:] == (1, 2)) or (array.ndim == 3 and array.shape[2] == 2)
    if not stacked or (array.ndim == 3 and array.shape[1] == 1):
        hint = "is it one segment? put it into a list of one" if array.shape[-1:] == (2,) else None
        raise InvalidFile(
            f"the array has shape {array.shape}",
            where=where,
            expected=f"{FOUND}, (S, n, 1, 2) or (S, n, 2)",
            hint=hint,
        )
    check_counts(array.shape[0], array.shape[0] * array.shape[1], where=where, limits=limits)
    native = array.astype(array.dtype.newbyteorder("="), copy=False)
    return list(native)
