"""Holding off whoever removes blobs while they are copied: rows of a snapshot name files that must still be there.

A purge that meets the hold leaves files and their rows for the next one. The hold ends with its process.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager

from sqlalchemy import text
from sqlalchemy.orm import Session

from app.db.locks import ADVISORY_LOCKS, FileLock, lock_file, lock_for
from app.db.session import Database
from app.errors import Conflict

PATIENCE = 60.0  # s; as long as a purge may take for one batch
PAUSE = 0.05  # s


@contextmanager
def blobs_kept(database: Database, *, patience: float = PATIENCE) -> Iterator[None]:
    """Keep all blobs while the block runs, which takes its snapshot of the rows inside.

    Args:
        database: Whose rows name the blobs.
        patience: How long to wait for another one to end, in s.

    Raises:
        Conflict: When another backup or migration of the database is at work.
    """
    lock = lock_for(database, "blobs")
    deadline = time.monotonic() + patience
    try:
        while not lock.acquire():
            if time.monotonic() > deadline:
                raise Conflict("another backup or migration of this database is at work", hint="wait for its end")
            time.sleep(PAUSE)
        if database.is_sqlite:
            # whoever looked before the lock was taken removes files until its own transaction ends
            with database.write() as session:
                session.connection()
        yield
    finally:
        lock.release()


def blobs_may_go(session: Session) -> bool:
    """Whether blobs may be removed now, and until the end of a writing session's transaction."""
    engine = session.connection().engine  # from here on, SQLite lets nobody else write
    if engine.dialect.name == "postgresql":
        # shared: several may remove at once, none while somebody holds it alone
        statement = text("SELECT pg_try_advisory_xact_lock_shared(:key)")
        return bool(session.scalar(statement, {"key": ADVISORY_LOCKS["blobs"]}))
    lock = FileLock(lock_file(engine, "blobs"))
    free = lock.acquire()
    lock.release()
    return free
