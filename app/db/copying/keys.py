"""Putting a database's keys, indexes and triggers aside while its tables are filled, and making them again afterwards.

An index is made many times faster from a full table than row by row, foreign keys that go round in circles can't be
kept while only half of the rows are there, and what triggers write is copied like everything else. On PostgreSQL this
needs no right but that of the tables' owner.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from sqlalchemy import Connection, text
from sqlalchemy.exc import IntegrityError

from app.db.copying.tables import CopiedTable
from app.db.copying.targets import Target
from app.errors import InvalidInput

# unique constraints before the foreign keys that may rest on them
CONSTRAINTS = """
SELECT conrelid::regclass::text, quote_ident(conname), pg_get_constraintdef(oid)
FROM pg_constraint
WHERE connamespace = current_schema()::regnamespace AND contype IN ('u', 'f') AND conrelid = to_regclass(:name)
ORDER BY contype DESC, conname
"""
INDEXES = """
SELECT indexrelid::regclass::text, pg_get_indexdef(indexrelid)
FROM pg_index
WHERE indrelid = to_regclass(:name) AND NOT EXISTS (SELECT FROM pg_constraint WHERE conindid = indexrelid)
ORDER BY 1
"""
SORTING_MEMORY = "256MB"  # for making one index


@contextmanager
def keys_aside(target: Target, tables: tuple[CopiedTable, ...]) -> Iterator[None]:
    """Drop indexes, unique constraints, foreign keys and triggers; primary keys stay. All is back after the block.

    Raises:
        InvalidInput: When the rows break one of them.
    """
    with target.transaction() as connection:
        again = _drop_sqlite(connection, tables) if target.is_sqlite else _drop_postgres(connection, tables)
    yield
    with target.transaction() as connection:
        try:
            for statement in again:
                connection.execute(text(statement.replace(":", r"\:")))
            if target.is_sqlite:
                _check_foreign_keys(connection)
        except IntegrityError as error:
            raise InvalidInput(f"the rows of the source contradict each other: {error.orig}") from error


def _drop_postgres(connection: Connection, tables: tuple[CopiedTable, ...]) -> list[str]:
    connection.execute(text(f"SET LOCAL maintenance_work_mem = '{SORTING_MEMORY}'"))
    connection.execute(text("SET LOCAL TIME ZONE 'UTC'"))
    quote = connection.dialect.identifier_preparer.quote
    constraints, indexes = [], []
    for table in tables:
        name = {"name": quote(table.name)}
        constraints += connection.execute(text(CONSTRAINTS), name).all()
        indexes += connection.execute(text(INDEXES), name).all()
    unique_first = sorted(constraints, key=lambda found: found[2].startswith("FOREIGN"))
    for owner, constraint, _ in reversed(unique_first):
        connection.execute(text(f"ALTER TABLE {owner} DROP CONSTRAINT {constraint}"))
    for index, _ in indexes:
        connection.execute(text(f"DROP INDEX {index}"))
    names = [quote(table.name) for table in tables]
    for name in names:
        connection.execute(text(f"ALTER TABLE {name} DISABLE TRIGGER USER"))
    return [
        *(definition for _, definition in indexes),
        *(f"ALTER TABLE {owner} ADD CONSTRAINT {name} {definition}" for owner, name, definition in unique_first),
        *(f"ALTER TABLE {name} ENABLE TRIGGER USER" for name in names),
    ]


def _drop_sqlite(connection: Connection, tables: tuple[CopiedTable, ...]) -> list[str]:
    """Constraints are part of an SQLite table; that foreign keys sleep is the connection's doing."""
    quote = connection.dialect.identifier_preparer.quote
    names = {table.name for table in tables}
    stored = text(
        "SELECT type, tbl_name, name, sql FROM sqlite_master"
        " WHERE type IN ('index', 'trigger') AND sql IS NOT NULL ORDER BY type, rowid"
    )
    found = [each for each in connection.execute(stored).all() if each.tbl_name in names]
    for each in found:
        connection.execute(text(f"DROP {each.type.upper()} {quote(each.name)}"))
    return [each.sql for each in found]


def _check_foreign_keys(connection: Connection) -> None:
    broken = connection.execute(text("PRAGMA foreign_key_check")).first()
    if broken is not None:
        raise InvalidInput(
            f"a row names one of {broken[2]} that isn't there",
            where=f"{broken[0]}, row {broken[1]}",
            hint="the source isn't whole",
        )
