"""The database as whoever looks after the server sees it: its kind, its size, the form of its tables."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from sqlalchemy import text
from sqlalchemy.orm import Session

from app.db.migrations import stored_revision
from app.db.session import Database


@dataclass(frozen=True)
class DatabaseStatus:
    """A database.

    Attributes:
        kind: ``SQLite`` or ``PostgreSQL``.
        version: Of its program.
        address: Where it is; without the password.
        bytes: How large it is.
        revision: Form of its tables, by the name of the last migration.
        connections: How many this server has open to it.
        connections_used: How many of these are at work now.
    """

    kind: str
    version: str
    address: str
    bytes: int
    revision: str | None
    connections: int
    connections_used: int


def database_status(database: Database, session: Session) -> DatabaseStatus:
    """Return how a database is.

    Args:
        database: The database.
        session: A reading session of it.
    """
    connections, used = connection_counts(database)
    if database.is_sqlite:
        version = session.scalar(text("SELECT sqlite_version()"))
        size = _file_bytes(Path(str(database.engine.url.database)))
    else:
        version = session.scalar(text("SHOW server_version"))
        size = session.scalar(text("SELECT pg_database_size(current_database())")) or 0
    return DatabaseStatus(
        "SQLite" if database.is_sqlite else "PostgreSQL",
        str(version),
        database.engine.url.set(query={}).render_as_string(hide_password=True),
        size,
        stored_revision(session.connection()),
        connections,
        used,
    )


def connection_counts(database: Database) -> tuple[int, int]:
    """Return how many connections this server has open to a database, and how many of them are at work."""
    pool = database.engine.pool
    used: int = pool.checkedout()  # pyright: ignore[reportAttributeAccessIssue]
    idle: int = pool.checkedin()  # pyright: ignore[reportAttributeAccessIssue]
    return used + idle, used


def _file_bytes(path: Path) -> int:
    files = (path, path.with_name(f"{path.name}-wal"))
    return sum(file.stat().st_size for file in files if file.is_file())
