"""``clearlines restore``: an installation from a backup."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path

from app.commands.backup_manifest import BLOBS, DATABASE, read_manifest, require_as_listed
from app.commands.moved_installations import MovedInstallation, opened_database
from app.commands.progress import NamedProgressCallback
from app.db.copying.copy import copy_rows
from app.db.copying.targets import filling
from app.db.session import Database, upgrade
from app.db.sqlite_files import open_saved
from app.services.blob_copying import CopiedBlobs, copy_blobs, named_blobs
from app.settings import Settings
from app.storage import LocalBlobs, open_blobs


def restore(
    settings: Settings,
    backup: Path,
    *,
    to: str | None = None,
    as_saved: bool = False,
    progress: NamedProgressCallback,
) -> MovedInstallation:
    """Bring a backup into an empty database, and its files into the store of the settings.

    Args:
        settings: Say where the installation is to be.
        backup: The folder that ``clearlines backup`` made, or the file that was saved before an upgrade.
        to: Address of the database; that of the settings without.
        as_saved: Leave the tables in the form that they were saved in, for the version that they are of.
        progress: Called with what is copied, how much of it is done, and how much it is.

    Raises:
        NotFound: When there is no such backup.
        InvalidFile: When it isn't what its manifest says.
        ClearLinesError: As `app.db.copying.targets.filling`, `app.db.copying.copy.copy_rows` and
            `app.services.blob_copying.copy_blobs`. The database is refused by ``clearlines serve`` then, and the same
            command begins again.
    """
    manifest = None if backup.is_file() else read_manifest(backup)
    with (
        closing(open_saved(backup if manifest is None else backup / DATABASE)) as saved,
        opened_database(to or settings.database_address) as database,
    ):
        with filling(database) as target:
            rows = copy_rows(saved, target, report=progress)
            if manifest is not None:
                require_as_listed(manifest, rows)
            files = None if manifest is None else _copy_files(saved, backup, settings, progress)
        if not as_saved:
            upgrade(database)
    return MovedInstallation(rows, files)


def _copy_files(saved: Database, backup: Path, settings: Settings, progress: NamedProgressCallback) -> CopiedBlobs:
    with closing(open_blobs(settings)) as target:
        return copy_blobs(
            named_blobs(saved),
            LocalBlobs(backup / BLOBS),
            target,
            report=lambda done, total: progress("files", done, total),
        )
