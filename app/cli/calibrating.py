"""The command ``calibrate``: a lens for each camera, from images or labels, without a server."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Annotated, Any

import typer

from app.cli.options import one_of
from app.cli.terminal import terminal
from app.commands.paths import require_there
from app.commands.progress import progress_bar
from app.errors import InvalidInput

STDOUT = "-"
FAMILIES = ("brown", "opencv", "division")


def calibrate(
    paths: Annotated[
        list[Path], typer.Argument(metavar="PATH...", help="Images, datasets (images/ and labels/), or label files.")
    ],
    labels: Annotated[Path | None, typer.Option(help="Folder of label files for the images.")] = None,
    size: Annotated[str | None, typer.Option(metavar="WxH", help="Image size in px, for label files alone.")] = None,
    camera: Annotated[str | None, typer.Option(help="The only camera to calibrate.")] = None,
    family: Annotated[str | None, typer.Option(help="brown, opencv or division; the best by default.")] = None,
    focal_length: Annotated[
        float | None, typer.Option(help="For exports, px; the estimated one by default, else a nominal one.")
    ] = None,
    export: Annotated[
        list[str] | None, typer.Option(metavar="FORMAT", help="Write a file for another tool; may be repeated.")
    ] = None,
    output: Annotated[Path | None, typer.Option(metavar="FILE|DIR", help="Where exports go.")] = None,
    report: Annotated[Path | None, typer.Option(metavar="FILE.html", help="Write a printable report.")] = None,
    json: Annotated[Path | None, typer.Option(metavar="FILE", help="Write all as JSON; - for standard output.")] = None,
    reference: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Compare with a calibration: OpenCV, ROS, cameras.json.")
    ] = None,
    seed: Annotated[int, typer.Option(min=0, help="Of the draws of the uncertainty.")] = 0,
    workers: Annotated[int | None, typer.Option(min=1, help="Processes; one per core by default.")] = None,
) -> None:
    """Estimate the lens of each camera, with its uncertainty, and write it for other tools."""
    require_there([*paths, *(path for path in (labels, reference) if path is not None)])
    chosen: Any = None if family is None else one_of("--family", family, *FAMILIES)
    image_size = None if size is None else _size(size)
    json_file = None if json is None or str(json) == STDOUT else json
    from app.clock import utc_now
    from app.commands.calibrate import CalibrateChoice, calibrate_cameras
    from app.commands.calibrate_outputs import json_content, require_outputs_possible, write_exports, write_reports
    from app.commands.calibrate_progress import calibration_progress
    from app.commands.calibrate_sources import gather_lines
    from app.commands.calibrate_tables import print_camera, print_exports, print_written
    from app.commands.reports import print_failed
    from app.commands.whole_files import json_bytes, write_whole

    choice = CalibrateChoice(chosen, focal_length, tuple(export or ()), reference, seed)
    require_outputs_possible(output, report, json_file, choice.exports)
    with progress_bar("Reading lines") as progress:
        gathered = gather_lines(
            paths, labels=labels, size=image_size, camera=camera, workers=workers or os.cpu_count() or 1,
            progress=progress,
        )  # fmt: skip
    with calibration_progress() as watch:
        cameras = calibrate_cameras(gathered, choice, watch=watch)
    written = write_exports(cameras, output)
    if report is not None:
        written += write_reports(cameras, report, created=utc_now())
    if json_file is not None:
        write_whole(json_file, json_bytes(json_content(cameras)))
        written.append(json_file)
    elif json is not None:
        typer.echo(json_bytes(json_content(cameras)).decode(), nl=False)
    for each in cameras:
        print_camera(each, terminal)
        print_exports(each, terminal)
    print_written(written, terminal)
    print_failed(((name, str(error)) for name, error in gathered.failed.items()), terminal)
    if gathered.failed or not all(each.done for each in cameras):
        raise typer.Exit(1)


def _size(text: str) -> tuple[int, int]:
    found = re.fullmatch(r"(\d{1,6})[xX×](\d{1,6})", text.strip())
    if found is None or "0" in (found[1].lstrip("0") or "0", found[2].lstrip("0") or "0"):
        raise InvalidInput(f"{text!r:.40} is no size", where="--size", expected="WIDTHxHEIGHT in px, such as 1242x375")
    return int(found[1]), int(found[2])
