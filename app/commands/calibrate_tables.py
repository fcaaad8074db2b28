"""What ``clearlines calibrate`` prints of a camera."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from rich.console import Console
from rich.table import Table

from app.calibration.exports.catalog import FORMATS
from app.calibration.report.tables import parameter_rows
from app.calibration.report.words import ADVICE, FAMILY_TITLES, pixels, tiny_pixels
from app.commands.calibrate import CalibratedCamera

SOURCES = {"labels": "kept lines", "candidates": "candidates"}


def print_camera(camera: CalibratedCamera, console: Console) -> None:
    """Tell a camera's verdict, parameters, uncertainty, warnings and how other tools' files hold its lens."""
    calibration, known, counts = camera.calibration, camera.calibration.uncertainty, camera.calibration.counts
    console.print(f"\n[bold]{_plain(camera.lines.name)}[/]", markup=True, end="  ")
    images = f"{counts['images']} image{'' if counts['images'] == 1 else 's'}"
    console.print(
        f"{calibration.lens.width} x {calibration.lens.height} px, {images}, {counts['inliers']} of "
        f"{counts['segments']} {SOURCES[camera.lines.source]} straight"
    )
    if calibration.accepted:
        console.print("[bold green]accepted[/]", end=": ")
        console.print(
            f"expected error {pixels(known.pred)}, below {pixels(known.bound95)} with 95 %; "
            f"the correction is {pixels(known.correction)}"
        )
    else:
        console.print("[bold red]not accepted[/]", end=": ")
        console.print("; ".join(calibration.reasons), markup=False)
    for warned in calibration.warnings:
        console.print("[yellow]warning[/]", end=": ")
        console.print(f"{warned.message}. {ADVICE.get(warned.code, '')}", markup=False)
    console.print(f"{FAMILY_TITLES[calibration.lens.family]}, in half diagonals:", markup=False)
    console.print(_parameters(camera))
    console.print(_focal(camera), markup=False)
    if camera.difference is not None:
        rms, maximum, inner = (
            pixels(value) for value in (camera.difference.rms, camera.difference.maximum, camera.difference.inner_rms)
        )
        console.print(
            f"difference to {camera.reference_name}: {rms} RMS, {maximum} at most, {inner} RMS in the inner 80 %",
            markup=False,
        )
    for name, error in camera.refused.items():
        console.print("[bold red]not exported[/]", end=": ")
        console.print(f"{name}: {error.message}" + (f" ({error.hint})" if error.hint else ""), markup=False)


def print_exports(camera: CalibratedCamera, console: Console) -> None:
    """Tell how exactly each exported file holds the lens."""
    if not camera.exported:
        return
    table = Table(box=None, pad_edge=False)
    table.add_column("format")
    table.add_column("model in the file")
    table.add_column("conversion error", justify="right")
    table.add_column("at most", justify="right")
    for name, exported in camera.exported.items():
        error = exported.error
        table.add_row(FORMATS[name].title, exported.model, tiny_pixels(error.rms), tiny_pixels(error.maximum))
    console.print(table)


def print_written(paths: Sequence[Path], console: Console) -> None:
    """Tell which files were written."""
    for path in paths:
        console.print(f"written: {path}", markup=False)


def _parameters(camera: CalibratedCamera) -> Table:
    table = Table(box=None, pad_edge=False)
    table.add_column("parameter")
    table.add_column("value", justify="right")
    table.add_column("sigma", justify="right")
    for row in parameter_rows(camera.calibration):
        table.add_row(row.name, row.value, row.sigma)
    return table


def _focal(camera: CalibratedCamera) -> str:
    focal = camera.calibration.focal or {}
    if focal.get("observable") and focal.get("focal_length") is not None:
        sigma = f" +- {focal['sigma']:.1f}" if focal.get("sigma") is not None else ""
        return f"focal length {focal['focal_length']:.1f}{sigma} px, from vanishing points"
    return f"focal length: not observable ({focal.get('reason') or 'no vanishing points'})"


def _plain(text: str) -> str:
    return text.replace("[", r"\[")
