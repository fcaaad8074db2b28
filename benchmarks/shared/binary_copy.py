"""Rows in the binary form of PostgreSQL's COPY, made column by column: millions of them in seconds, not minutes.

A file is a signature, rows and an end. A row is the number of its fields (int16), then of each field its length
(int32, -1 for NULL) and its bytes, all big endian: the chapter on COPY of PostgreSQL's manual.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

SIGNATURE = b"PGCOPY\n\xff\r\n\0" + bytes(8)
END = b"\xff\xff"
EPOCH = 946_684_800  # s; PostgreSQL counts microseconds from the year 2000


@dataclass(frozen=True, eq=False)
class Field:
    """One column of N rows.

    Attributes:
        flat: uint8, the bytes of all values one after the other.
        lengths: int64 ``(N,)``, bytes of each value; -1 for NULL.
    """

    flat: NDArray[np.uint8]
    lengths: NDArray[np.int64]


def integers(values: NDArray[np.generic] | Sequence[int]) -> Field:
    """Return a column of the type integer; negative values are NULL."""
    return _fixed(np.asarray(values), ">i4", np.asarray(values) < 0)


def floats(values: NDArray[np.floating[Any]]) -> Field:
    """Return a column of the type double precision; what isn't a number is NULL."""
    return _fixed(values, ">f8", np.isnan(values))


def times(seconds: NDArray[np.floating[Any]]) -> Field:
    """Return a column of the type timestamp with time zone from seconds since 1970; what isn't a number is NULL."""
    missing = np.isnan(seconds)
    return _fixed((np.where(missing, 0, seconds) - EPOCH) * 1e6, ">i8", missing)


def booleans(values: NDArray[np.bool_]) -> Field:
    """Return a column of the type boolean."""
    return _fixed(values, "u1", np.zeros(len(values), bool))


def words(vocabulary: Sequence[str], codes: NDArray[np.integer]) -> Field:
    """Return a column of text from the numbers of words; negative ones are NULL."""
    encoded = [np.frombuffer(word.encode(), np.uint8) for word in vocabulary]
    sizes = np.array([len(word) for word in encoded], np.int64)
    starts = np.concatenate([[0], np.cumsum(sizes)])
    lengths = np.where(codes < 0, -1, sizes[codes])
    chosen = codes[codes >= 0]
    return Field(np.concatenate(encoded)[_ranges(starts[chosen], sizes[chosen])], lengths)


def texts(values: Sequence[str]) -> Field:
    """Return a column of text, or of JSON, from one text per row."""
    encoded = [value.encode() for value in values]
    return Field(np.frombuffer(b"".join(encoded), np.uint8), np.array([len(value) for value in encoded], np.int64))


def hexadecimal(digits: int, rows: int, random: np.random.Generator) -> Field:
    """Return a column of random hexadecimal words, as hashes are."""
    letters = np.frombuffer(b"0123456789abcdef", np.uint8)
    return Field(letters[random.integers(0, 16, rows * digits, np.uint8)], np.full(rows, digits, np.int64))


def identifiers(rows: int, random: np.random.Generator) -> Field:
    """Return a column of random UUIDs as text."""
    letters = hexadecimal(36, rows, random).flat.reshape(rows, 36)
    letters[:, [8, 13, 18, 23]] = ord("-")
    letters[:, 14] = ord("4")
    return Field(letters.reshape(-1), np.full(rows, 36, np.int64))


def repeated(field: Field, index: NDArray[np.integer]) -> Field:
    """Return the values at these places of a column."""
    sizes = np.maximum(field.lengths, 0)
    starts = np.cumsum(sizes) - sizes
    return Field(field.flat[_ranges(starts[index], sizes[index])], field.lengths[index])


def encoded_rows(fields: Sequence[Field]) -> bytes:
    """Return rows as COPY reads them, without signature and end."""
    rows = len(fields[0].lengths)
    sizes = np.full(rows, 2, np.int64)
    for field in fields:
        sizes += 4 + np.maximum(field.lengths, 0)
    starts = np.cumsum(sizes) - sizes
    content = np.empty(int(sizes.sum()), np.uint8)
    _scatter(content, starts, np.full(rows, len(fields), ">i2"))
    place = starts + 2
    for field in fields:
        _scatter(content, place, field.lengths.astype(">i4"))
        sizes = np.maximum(field.lengths, 0)
        if len(field.flat):
            if (sizes == sizes[0]).all():
                _scatter(content, place + 4, field.flat.reshape(rows, -1))
            else:
                content[_ranges(place + 4, sizes)] = field.flat
        place = place + 4 + sizes
    return content.tobytes()


def _fixed(values: NDArray[np.generic], kind: str, missing: NDArray[np.bool_]) -> Field:
    stored = np.ascontiguousarray(values[~missing]).astype(kind)
    return Field(stored.view(np.uint8), np.where(missing, -1, stored.itemsize))


def _ranges(starts: NDArray[np.int64], sizes: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return ``starts[0], starts[0] + 1, ...`` of each range, one after the other."""
    before = np.cumsum(sizes) - sizes
    return np.repeat(starts - before, sizes) + np.arange(int(sizes.sum()))


def _scatter(content: NDArray[np.uint8], places: NDArray[np.int64], values: NDArray[np.generic]) -> None:
    as_bytes = np.ascontiguousarray(values).view(np.uint8).reshape(len(places), -1)
    for column in range(as_bytes.shape[1]):
        content[places + column] = as_bytes[:, column]
