"""``clearlines migrate``: a whole installation into another database, and its files into another store."""

from __future__ import annotations

from contextlib import closing

from app.commands.moved_installations import (
    MovedInstallation,
    opened_database,
    opened_source,
    require_another,
)
from app.commands.progress import NamedProgressCallback
from app.db.copying.copy import copy_rows
from app.db.copying.targets import filling
from app.db.session import Database, upgrade
from app.services.blob_copying import CopiedBlobs, copy_blobs, named_blobs
from app.services.blob_keeping import blobs_kept
from app.settings import Settings
from app.storage import open_blobs, open_blobs_at


def migrate(
    settings: Settings, to: str, *, blobs_to: str | None = None, progress: NamedProgressCallback
) -> MovedInstallation:
    """Copy the installation of the settings; it stays as it is, and may be at work meanwhile.

    Args:
        settings: Of the installation.
        to: The other database's address; it must be empty.
        blobs_to: Folder or address of the other store of files; they stay where they are without.
        progress: Called with what is copied, how much of it is done, and how much it is.

    Raises:
        ClearLinesError: As `app.db.copying.targets.filling`, `app.db.copying.copy.copy_rows` and
            `app.services.blob_copying.copy_blobs`. The other database is refused by ``clearlines serve`` then, and
            the same command begins again.
    """
    with (
        opened_source(settings.database_address) as source,
        opened_database(to) as target_database,
        blobs_kept(source),
    ):
        require_another(source, target_database)
        with filling(target_database) as target:
            rows = copy_rows(source, target, report=progress)
            files = None if blobs_to is None else _copy_files(settings, target_database, blobs_to, progress)
        upgrade(target_database)
    return MovedInstallation(rows, files)


def _copy_files(settings: Settings, database: Database, blobs_to: str, progress: NamedProgressCallback) -> CopiedBlobs:
    with (
        closing(open_blobs(settings)) as source,
        closing(open_blobs_at(blobs_to, settings.blob_options, folder=settings.data_dir)) as target,
    ):
        return copy_blobs(
            named_blobs(database), source, target, report=lambda done, total: progress("files", done, total)
        )
