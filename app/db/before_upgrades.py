"""Saving a database as it is before its tables are brought to a newer form."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import datetime
from pathlib import Path

from app.db.copying.copy import copy_rows
from app.db.session import Database
from app.db.sqlite_files import copy_file, filled_file

logger = logging.getLogger(__name__)


@contextmanager
def saved_before_upgrade(database: Database, revision: str, folder: Path, now: datetime) -> Iterator[Path]:
    """Save all rows into an SQLite file ``before-REVISION-TIME.sqlite3``, whatever kind the database is of.

    An older version opens it as it is; ``clearlines restore`` brings it into either kind of database. Where the block
    fails, which changes nothing, the file goes again: a server that is started over and over would fill the disk.

    Args:
        database: The database.
        revision: Form of its tables.
        folder: Where the file goes; made if missing.
        now: When.

    Yields:
        The file.

    Raises:
        OSError: When the folder can't be made or written to.
        Unavailable: When a database can't answer, or the disk is full.
    """
    folder.mkdir(parents=True, exist_ok=True, mode=0o700)
    path = folder / f"before-{revision}-{now:%Y%m%dT%H%M%SZ}.sqlite3"
    logger.warning("the tables are brought from revision %s to a newer one; first they are saved in %s", revision, path)
    if database.is_sqlite:
        copy_file(Path(str(database.engine.url.database)), path)
    else:
        with filled_file(path) as target:
            copy_rows(database, target)
    try:
        yield path
    except BaseException:
        path.unlink(missing_ok=True)
        raise
