"""Single SQLite files that appear whole or not at all: what a database is saved into."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path

from sqlalchemy import URL, create_engine, event

from app.db.copying.targets import Target, filling
from app.db.session import Database, begin_sqlite, open_database
from app.errors import Conflict, NotFound, Unavailable


@contextmanager
def filled_file(path: Path) -> Iterator[Target]:
    """Give a new SQLite database to fill; it comes to its place when the block has ended well."""
    temporary = path.with_name(f".{path.name}.tmp")
    _remove(temporary)
    database = open_database(URL.create("sqlite", database=str(temporary)))
    try:
        with filling(database) as target:
            yield target
        database.close()
        _settle(temporary)
        temporary.replace(path)
    finally:
        database.close()
        _remove(temporary)


def open_saved(path: Path) -> Database:
    """Open an SQLite file to read it, as a backup: neither it nor anything beside it is changed.

    Raises:
        NotFound: When there is no such file.
        Conflict: When others may be writing to it.
    """
    if not path.is_file():
        raise NotFound("there is no such file", where=str(path))
    log = path.with_name(f"{path.name}-wal")
    if log.is_file() and log.stat().st_size:
        raise Conflict(
            "part of the database still lies in its write-ahead log",
            where=str(log),
            hint="this is no backup but a database in use: clearlines migrate copies it",
        )
    address = f"{path.absolute().as_uri()}?mode=ro&immutable=1"

    def connect() -> sqlite3.Connection:
        return sqlite3.connect(address, uri=True, isolation_level=None, check_same_thread=False)

    engine = create_engine(URL.create("sqlite", database=str(path)), creator=connect)
    event.listen(engine, "begin", begin_sqlite)
    return Database(engine)


def copy_file(source: Path, path: Path) -> None:
    """Copy an SQLite database as it is at one moment, while others write to it.

    Raises:
        OSError: When the file can't be made.
        Unavailable: When there is no room, or the database can't be read.
    """
    temporary = path.with_name(f".{path.name}.tmp")
    _remove(temporary)
    try:
        with closing(sqlite3.connect(source)) as original, closing(sqlite3.connect(temporary)) as copy:
            original.backup(copy)
        _settle(temporary)
        temporary.replace(path)
    except sqlite3.Error as error:
        raise Unavailable(f"the database can't be saved: {error}", where=str(path)) from error
    finally:
        _remove(temporary)


def _settle(path: Path) -> None:
    """Let everything lie in the one file, none of it in a write-ahead log beside it."""
    with closing(sqlite3.connect(path)) as connection:
        connection.execute("PRAGMA synchronous = FULL")
        connection.execute("PRAGMA journal_mode = DELETE")


def _remove(temporary: Path) -> None:
    for ending in ("", "-wal", "-shm", ".copy", ".dispatcher"):
        temporary.with_name(temporary.name + ending).unlink(missing_ok=True)
