"""Telling whether two tables hold the same rows."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import zip_longest

from sqlalchemy import Connection

from app.db.copying.reading import Batch, Row, read_rows
from app.db.copying.tables import CopiedTable
from app.errors import ClearLinesError, InvalidInput, Unavailable

HINT = "nothing was changed at the source; is something wrong with a disk?"


@dataclass(frozen=True)
class TableDigest:
    """How many rows a table has, and the SHA-256 of all of them in the order of its key."""

    rows: int
    sha256: str


class Digesting:
    """Makes the digest of the batches that it lets through."""

    def __init__(self, batches: Iterator[Batch]) -> None:
        self._batches = batches
        self._hash = hashlib.sha256()
        self.rows = 0

    def __iter__(self) -> Iterator[Batch]:
        for batch in self._batches:
            self._hash.update(batch.canonical)
            self.rows += len(batch.rows)
            yield batch

    @property
    def digest(self) -> TableDigest:
        """The digest of what was let through so far."""
        return TableDigest(self.rows, self._hash.hexdigest())


def digest_of(connection: Connection, table: CopiedTable) -> TableDigest:
    """Return the digest of a table as it is stored."""
    digesting = Digesting(read_rows(connection, table))
    for _ in digesting:
        pass
    return digesting.digest


def require_same(source: Connection, target: Connection, table: CopiedTable, expected: TableDigest) -> None:
    """Compare a table with the one that it was copied from.

    Args:
        source: Where it came from, in the snapshot that was copied.
        target: Where it is now.
        table: The table.
        expected: Of the rows as they were read from the source.

    Raises:
        InvalidInput: When they differ in what the target can't hold, naming table, row and column.
        Unavailable: When they differ otherwise.
    """
    if digest_of(target, table) == expected:
        return
    raise _difference(source, target, table)


def _difference(source: Connection, target: Connection, table: CopiedTable) -> ClearLinesError:
    for sent, arrived in zip_longest(_rows(source, table), _rows(target, table)):
        where = f"{table.name}, {table.key_of(sent or arrived or ())}"
        if sent is None or arrived is None or table.key_of(sent) != table.key_of(arrived):
            return Unavailable("the copy differs from here on: a row is missing, or too many", where=where, hint=HINT)
        for column, value, other in zip(table.columns, sent, arrived, strict=True):
            if repr(value) == repr(other):
                continue
            if value != value:
                return no_nan(f"{where}, {column.name}")
            message = "the copy differs: another value arrived than was sent"
            return Unavailable(message, where=f"{where}, {column.name}", hint=HINT)
    return Unavailable("what was read from the source differed from one time to the next", where=table.name, hint=HINT)


def no_nan(where: str) -> InvalidInput:
    """Return what is wrong with a number that is none: SQLite stores nothing instead."""
    return InvalidInput("SQLite can't hold NaN", where=where, hint="change the value at the source, and begin again")


def _rows(connection: Connection, table: CopiedTable) -> Iterator[Row]:
    for batch in read_rows(connection, table):
        yield from batch.rows
