"""The ids that a database has given away: none is ever given again, not even one whose row is gone."""

from __future__ import annotations

from sqlalchemy import Connection, func, literal_column, select, text

from app.db.copying.tables import CopiedTable


def largest_given(connection: Connection, table: CopiedTable) -> int:
    """Return the largest id that a table has ever given away, 0 if none."""
    column = table.numbering
    if column is None:
        return 0
    stored = connection.execute(select(func.max(table.clause.c[column]))).scalar() or 0
    sqlite = connection.dialect.name == "sqlite"
    return max(stored, _of_sqlite(connection, table) if sqlite else _of_postgres(connection, table, column))


def go_on_after(connection: Connection, table: CopiedTable, largest: int) -> None:
    """Let a table number its next row after an id; on SQLite only those can be told that never use one again."""
    column = table.numbering
    if column is None or not largest:
        return
    if connection.dialect.name == "sqlite":
        if _counts(connection, table):
            name = {"name": table.name, "largest": largest}
            connection.execute(text("DELETE FROM sqlite_sequence WHERE name = :name"), name)
            connection.execute(text("INSERT INTO sqlite_sequence (name, seq) VALUES (:name, :largest)"), name)
        return
    sequence = _sequence(connection, table, column)
    if sequence is not None:
        connection.execute(text("SELECT setval(:sequence, :largest)"), {"sequence": sequence, "largest": largest})


def _of_sqlite(connection: Connection, table: CopiedTable) -> int:
    if not _counts(connection, table):
        return 0
    given = connection.execute(text("SELECT seq FROM sqlite_sequence WHERE name = :name"), {"name": table.name})
    return given.scalar() or 0


def _counts(connection: Connection, table: CopiedTable) -> bool:
    made_by = text("SELECT sql FROM sqlite_master WHERE type = 'table' AND name = :name")
    return "AUTOINCREMENT" in connection.execute(made_by, {"name": table.name}).scalar_one().upper()


def _of_postgres(connection: Connection, table: CopiedTable, column: str) -> int:
    sequence = _sequence(connection, table, column)
    if sequence is None:
        return 0
    last, called = connection.execute(
        select(literal_column("last_value"), literal_column("is_called")).select_from(text(sequence))
    ).one()
    return last if called else 0


def _sequence(connection: Connection, table: CopiedTable, column: str) -> str | None:
    quote = connection.dialect.identifier_preparer.quote
    named = {"table": quote(table.name), "column": column}
    return connection.execute(text("SELECT pg_get_serial_sequence(:table, :column)"), named).scalar()
