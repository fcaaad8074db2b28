"""The database and the files of a data folder, opened for one command."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from app.clock import utc_now
from app.db.session import Database, open_database, upgrade
from app.settings import Settings
from app.storage import BlobStore, open_blobs


@contextmanager
def opened_stores(settings: Settings) -> Iterator[tuple[Database, BlobStore]]:
    """Open both, with the tables in this version's form; both are closed at the end.

    Older tables are saved into the folder of backups before they are changed.

    Raises:
        InvalidInput: When the address of the database or of the files can't be read.
        Unavailable: When one of them can't be reached, or isn't one.
        OSError: When the folder can't be made or written to.
    """
    database = open_database(settings.database_address)
    try:
        upgrade(database, backups=settings.backups, now=utc_now())
        blobs = open_blobs(settings)
        try:
            yield database, blobs
        finally:
            blobs.close()
    finally:
        database.close()
