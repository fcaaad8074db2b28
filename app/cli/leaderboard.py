"""The commands around a split's board: ``submit``, ``baseline`` and ``card``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from app.cli.options import DataDir, settings_from
from app.cli.terminal import terminal
from app.commands.paths import require_folder_possible
from app.commands.progress import progress_bar
from app.errors import InvalidInput


def submit(
    results: Annotated[Path, typer.Argument(metavar="DIR", help="Folder of one file per image, or one file for all.")],
    server: Annotated[str, typer.Option(help="Address of the server, http://HOST:PORT.")],
    split: Annotated[str, typer.Option(help="Slug of the split, as in its address.")],
    method: Annotated[str, typer.Option(help="Name of your method; made if new.")] = "",
    label: Annotated[str, typer.Option(help="Your word for this version of it.")] = "",
    description: Annotated[str, typer.Option(help="What the method does.")] = "",
    code_url: Annotated[str, typer.Option(help="Where its code is.")] = "",
    paper_url: Annotated[str, typer.Option(help="Where it is described.")] = "",
    private: Annotated[bool, typer.Option("--private", help="Keep it off the board.")] = False,
    anonymous: Annotated[bool, typer.Option("--anonymous", help="Don't show whose a new method is.")] = False,
    token: Annotated[str | None, typer.Option(envvar="CLEARLINES_TOKEN", help="Who hands in.")] = None,
    validate: Annotated[bool, typer.Option("--validate", help="Check the files only.")] = False,
) -> None:
    """Hand results in at a server and wait for their score; invalid files end with 1 and all that is wrong."""
    from app.commands import submission_reports as reports
    from app.commands.submit import Target
    from app.commands.submit import submit as hand_in
    from app.commands.submit import validate as check
    from app.formats.submission_problems import InvalidSubmission

    target = Target(server, split, token)
    given = {"label": label, "description": description, "code_url": code_url, "paper_url": paper_url}
    fields = {"method": method, **{name: value for name, value in given.items() if value}}
    fields |= {"visibility": "private"} if private else {}
    fields |= {"anonymous": "true"} if anonymous else {}
    try:
        if validate:
            reports.print_validation(check(target, results), terminal)
            return
        if not method:
            raise InvalidInput("whose results are these?", where="--method", expected="the name of your method")
        with progress_bar("Scoring") as report:
            submission = hand_in(target, results, fields, progress=report)
    except InvalidSubmission as error:
        reports.print_errors(error, terminal)
        raise typer.Exit(1) from error
    reports.print_submission(submission, server, terminal)
    if submission["status"] != "scored":
        raise typer.Exit(1)


def baseline(
    split: Annotated[str, typer.Argument(metavar="SPLIT", help="Its slug, as in its address.")], data: DataDir = None
) -> None:
    """Put the pre-labelling pipeline and OpenCV's LSD on a split's board."""
    from app.commands.baseline import queue_baselines, score_queued

    settings = settings_from(data_dir=data)
    with progress_bar("Detecting") as report:
        ids = queue_baselines(settings, split, progress=report)
    with progress_bar("Scoring") as report:
        rows = score_queued(settings, ids, progress=report)
    for row in rows:
        number = "" if row.f1 is None else f", F1 {row.f1:.3f}"
        terminal.print(f"{row.name} ({row.label}): {row.status}{number}", markup=False)
    if any(row.status != "scored" for row in rows):
        raise typer.Exit(1)


def card(
    dataset: Annotated[str, typer.Argument(metavar="DATASET", help="Its slug, as in its address.")],
    output: Annotated[Path | None, typer.Option(help="Folder for card.json and card.png, made if missing.")] = None,
    detect: Annotated[bool, typer.Option("--detect", help="Run the pipeline where it hasn't been run.")] = False,
    min_length: Annotated[float, typer.Option(min=0, help="Shorter labels are ignored in the table, px.")] = 0.0,
    data: DataDir = None,
) -> None:
    """Tell what a dataset holds, and how its candidates did against its labels."""
    if output is not None:
        require_folder_possible(output)
    from app.commands.card import dataset_card_files, print_card

    with terminal.status("Looking at the labels") as status:
        told = dataset_card_files(
            settings_from(data_dir=data),
            dataset,
            output,
            detect=detect,
            min_length=min_length,
            progress=lambda name: status.update(f"Detecting in {name}"),
        )
    print_card(told, Console(highlight=False, soft_wrap=True))
