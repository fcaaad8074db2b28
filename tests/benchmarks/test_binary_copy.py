"""Rows for COPY, byte by byte as PostgreSQL's manual has them."""

from __future__ import annotations

import struct

import numpy as np

from benchmarks.shared.binary_copy import EPOCH, Field, encoded_rows, floats, integers, repeated, texts, times, words


def test_rows_are_as_the_manual_says() -> None:
    points = Field(np.frombuffer(b"abcde", np.uint8), np.array([2, 3]))
    fields = [
        integers([7, -1]),
        words(["keep", "no"], np.array([1, 0])),
        floats(np.array([np.nan, 0.5])),
        points,
        times(np.array([EPOCH + 1.5, np.nan])),
    ]
    first = struct.pack(">h ii i2s i i2s iq", 5, 4, 7, 2, b"no", -1, 2, b"ab", 8, 1_500_000)
    second = struct.pack(">h i i4s id i3s i", 5, -1, 4, b"keep", 8, 0.5, 3, b"cde", -1)
    assert encoded_rows(fields) == first + second


def test_values_are_repeated_by_place() -> None:
    field = repeated(texts(["a", "", "ccc"]), np.array([2, 0, 2]))
    assert (field.flat.tobytes(), field.lengths.tolist()) == (b"cccaccc", [3, 1, 3])
