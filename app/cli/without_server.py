"""The commands that work on folders alone: ``prelabel``, ``evaluate`` and ``synthesize``."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated, Any

import typer

from app.cli.options import one_of
from app.cli.terminal import terminal
from app.commands.paths import require_folder_possible, require_there
from app.commands.progress import progress_bar


def prelabel(
    paths: Annotated[list[Path], typer.Argument(metavar="PATH...", help="Image files, or folders of them.")],
    output: Annotated[Path, typer.Option(help="Folder for the results, made if missing.")],
    format: Annotated[str, typer.Option(help="npz, json or npy (the paper's label files).")] = "npz",  # noqa: A002
    workers: Annotated[int | None, typer.Option(min=1, help="Processes; one per core by default.")] = None,
    camera: Annotated[str, typer.Option(help="joint: the images of a camera share a lens; per-image.")] = "joint",
    min_length: Annotated[float, typer.Option(help="Shortest candidate, px from end to end.")] = 100.0,
    operating_point: Annotated[str, typer.Option(help="recall, balanced or precise.")] = "balanced",
    discard: Annotated[bool, typer.Option("--discard", help="Drop candidates that fail straightness.")] = False,
) -> None:
    """Run the pipeline on images, without server or database."""
    require_there(paths)
    require_folder_possible(output)
    sharing: Any = one_of("--camera", camera, "joint", "per-image")
    file_format: Any = one_of("--format", format, "npz", "json", "npy")
    from app.commands.prelabel import PrelabelChoice, prelabel_files
    from app.commands.reports import print_prelabel
    from app.vision import DetectionParameters

    choice = PrelabelChoice(
        DetectionParameters.from_dict({"min_length": min_length, "operating_point": operating_point}),
        camera=sharing,
        discard=discard,
        format=file_format,
        workers=workers or os.cpu_count() or 1,
    )
    with progress_bar("Pre-labelling") as report:
        result = prelabel_files(paths, output, choice, progress=report)
    print_prelabel(result, terminal)
    if result.failed:
        raise typer.Exit(1)


def evaluate(
    ground_truth: Annotated[Path, typer.Option(help="Folder of labels.")],
    predictions: Annotated[Path, typer.Option(help="Folder of predictions.")],
    images: Annotated[Path | None, typer.Option(help="Folder of images to draw on.")] = None,
    output: Annotated[
        Path, typer.Option(metavar="PICTURES", help="Folder for the pictures; summaries go beside it.")
    ] = (Path("evaluation/visualization")),
    protocol: Annotated[
        str, typer.Option(help="official-v1, official-v1-fixed or clearlines-v2: what comes first and is drawn.")
    ] = "official-v1",
    min_length: Annotated[float, typer.Option(help="Shorter segments don't count, px.")] = 0.0,
    draws: Annotated[int, typer.Option(min=1, help="Draws of the bootstrap that intervals are taken from.")] = 2000,
    seed: Annotated[int, typer.Option(min=0, help="Of the draws.")] = 0,
    table: Annotated[bool, typer.Option("--table", help="Print scores by source, as the paper's Table I.")] = False,
) -> None:
    """Score predictions against labels, with pictures, without a server."""
    require_there([ground_truth, predictions, *([] if images is None else [images])])
    require_folder_possible(output)
    from app.commands.evaluate import Scoring
    from app.commands.evaluate import evaluate as evaluate_folder
    from app.commands.reports import print_evaluation

    with progress_bar("Scoring") as report:
        result = evaluate_folder(
            ground_truth,
            predictions,
            images=images,
            pictures=output,
            scoring=Scoring(protocol, min_length, draws, seed),
            progress=report,
        )
    print_evaluation(result, terminal, table=table)
    if result.picture_errors:
        raise typer.Exit(1)


def synthesize(
    count: Annotated[int, typer.Option(min=1, max=100_000, help="Number of images.")],
    output: Annotated[Path, typer.Option(help="Folder for the dataset, made if missing.")],
    seed: Annotated[int, typer.Option(min=0, help="The same seed gives the same images.")] = 0,
) -> None:
    """Make street scenes with the exact visible straight edges as labels."""
    require_folder_possible(output)
    from app.commands.synthesize import synthesize_folder

    with progress_bar("Drawing streets") as report:
        synthesize_folder(count, output, seed=seed, progress=report)
    terminal.print(f"{count} images with labels are in {output}")
