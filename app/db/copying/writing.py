"""Writing rows, as they were read, into a table of either kind of database."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Any

from sqlalchemy import Connection, insert

from app.db.copying.digests import no_nan
from app.db.copying.reading import Batch, Row
from app.db.copying.tables import CopiedTable
from app.db.copying.targets import Target
from app.errors import InvalidInput


def write_rows(target: Target, table: CopiedTable, batches: Iterable[Batch]) -> None:
    """Add rows to a table: through COPY on PostgreSQL, on SQLite each batch in a transaction of its own.

    Raises:
        InvalidInput: On a row that the database can't hold, as text with a NUL on PostgreSQL; it is named.
    """
    if target.is_sqlite:
        for batch in batches:
            with target.transaction() as connection:
                _insert(connection, table, batch.rows)
    else:
        with target.transaction() as connection:
            _copy_in(connection, table, batches)


def _copy_in(connection: Connection, table: CopiedTable, batches: Iterable[Batch]) -> None:
    driver: Any = connection.connection.driver_connection
    written = _Written(batches)
    try:
        with driver.cursor() as cursor, cursor.copy(_copy_statement(connection, table)) as copy:
            for row in written:
                copy.write_row(row)
    except connection.dialect.loaded_dbapi.DataError as error:
        place = re.search(r"^COPY .+?, line (\d+)(?:, column (\w+))?", error.diag.context or "", re.MULTILINE)
        row = written.row(int(place[1]) if place else written.number)
        raise _refused(table, row, place[2] if place else None, error.diag.message_primary or str(error)) from error


class _Written:
    """Rows on their way; those of the last two batches can be asked for, when the server has refused one of them."""

    def __init__(self, batches: Iterable[Batch]) -> None:
        self._batches = batches
        self._in_hand: list[tuple[int, list[Row]]] = []
        self.number = 0

    def __iter__(self) -> Iterator[Row]:
        for batch in self._batches:
            self._in_hand = [*self._in_hand[-1:], (self.number, batch.rows)]
            for row in batch.rows:
                self.number += 1
                yield row

    def row(self, number: int) -> Row | None:
        """Return the row of that number, from 1."""
        for before, rows in self._in_hand:
            if before < number <= before + len(rows):
                return rows[number - before - 1]
        return None


def _insert(connection: Connection, table: CopiedTable, rows: list[Row]) -> None:
    driver: Any = connection.connection.driver_connection
    statement = str(insert(table.clause).compile(dialect=connection.dialect))
    errors = (connection.dialect.loaded_dbapi.IntegrityError, connection.dialect.loaded_dbapi.DataError)
    driver.execute("SAVEPOINT batch")
    try:
        driver.executemany(statement, rows)
    except errors:
        driver.execute("ROLLBACK TO batch")
        for row in rows:
            try:
                driver.execute(statement, row)
            except errors as error:
                raise _refused(table, row, None, str(error)) from error
        raise


def _copy_statement(connection: Connection, table: CopiedTable) -> str:
    quote = connection.dialect.identifier_preparer.quote
    return f"COPY {quote(table.name)} ({', '.join(quote(each.name) for each in table.columns)}) FROM STDIN"


def _refused(table: CopiedTable, row: Row | None, column: str | None, reason: str) -> InvalidInput:
    for each, value in zip(table.columns, row or (), strict=False):
        if isinstance(value, float) and value != value and reason.startswith("NOT NULL"):
            return no_nan(f"{table.name}, {table.key_of(row or ())}, {each.name}")
    where = (table.name, table.key_of(row) if row else None, column)
    return InvalidInput(
        f"the other database can't hold it: {reason}",
        where=", ".join(filter(None, where)),
        hint="change the value at the source, where nothing was touched, and begin again",
    )
