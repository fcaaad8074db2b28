"""The database and the files of a data folder, opened for one command."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from app.db.session import Database, open_database, upgrade
from app.settings import Settings
from app.storage import BlobStore


@contextmanager
def opened_stores(settings: Settings) -> Iterator[tuple[Database, BlobStore]]:
    """Open both, with the tables in this version's form; the database is closed at the end.

    Raises:
        InvalidInput: When the database's address can't be read.
        Unavailable: When the database can't be reached, or isn't one.
        OSError: When the folder can't be made or written to.
    """
    database = open_database(settings.database_address)
    try:
        upgrade(database)
        yield database, BlobStore(settings.blob_dir)
    finally:
        database.close()
