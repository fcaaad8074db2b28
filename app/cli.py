"""The command line: each command reads its arguments and calls one function of ``app.commands``."""

from __future__ import annotations

import os
import signal
import sys
from pathlib import Path
from types import FrameType
from typing import Annotated, Any, NoReturn

import typer
from rich.console import Console

from app import __version__
from app.commands.paths import require_folder_possible, require_there
from app.commands.progress import progress_bar
from app.errors import ClearLinesError, InvalidInput

app = typer.Typer(
    name="clearlines",
    help="Turn street images into ground truth for straight edge-segments.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
INTERRUPTED = 130  # exit status after Ctrl-C
terminal = Console(stderr=True, highlight=False, soft_wrap=True)

DataDir = Annotated[Path | None, typer.Option("--data", help="Folder of the database and the uploaded files.")]
Port = Annotated[int | None, typer.Option(min=0, max=65535, help="Port to listen on; 0 takes a free one.")]
NoBrowser = Annotated[bool, typer.Option("--no-browser", help="Don't open a browser.")]


@app.callback(invoke_without_command=True)
def _version(version: Annotated[bool, typer.Option("--version", help="Print the version.")] = False) -> None:
    if version:
        typer.echo(__version__)
        raise typer.Exit


@app.command()
def demo(data: DataDir = None, port: Port = None, no_browser: NoBrowser = False) -> None:
    """Make a small synthetic street dataset, pre-label it, and open the tool."""
    from app.commands.address import address_of, listen
    from app.commands.demo_settings import demo_settings

    settings = demo_settings(_settings(data_dir=data, port=port))
    with listen(settings.host, settings.port) as server:
        from app.commands.demo import prepare_demo
        from app.commands.serve import run_server

        with progress_bar("Drawing streets") as report:
            slug = prepare_demo(settings, progress=report)
        _announce(address_of(server), settings.data_dir)
        run_server(settings, server, open_at=None if no_browser else f"/datasets/{slug}")


@app.command()
def serve(
    image_dir: Annotated[Path | None, typer.Argument(help="Images to bring in and pre-label.")] = None,
    data: DataDir = None,
    host: Annotated[str | None, typer.Option(help="Loopback address to listen on.")] = None,
    port: Port = None,
    no_browser: NoBrowser = False,
) -> None:
    """Serve the browser tool and the API; with IMAGE_DIR its images come in and are pre-labelled."""
    from app.commands.address import address_of, listen

    if image_dir is not None:
        require_there([image_dir])
    settings = _settings(data_dir=data, host=host, port=port)
    with listen(settings.host, settings.port) as server:
        from app.commands.serve import import_and_prelabel, prepare_data, run_server

        prepare_data(settings)
        start = "/"
        if image_dir is not None:
            with progress_bar("Importing") as report:
                slug = import_and_prelabel(settings, image_dir, _folder_name(image_dir), progress=report)
            start = f"/datasets/{slug}"
        _announce(address_of(server) + start, settings.data_dir)
        run_server(settings, server, open_at=None if no_browser else start)


@app.command()
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
    sharing: Any = _one_of("--camera", camera, "joint", "per-image")
    file_format: Any = _one_of("--format", format, "npz", "json", "npy")
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


@app.command()
def evaluate(
    ground_truth: Annotated[Path, typer.Option(help="Folder of labels.")],
    predictions: Annotated[Path, typer.Option(help="Folder of predictions.")],
    images: Annotated[Path | None, typer.Option(help="Folder of images to draw on.")] = None,
    output: Annotated[
        Path, typer.Option(metavar="PICTURES", help="Folder for the pictures; summaries go beside it.")
    ] = (Path("evaluation/visualization")),
    protocol: Annotated[str, typer.Option(help="How to score.")] = "official-v1",
    min_length: Annotated[float, typer.Option(help="Shorter segments don't count, px.")] = 0.0,
) -> None:
    """Score predictions against labels, with pictures, without a server."""
    require_there([ground_truth, predictions, *([] if images is None else [images])])
    require_folder_possible(output)
    from app.commands.evaluate import evaluate as evaluate_folder
    from app.commands.reports import print_evaluation

    with progress_bar("Scoring") as report:
        result = evaluate_folder(
            ground_truth,
            predictions,
            images=images,
            pictures=output,
            protocol=protocol,
            min_length=min_length,
            progress=report,
        )
    print_evaluation(result, terminal)
    if result.picture_errors:
        raise typer.Exit(1)


@app.command()
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


@app.command("import")
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
        result = import_images(_settings(data_dir=data), folder, dataset, progress=report)
    print_import(result, terminal)
    if result.report.failed:
        raise typer.Exit(1)


@app.command()
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
            _settings(data_dir=data), dataset, output, choice, on_file=lambda done: report(done, done)
        )
    terminal.print(f"{len(files)} files are in {output}")


def main() -> None:
    """Run the command line; errors of ours are told in one line, without a traceback."""
    signal.signal(signal.SIGTERM, _end)
    try:
        app(standalone_mode=True)
    except SystemExit as end:
        if end.code == INTERRUPTED:
            terminal.print("stopped; the same command goes on where this one was")
        raise
    except ClearLinesError as error:
        _tell(error)
        sys.exit(2)
    except OSError as error:
        where = None if error.filename is None else str(error.filename)
        _tell(ClearLinesError(error.strerror or str(error), where=where))
        sys.exit(2)


def _end(number: int, _frame: FrameType | None) -> NoReturn:
    """End as after Ctrl-C: whatever is at work puts itself away."""
    sys.exit(128 + number)


def _tell(error: ClearLinesError) -> None:
    head = f"{error.where}: {error.message}" if error.where else error.message
    terminal.print("[bold red]error:[/]", end=" ")
    terminal.print(head, markup=False)
    for word, text in (("expected", error.expected), ("hint", error.hint)):
        if text:
            terminal.print(f"  {word}: {text}", markup=False)


def _settings(**given: Any) -> Any:
    from pydantic import ValidationError

    from app.settings import Settings

    try:
        settings = Settings(**{name: value for name, value in given.items() if value is not None})
    except ValidationError as error:
        first = error.errors()[0]
        field = ".".join(map(str, first["loc"]))
        raise InvalidInput(first["msg"], where=f"setting {field}", hint=f"see CLEARLINES_{field.upper()}") from error
    require_folder_possible(settings.data_dir)
    return settings


def _folder_name(folder: Path) -> str:
    """Name a dataset after its folder; one called ``images`` after the folder above."""
    resolved = folder.resolve()
    return resolved.parent.name if resolved.name == "images" and resolved.parent.name else resolved.name


def _one_of(option: str, value: str, *allowed: str) -> Any:
    if value not in allowed:
        raise InvalidInput(f"{value!r} is not possible", where=option, expected=", ".join(allowed))
    return value


def _announce(address: str, data_dir: Path) -> None:
    terminal.print(f"ClearLines is at [bold]{address}[/]  (data in {data_dir}; Ctrl-C stops it)")


if __name__ == "__main__":
    main()
