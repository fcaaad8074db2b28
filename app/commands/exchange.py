"""``clearlines import`` and ``clearlines export``: datasets between folders and the database, without a server."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

from app.clock import utc_now
from app.commands.stores import opened_stores
from app.formats.members import fill_folder
from app.services.exporting import ExportChoice, export_members
from app.services.import_limits import import_limits
from app.services.imports import FolderImport, import_folder
from app.settings import Settings


def import_images(
    settings: Settings, folder: Path, name: str, *, progress: Callable[[int, int], None] | None = None
) -> FolderImport:
    """Import a dataset folder, or any folder of images, into the dataset of that name, which is made if new.

    Args:
        settings: Say where the database and the blobs are.
        folder: ``images/``, ``labels/``, ``images.csv`` and ``cameras.json``, or images alone.
        name: Of the dataset.
        progress: Called with the images done and their total.

    Raises:
        ClearLinesError: As `app.services.imports.import_folder`.
    """

    def report(done: int, total: int, _name: str) -> None:
        if progress is not None:
            progress(done, total)

    with opened_stores(settings) as (database, blobs):
        return import_folder(
            database,
            blobs,
            folder,
            name,
            utc_now(),
            limits=import_limits(settings),
            person=settings.person,
            progress=report,
        )


def export_labels(
    settings: Settings, slug: str, output: Path, choice: ExportChoice, *, on_file: Callable[[int], None] | None = None
) -> list[Path]:
    """Write an export into a folder, which is made if missing; files there are replaced.

    Args:
        settings: Say where the database and the blobs are.
        slug: Of the dataset.
        output: The folder.
        choice: What to export, and how.
        on_file: Called with the number of files written so far.

    Returns:
        The files written.

    Raises:
        ClearLinesError: As `app.services.exporting.export_members`.
    """
    with opened_stores(settings) as (database, blobs), database.read() as session:
        members = export_members(session, blobs, slug, choice)
        return fill_folder(_counted(members, on_file), output)


def _counted(
    members: Iterator[tuple[str, bytes]], on_file: Callable[[int], None] | None
) -> Iterator[tuple[str, bytes]]:
    for number, member in enumerate(members, start=1):
        yield member
        if on_file is not None:
            on_file(number)
