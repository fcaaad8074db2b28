"""The commands that bring labels into the database and out of it: ``import`` and ``export``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from app.cli.options import DataDir, settings_from
from app.cli.terminal import terminal
from app.commands.paths import require_folder_possible, require_there
from app.commands.progress import progress_bar


def import_(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="A ClearLines dataset, or a folder of images.")],
    dataset: Annotated[str, typer.Option(help="Name of the dataset, made if new.")],
    data: DataDir = None,
) -> None:
    """Bring a dataset's images and labels into the database."""
    require_there([folder])
    from app.commands.exchange import import_images
    from app.commands.reports import print_import

    with progress_bar("Importing") as report:
        result = import_images(settings_from(data_dir=data), folder, dataset, progress=report)
    print_import(result, terminal)
    if result.report.failed:
        raise typer.Exit(1)


def export(
    dataset: Annotated[str, typer.Argument(metavar="DATASET", help="Its slug, as in its address.")],
    output: Annotated[Path, typer.Option(help="Folder for the export, made if missing.")],
    format: Annotated[  # noqa: A002
        str, typer.Option(help="clearlines, npz, json, coco, cvat, datumaro, labelme, geojson or csv.")
    ] = "clearlines",
    no_images: Annotated[bool, typer.Option("--no-images", help="Labels only.")] = False,
    allow_not_done: Annotated[
        bool, typer.Option("--allow-not-done", help="Take images that nobody has finished too.")
    ] = False,
    data: DataDir = None,
) -> None:
    """Write a dataset's labels, for ClearLines or for another tool."""
    require_folder_possible(output)
    from app.commands.exchange import export_labels
    from app.services.exporting import ExportChoice

    choice = ExportChoice(format=format, allow_not_done=allow_not_done, with_images=not no_images)
    with progress_bar("Exporting") as report:
        files = export_labels(
            settings_from(data_dir=data), dataset, output, choice, on_file=lambda done: report(done, done)
        )
    terminal.print(f"{len(files)} files are in {output}")
