"""Locks that one process holds, of all that use one database; each ends with its process, however that ends."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Literal, Protocol

from sqlalchemy import Connection, Engine, text
from sqlalchemy.exc import SQLAlchemyError

from app.db.session import Database

Purpose = Literal["dispatcher", "copy", "blobs"]

# any numbers that no other program locks in the same database; that of the migrations comes before them
ADVISORY_LOCKS: dict[Purpose, int] = {"dispatcher": 7_316_540_022, "copy": 7_316_540_023, "blobs": 7_316_540_024}


class Lock(Protocol):
    """A lock that one process holds."""

    def acquire(self) -> bool:
        """Take the lock, or see whether it is still held; False when another one has it. Never waits."""
        ...

    def release(self) -> None:
        """Let another one have it."""
        ...


def lock_for(database: Database, purpose: Purpose) -> Lock:
    """Return a lock of a database; nothing is locked yet."""
    if database.is_sqlite:
        return FileLock(lock_file(database.engine, purpose))
    return AdvisoryLock(database.engine, ADVISORY_LOCKS[purpose])


def lock_file(engine: Engine, purpose: Purpose) -> Path:
    """Return where the lock of an SQLite database lies."""
    return Path(f"{engine.url.database}.{purpose}")


@contextmanager
def held(database: Database, purpose: Purpose) -> Iterator[bool]:
    """Hold a lock while the block runs, and tell it whether it does."""
    lock = lock_for(database, purpose)
    try:
        yield lock.acquire()
    finally:
        lock.release()


class FileLock:
    """A lock beside an SQLite file: SQLite's own file locks, which work on every system that SQLite does."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._connection: sqlite3.Connection | None = None

    def acquire(self) -> bool:
        """See ``Lock``."""
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
        """See ``Lock``."""
        if self._connection is not None:
            self._connection.close()
            self._connection = None


class AdvisoryLock:
    """A lock in PostgreSQL that its connection holds."""

    def __init__(self, engine: Engine, key: int) -> None:
        self._engine = engine
        self._key = key
        self._connection: Connection | None = None

    def acquire(self) -> bool:
        """See ``Lock``."""
        if self._connection is not None:
            if self._still_there(self._connection):
                return True
            self.release()
        connection = self._engine.connect().execution_options(isolation_level="AUTOCOMMIT")
        try:
            taken = connection.scalar(text("SELECT pg_try_advisory_lock(:key)"), {"key": self._key})
        except SQLAlchemyError:
            _close(connection)
            raise
        if not taken:
            connection.close()
            return False
        self._connection = connection
        return True

    def release(self) -> None:
        """See ``Lock``."""
        if self._connection is not None:
            with suppress(SQLAlchemyError):
                self._connection.execute(text("SELECT pg_advisory_unlock(:key)"), {"key": self._key})
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
