"""The commands that move a whole installation: ``migrate``, ``backup`` and ``restore``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from app.cli.options import DataDir, settings_from
from app.cli.terminal import terminal
from app.commands.paths import require_there
from app.commands.progress import progress_bars

if TYPE_CHECKING:
    from app.commands.moved_installations import MovedInstallation


def migrate(
    to: Annotated[str, typer.Option(metavar="URL", help="sqlite:///FILE or postgresql://USER@HOST/NAME; empty.")],
    blobs_to: Annotated[
        str | None, typer.Option(metavar="URL", help="Folder or address for the uploaded files, which else stay.")
    ] = None,
    data: DataDir = None,
) -> None:
    """Copy the installation into another database, table by table, and compare both."""
    settings = settings_from(data_dir=data)
    from app.commands.migrate import migrate as migrate_installation
    from app.commands.moved_installations import shown_address

    with progress_bars() as report:
        moved = migrate_installation(settings, to, blobs_to=blobs_to, progress=report)
    terminal.print(f"{moved.told} are in {shown_address(to)}, compared and equal", markup=False)
    terminal.print("CLEARLINES_DATABASE_URL says which database is served; the old one is as it was", markup=False)
    _tell_missing(moved)


def backup(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="A new folder: backups/2025-06-01.")],
    data: DataDir = None,
) -> None:
    """Save the installation, also while it is served: the rows of one moment and the files that they name."""
    settings = settings_from(data_dir=data)
    from app.clock import utc_now
    from app.commands.backup import back_up

    with progress_bars() as report:
        moved = back_up(settings, folder, utc_now(), progress=report)
    terminal.print(f"{moved.told} are in {folder}", markup=False)
    _tell_missing(moved)


def restore(
    backup: Annotated[
        Path, typer.Argument(metavar="DIR", help="From clearlines backup; or the file saved before an upgrade.")
    ],
    to: Annotated[
        str | None, typer.Option(metavar="URL", help="Database to restore into, empty; else that of the settings.")
    ] = None,
    as_saved: Annotated[
        bool, typer.Option("--as-saved", help="Leave old tables as they are, for the version that they are of.")
    ] = False,
    data: DataDir = None,
) -> None:
    """Bring a backup into an empty installation, and compare it with its list."""
    require_there([backup])
    settings = settings_from(data_dir=data)
    from app.commands.moved_installations import shown_address
    from app.commands.restore import restore as restore_installation

    with progress_bars() as report:
        moved = restore_installation(settings, backup, to=to, as_saved=as_saved, progress=report)
    where = shown_address(to or settings.database_address)
    terminal.print(f"{moved.told} are in {where}, compared and equal", markup=False)
    _tell_missing(moved)


def _tell_missing(moved: MovedInstallation) -> None:
    """Say which files weren't there to copy, and end with the status of what failed in part."""
    missing = () if moved.blobs is None else moved.blobs.missing
    if missing:
        terminal.print(f"{len(missing)} files that rows name are missing at the source: {', '.join(missing[:5])}")
        raise typer.Exit(1)
