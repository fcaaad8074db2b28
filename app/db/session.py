"""Opening the database, and sessions that read or write.

SQLite: many readers beside one writer (WAL). A writing session begins with ``BEGIN IMMEDIATE``: it waits for its turn
*before* it reads, so what it read is still true when it writes. With the default, deferred BEGIN, a session that reads
first and writes later fails at once with "database is locked" when another one wrote in between: no timeout helps.

PostgreSQL: a reading session sees one snapshot of the data, as on SQLite. Writers run side by side; those that read
before they write lock the rows they decide on with ``with_for_update()``, which SQLite needs not and ignores.
"""

from __future__ import annotations

import sqlite3
import time
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from threading import Lock
from typing import Any

from sqlalchemy import URL, Connection, Engine, create_engine, event, make_url
from sqlalchemy.exc import ArgumentError, DBAPIError, IntegrityError, OperationalError
from sqlalchemy.orm import Session

from app.errors import Conflict, InvalidInput, NoRoom, Unavailable

BUSY_TIMEOUT = 30.0  # s
POOL_SIZE = 20
POOL_OVERFLOW = 30
UNIQUE_VIOLATION = "23505"  # SQLSTATE
DISK_FULL = frozenset({"SQLITE_FULL", "53100"})  # SQLite's name; SQLSTATE


@dataclass(frozen=True)
class Database:
    """A database that services read and write through.

    Attributes:
        engine: The pool of connections.
        writers: Whom SQLite lets write: one at a time. Those of this process wait for each other here. SQLite would
            have them ask again and again, with pauses that grow, and some would wait for seconds while others come.
    """

    engine: Engine
    writers: Lock = field(default_factory=Lock, repr=False, compare=False)

    @property
    def is_sqlite(self) -> bool:
        """Whether the rows lie in one SQLite file."""
        return self.engine.dialect.name == "sqlite"

    @contextmanager
    def read(self) -> Iterator[Session]:
        """Give a session that sees one snapshot and can't write (the database itself refuses).

        Raises:
            Unavailable: When the database is out of reach.
        """
        try:
            with Session(self._engine_for_reading(), expire_on_commit=False, autoflush=False) as session:
                yield session
        except DBAPIError as error:
            raise _as_told(error) from error

    @contextmanager
    def write(self) -> Iterator[Session]:
        """Give a writing session: committed at the end, rolled back on an error.

        Raises:
            Conflict: When someone else stored the same name or content at the same moment.
            NoRoom: When its disk is full.
            Unavailable: When the database is locked, out of reach, or chose this session to break a deadlock.
        """
        engine = self.engine.execution_options(sqlite_begin="IMMEDIATE") if self.is_sqlite else self.engine
        try:
            with self._turn(), Session(engine, expire_on_commit=False) as session, session.begin():
                yield session
        except DBAPIError as error:
            raise _as_told(error) from error

    @contextmanager
    def _turn(self) -> Iterator[None]:
        if not self.is_sqlite:
            yield
            return
        if not self.writers.acquire(timeout=BUSY_TIMEOUT):
            raise Unavailable("the database can't answer: it is being written to", hint="try again in a moment")
        try:
            yield
        finally:
            self.writers.release()

    def close(self) -> None:
        """Close all connections; the database can be used again afterwards."""
        self.engine.dispose()

    def _engine_for_reading(self) -> Engine:
        if self.is_sqlite:
            return self.engine
        return self.engine.execution_options(isolation_level="REPEATABLE READ", postgresql_readonly=True)


def open_database(url: str | URL, *, busy_timeout: float = BUSY_TIMEOUT) -> Database:
    """Open a database; nothing is created or changed before ``upgrade``.

    Args:
        url: ``sqlite:///path/to/file.sqlite3`` or ``postgresql://user@host/name`` (psycopg 3 is used).
        busy_timeout: How long a writer waits for its turn on SQLite, in s.

    Raises:
        InvalidInput: When the address can't be read, or names another kind of database.
    """
    address = checked_address(url)
    options: dict[str, Any] = {"pool_size": POOL_SIZE, "max_overflow": POOL_OVERFLOW}
    if address.get_backend_name() == "sqlite":
        Path(str(address.database)).parent.mkdir(parents=True, exist_ok=True, mode=0o700)  # it holds password hashes
        engine = create_engine(address, connect_args={"timeout": busy_timeout}, **options)
        event.listen(engine, "connect", _prepare_sqlite)
        event.listen(engine, "begin", begin_sqlite)
    else:
        try:
            engine = create_engine(address, pool_pre_ping=True, **options)
        except ModuleNotFoundError as error:
            raise InvalidInput("psycopg isn't installed", hint="pip install 'clearlines[postgres]'") from error
    return Database(engine)


