"""What the commands say at their end: results as tables, then what failed and why."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from rich.console import Console
from rich.table import Table

from app.evaluation.summary import summary_text
from app.evaluation.table_one import table_text

if TYPE_CHECKING:  # each command loads what it needs alone, not the others' too
    from app.commands.evaluate import EvaluatedFolder
    from app.commands.prelabel import PrelabelReport
    from app.services.imports import FolderImport

SHOWN = 20


def print_prelabel(report: PrelabelReport, console: Console) -> None:
    """Tell what a pre-labelling came to, camera by camera."""
    table = Table(box=None, pad_edge=False)
    for column in ("camera", "images", "lens", "k1", "k2", "uncertainty"):
        table.add_column(column, justify="left" if column in ("camera", "lens") else "right")
    for camera in report.cameras[:SHOWN]:
        distortion = camera["distortion"]
        uncertain = distortion["uncertainty"]["pred"]
        verdict = "accepted" if distortion["accepted"] else "; ".join(distortion["reasons"])
        k1, k2 = (f"{value:+.4f}" for value in distortion["k"][:2])
        pixels = f"{uncertain:.2f} px" if uncertain is not None else "unknown"
        table.add_row(camera["name"], str(len(camera["images"])), verdict, k1, k2, pixels)
    console.print(table)
    _print_more(len(report.cameras), "cameras", console)
    console.print(f"{report.candidates} candidates in {len(report.images)} images are in {report.output}")
    print_failed(((name, str(error)) for name, error in report.failed.items()), console)


def print_evaluation(result: EvaluatedFolder, console: Console, *, table: bool = False) -> None:
    """Tell the scores, as ``summary.txt`` does or by source as the paper's Table I, and where the rest is."""
    console.print(table_text(result.table) if table else summary_text(result.evaluation), markup=False)
    console.print(f"summaries and results per image are in {result.folder}")
    if result.pictures is not None:
        console.print(f"pictures are in {result.pictures}")
    if result.without_picture:
        console.print(f"without an image to draw on: {', '.join(result.without_picture[:SHOWN])}", markup=False)
    print_failed(((error.where or "", error.message) for error in result.picture_errors), console)


def print_import(result: FolderImport, console: Console) -> None:
    """Tell what an import brought."""
    report = result.report
    console.print(
        f"{len(report.added)} images added, {len(report.existing)} were there already, "
        f"{report.labels} with labels: dataset {result.slug}"
    )
    print_failed(((file.name, file.error["message"]) for file in report.failed), console)


def print_failed(failed: Iterable[tuple[str, str]], console: Console) -> None:
    """Tell what failed, given as name and reason."""
    rows = list(failed)
    for name, reason in rows[:SHOWN]:
        console.print("[bold red]failed:[/]", end=" ")
        console.print(f"{name}: {reason}", markup=False)
    _print_more(len(rows), "failures", console)


def _print_more(count: int, what: str, console: Console) -> None:
    if count > SHOWN:
        console.print(f"... and {count - SHOWN} more {what}")
