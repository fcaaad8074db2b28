"""Reading a table's rows in the order of its key, in the same form from either kind of database.

In that form a time is text in UTC, ``2025-06-01 12:00:00.000000``, a boolean 0 or 1 and JSON the text as it was stored;
numbers, text and bytes are themselves. A zero has no sign, as SQLite keeps none.
"""

from __future__ import annotations

import marshal
from collections.abc import Generator
from contextlib import closing
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from sqlalchemy import (
    ColumnElement,
    Connection,
    Integer,
    Text,
    case,
    cast,
    collate,
    column,
    func,
    literal_column,
    select,
)
from sqlalchemy.dialects import postgresql, sqlite

from app.db.copying.tables import CopiedColumn, CopiedTable

Row = tuple[Any, ...]

BATCH_ROWS = 4000
BATCH_BYTES = 4 * 2**20
FIRST_ROWS = 50


@dataclass(frozen=True)
class Batch:
    """Rows of a table.

    Attributes:
        rows: In the order of its key.
        canonical: All of them as bytes, the same from either kind of database.
    """

    rows: list[Row]
    canonical: bytes


def read_rows(connection: Connection, table: CopiedTable) -> Generator[Batch]:
    """Read a whole table, in batches of bounded size whatever its rows are like.

    Args:
        connection: In a transaction, whose snapshot is read.
        table: The table.
    """
    connection.execute(select(1))  # begins the transaction, of which the driver's own cursor knows nothing
    with closing(_cursor(connection)) as cursor:
        cursor.execute(_statement(connection.dialect.name, table))
        size = FIRST_ROWS
        while rows := cursor.fetchmany(size):
            # ten times faster than text; only ever compared. Format 2: later ones depend on which objects are the same
            canonical = b"".join(marshal.dumps(row, 2) for row in rows)
            yield Batch(rows, canonical)
            size = max(1, min(BATCH_ROWS, BATCH_BYTES * len(rows) // len(canonical)))


def count_rows(connection: Connection, table: CopiedTable) -> int:
    """Return how many rows a table has."""
    return connection.execute(select(func.count()).select_from(table.clause)).scalar_one()


def _cursor(connection: Connection) -> Any:
    driver: Any = connection.connection.driver_connection
    if connection.dialect.name == "postgresql":
        # one that stays on the server; the client would otherwise take the whole table into memory
        return driver.cursor(name="clearlines_copy", binary=True)
    return driver.cursor()


@lru_cache(maxsize=256)
def _statement(kind: str, table: CopiedTable) -> str:
    """Return the statement that reads a table of one kind of database in the order of its key, text by code point."""
    postgres = kind == "postgresql"
    value = _postgres_value if postgres else _sqlite_value
    values = (value(each, column(each.name)) for each in table.columns)
    order = (
        collate(column(each.name), "C") if postgres and each.kind == "text" else column(each.name) for each in table.key
    )
    statement = select(*values).select_from(table.clause).order_by(*order)
    dialect = postgresql.dialect() if postgres else sqlite.dialect()
    return str(statement.compile(dialect=dialect, compile_kwargs={"literal_binds": True}))


def _postgres_value(each: CopiedColumn, stored: ColumnElement[Any]) -> ColumnElement[Any]:
    match each.kind:
        case "time":
            return func.to_char(func.timezone("UTC", stored), "YYYY-MM-DD HH24:MI:SS.US")
        case "json":
            return cast(stored, Text)
        case "boolean":
            return cast(stored, Integer)
        case "float":
            return stored.op("+")(literal_column("0"))
        case _:
            return stored


def _sqlite_value(each: CopiedColumn, stored: ColumnElement[Any]) -> ColumnElement[Any]:
    match each.kind:
        case "time":  # SQL may have written it shorter
            longer = {19: stored.concat(".000000"), 10: stored.concat(" 00:00:00.000000")}
            return case(longer, value=func.length(stored), else_=stored)
        case "json":
            return cast(stored, Text)
        case _:
            return stored