def upgrade(database: Database, *, backups: Path | None = None, now: datetime | None = None) -> None:
    """Bring the tables to this version's form; safe to call at each start, also by several processes at once.

    Args:
        database: The database.
        backups: Folder into which a database of an older form is saved before it is changed; none is saved without.
        now: When that is; needed with ``backups``.

    Raises:
        Unavailable: When the database is locked, out of reach, not whole yet, or may not be written.
    """
    # Alembic takes long to import, and most of the code never needs it
    from alembic.util import CommandError

    from app.db.before_upgrades import saved_before_upgrade
    from app.db.migrations import run_upgrade
    from app.db.unfinished import require_finished

    def saved(revision: str) -> AbstractContextManager[object]:
        if backups is None or now is None:
            return nullcontext()
        return saved_before_upgrade(database, revision, backups, now)

    try:
        with database.read() as session:
            require_finished(session.connection())
        run_upgrade(database.engine, saved=saved)
    except CommandError as error:
        raise Unavailable(
            f"the tables can't be brought to this version's form: {error}",
            hint="a newer version of ClearLines made them; use that one, or another data folder",
        ) from error
    except DBAPIError as error:
        raise _as_told(error) from error


def checked_address(url: str | URL) -> URL:
    """Return the address of a database, with the driver that is used for it.

    Raises:
        InvalidInput: When it can't be read, or names another kind of database.
    """
    kinds = "sqlite:///FILE or postgresql://USER@HOST/NAME"
    try:
        address = make_url(url)
        backend = address.get_backend_name()
    except ArgumentError as error:
        raise InvalidInput("the database's address can't be read", where="database_url", expected=kinds) from error
    if backend == "postgresql":
        return address.set(drivername="postgresql+psycopg")
    if backend != "sqlite":
        raise InvalidInput(f"databases of the kind {backend} aren't supported", where="database_url", expected=kinds)
    if address.database in (None, "", ":memory:"):
        raise InvalidInput(
            "a database in memory would differ from one connection to the next",
            where="database_url",
            expected=kinds,
        )
    return address


def _prepare_sqlite(connection: Any, _record: object) -> None:
    # sqlite3 would otherwise begin transactions by itself, and never IMMEDIATE
    connection.isolation_level = None
    cursor = connection.cursor()
    _switch_to_wal(cursor)
    cursor.execute("PRAGMA synchronous = NORMAL")
    cursor.close()


def _switch_to_wal(cursor: sqlite3.Cursor) -> None:
    """Switch the file to WAL, which stays so; of several that switch a new file at once SQLite lets some fail."""
    for pause in (0.01, 0.03, 0.1, 0.3, 1.0, 0.0):
        try:
            cursor.execute("PRAGMA journal_mode = WAL")
        except sqlite3.OperationalError:
            if not pause:
                raise
            time.sleep(pause)
        else:
            return


def begin_sqlite(connection: Connection) -> None:
    """Begin a transaction, as the connection's options say: to read, unless they say how to write."""
    options = connection.get_execution_options()
    mode = options.get("sqlite_begin")
    connection.exec_driver_sql(f"PRAGMA query_only = {'OFF' if mode else 'ON'}")
    connection.exec_driver_sql(f"PRAGMA foreign_keys = {options.get('sqlite_foreign_keys', 'ON')}")
    connection.exec_driver_sql(f"BEGIN {mode}" if mode else "BEGIN DEFERRED")


def _as_told(error: DBAPIError) -> Exception:
    """Return the error to raise: ours where a person can do something about it, else the database's own."""
    cause: Any = error.orig
    state = getattr(cause, "sqlstate", None) or getattr(cause, "sqlite_errorname", None) or ""
    if isinstance(error, IntegrityError) and state in (
        UNIQUE_VIOLATION,
        "SQLITE_CONSTRAINT_UNIQUE",
        "SQLITE_CONSTRAINT_PRIMARYKEY",
    ):
        return Conflict("someone else stored the same thing at the same moment", hint="reload and try again")
    if state == "SQLITE_NOTADB":
        return InvalidInput("the file is no SQLite database", where="database_url", hint="is it the right file?")
    if state in DISK_FULL:
        return NoRoom(
            "there is no room left for the database; nothing was changed", hint="make room on its disk, then try again"
        )
    if isinstance(error, OperationalError):
        return Unavailable(f"the database can't answer: {cause}", hint="try again in a moment")
    return error
