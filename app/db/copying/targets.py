"""The database that is copied into: empty before, and marked as unfinished until everything is there."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from sqlalchemy import Connection, inspect, text

from app.db.copying.reading import count_rows
from app.db.copying.tables import tables_of
from app.db.locks import held
from app.db.migrations import VERSION_TABLE
from app.db.models import Base, Installation
from app.db.session import Database
from app.db.unfinished import UNFINISHED, is_unfinished
from app.errors import Conflict

CALLED = """
SELECT DISTINCT pg_trigger.tgfoid::regprocedure::text FROM pg_trigger
JOIN pg_proc ON pg_proc.oid = pg_trigger.tgfoid
WHERE NOT tgisinternal AND pronamespace = current_schema()::regnamespace
  AND tgrelid IN (SELECT to_regclass(name) FROM unnest(CAST(:names AS text[])) AS name)
"""


@dataclass(frozen=True)
class Target:
    """A database that is being filled.

    Attributes:
        database: The database.
        whole: On PostgreSQL the transaction in which all its rows come.
    """

    database: Database
    whole: Connection | None = None

    @property
    def is_sqlite(self) -> bool:
        """Whether the rows come to lie in one SQLite file."""
        return self.database.is_sqlite

    @contextmanager
    def transaction(self) -> Iterator[Connection]:
        """Give a connection to write through, with foreign keys asleep on SQLite.

        There each is a transaction of its own: a single one would hold all rows twice, in the file and in its log.
        """
        if self.whole is not None:
            yield self.whole
            return
        engine = self.database.engine.execution_options(sqlite_begin="IMMEDIATE", sqlite_foreign_keys="OFF")
        with engine.begin() as connection:
            yield connection

    @contextmanager
    def in_one(self) -> Iterator[Target]:
        """Give the target to write rows to: on PostgreSQL all of them in one transaction, or none."""
        if self.is_sqlite:
            yield self
            return
        with self.database.engine.begin() as connection:
            yield Target(self.database, connection)


@contextmanager
def filling(database: Database) -> Iterator[Target]:
    """Mark an empty database as unfinished while the block fills it; the mark goes when the block has ended well.

    What an earlier one left unfinished is taken for empty, and cleared.

    Raises:
        Conflict: When there is something in it, or another process fills it or works with it now.
    """
    with held(database, "copy") as ours, held(database, "dispatcher") as unserved:
        if not ours:
            raise Conflict("another process fills this database now", where=_where(database), hint="wait for its end")
        if not unserved:
            raise Conflict("a server works with this database", where=_where(database), hint="stop it first")
        target = Target(database)
        with target.transaction() as connection:
            if not is_unfinished(connection):
                _require_empty(connection, _where(database))
                connection.execute(text(f"CREATE TABLE {UNFINISHED} (reason TEXT)"))
        with target.transaction() as connection:
            _clear(connection)
        yield target
        with target.transaction() as connection:
            connection.execute(text(f"DROP TABLE {UNFINISHED}"))


def _require_empty(connection: Connection, where: str) -> None:
    """A database that was only just made has its tables, and one row that says which it is."""
    if not inspect(connection).has_table(VERSION_TABLE):
        return
    ours = (table for table in tables_of(connection) if table.name in Base.metadata.tables)
    rows = {table.name: count_rows(connection, table) for table in ours}
    filled = [name for name, count in rows.items() if count and name != Installation.__tablename__]
    if filled:
        raise Conflict(
            f"the database isn't empty: it has {rows[filled[0]]:,} rows in {filled[0]}",
            where=where,
            expected="a database without tables, or one that was only just made",
            hint="what is there is never overwritten: give another address, or remove it yourself",
        )


def _clear(connection: Connection) -> None:
    """Drop our tables, none of which has a row to keep, and what their triggers call; other programs' tables stay."""
    ours = [name for name in (*Base.metadata.tables, VERSION_TABLE) if inspect(connection).has_table(name)]
    quote = connection.dialect.identifier_preparer.quote
    postgres = connection.dialect.name == "postgresql"
    called = connection.scalars(text(CALLED), {"names": [quote(name) for name in ours]}).all() if postgres else []
    for name in ours:
        connection.execute(text(f"DROP TABLE {quote(name)}{' CASCADE' if postgres else ''}"))
    for function in called:
        connection.execute(text(f"DROP FUNCTION {function}"))


def _where(database: Database) -> str:
    return database.engine.url.render_as_string(hide_password=True)
