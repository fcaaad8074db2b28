"""One dispatcher at a time for one database, whatever number of processes serve it.

The lock ends with the process that holds it, however that ends. So whoever gets it knows that all work which the rows
call running was left behind, and needs not wait for heartbeats to grow old.
"""

from __future__ import annotations

import sqlite3
from contextlib import suppress
from pathlib import Path
from typing import Protocol

from sqlalchemy import Connection, Engine, text
from sqlalchemy.exc import SQLAlchemyError

from app.db.session import Database

# any number that no other program locks in the same database
ADVISORY_LOCK = 7_316_540_022


class DispatcherLock(Protocol):
    """A lock that one process holds."""

    def acquire(self) -> bool:
        """Take the lock, or see whether it is still held; False when another one has it. Never waits."""
        ...

    def release(self) -> None:
        """Let another one have it."""
        ...


def lock_for(database: Database) -> DispatcherLock:
    """Return the lock of a database; nothing is locked yet."""
    if database.is_sqlite:
        return FileLock(Path(f"{database.engine.url.database}.dispatcher"))
    return AdvisoryLock(database.engine)


class FileLock:
    """A lock beside an SQLite file: SQLite's own file locks, which work on every system that SQLite does."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._connection: sqlite3.Connection | None = None

    def acquire(self) -> bool:
        """See ``DispatcherLock``."""
        if self._connection is not None:
            return True
        connection = sqlite3.connect(self._path, timeout=0, isolation_level=None, check_same_thread=False)
        try:
            connection.execute("BEGIN EXCLUSIVE")
        except sqlite3.OperationalError:
            connection.close()
            return False
        self._connection = connection
        return True

    def release(self) -> None:
        """See ``DispatcherLock``."""
        if self._connection is not None:
            self._connection.close()
            self._connection = None


class AdvisoryLock:
    """A lock in PostgreSQL that its connection holds."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self._connection: Connection | None = None

    def acquire(self) -> bool:
        """See ``DispatcherLock``."""
        if self._connection is not None:
            if self._still_there(self._connection):
                return True
            self.release()
        connection = self._engine.connect().execution_options(isolation_level="AUTOCOMMIT")
        try:
            taken = connection.scalar(text("SELECT pg_try_advisory_lock(:key)"), {"key": ADVISORY_LOCK})
        except SQLAlchemyError:
            _close(connection)
            raise
        if not taken:
            connection.close()
            return False
        self._connection = connection
        return True

    def release(self) -> None:
        """See ``DispatcherLock``."""
        if self._connection is not None:
            with suppress(SQLAlchemyError):
                self._connection.execute(text("SELECT pg_advisory_unlock(:key)"), {"key": ADVISORY_LOCK})
            _close(self._connection)
            self._connection = None

    def _still_there(self, connection: Connection) -> bool:
        try:
            connection.execute(text("SELECT 1"))
        except SQLAlchemyError:
            return False
        return True


def _close(connection: Connection) -> None:
    # for good, not given back to the pool: should it still hold the lock, the lock goes with it
    with suppress(SQLAlchemyError):
        connection.detach()
    connection.close()
