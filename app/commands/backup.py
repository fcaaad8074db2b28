"""``clearlines backup``: a whole installation as a folder, taken while it is at work."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from contextlib import closing, contextmanager
from datetime import datetime
from pathlib import Path

from app.commands.backup_manifest import BLOBS, DATABASE, MANIFEST, manifest_of, read_manifest
from app.commands.moved_installations import MovedInstallation, opened_source
from app.commands.progress import NamedProgressCallback
from app.commands.whole_files import json_bytes
from app.db.copying.copy import copy_rows
from app.db.sqlite_files import filled_file, open_saved
from app.errors import ClearLinesError, Conflict
from app.services.blob_copying import copy_blobs, named_blobs
from app.services.blob_keeping import blobs_kept
from app.services.installation import instance_of
from app.settings import Settings
from app.storage import LocalBlobs, open_blobs


def back_up(settings: Settings, folder: Path, now: datetime, *, progress: NamedProgressCallback) -> MovedInstallation:
    """Save the rows of one moment and the files that they name; the server may be at work meanwhile.

    Files that lie on the same disk, in the installation or in the newest backup beside this one, are linked to: they
    take no room again.

    Args:
        settings: Of the installation.
        folder: Of the backup; made whole or not at all.
        now: When.
        progress: Called with what is copied, how much of it is done, and how much it is.

    Raises:
        Conflict: When the folder has something in it already.
        ClearLinesError: As `app.db.copying.copy.copy_rows` and `app.services.blob_copying.copy_blobs`.
        OSError: When the folder can't be made, or the disk is full.
    """
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise Conflict(
            "there is something already", where=str(folder), hint="each backup is a new folder: backups/2025-06-01"
        )
    earlier = _newest_beside(folder)
    with opened_source(settings.database_address) as source, blobs_kept(source), _new_folder(folder) as place:
        with filled_file(place / DATABASE) as target:
            rows = copy_rows(source, target, report=progress)
        with closing(open_saved(place / DATABASE)) as saved, closing(open_blobs(settings)) as blobs:
            files = copy_blobs(
                named_blobs(saved),
                blobs,
                LocalBlobs(place / BLOBS),
                link=True,
                earlier=None if earlier is None else LocalBlobs(earlier / BLOBS),
                report=lambda done, total: progress("files", done, total),
            )
            with saved.read() as session:
                manifest = manifest_of(rows, files, instance_of(session), now)
        (place / MANIFEST).write_bytes(json_bytes(manifest.model_dump(mode="json")))
    return MovedInstallation(rows, files)


@contextmanager
def _new_folder(folder: Path) -> Iterator[Path]:
    """Give a folder to fill, which comes to its place when the block has ended well."""
    temporary = folder.absolute().with_name(f".{folder.absolute().name}.unfinished")
    shutil.rmtree(temporary, ignore_errors=True)
    temporary.mkdir(parents=True, mode=0o700)  # it holds what only the installation's own account may read
    try:
        yield temporary
        if hasattr(os, "sync"):
            os.sync()  # links and folders too: what is called a backup outlives a power cut
        temporary.replace(folder)
    finally:
        shutil.rmtree(temporary, ignore_errors=True)


def _newest_beside(folder: Path) -> Path | None:
    parent = folder.absolute().parent
    found: list[tuple[datetime, Path]] = []
    for each in parent.iterdir() if parent.is_dir() else ():
        try:
            found.append((read_manifest(each).created_at, each))
        except ClearLinesError:
            continue
    return max(found)[1] if found else None
