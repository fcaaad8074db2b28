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
tokens = typer.Typer(help="Names and roles under which people and programs ask a server.", no_args_is_help=True)
app.add_typer(tokens, name="token")
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
        from app.commands.demo_board import prepare_board
        from app.commands.serve import run_server

        with progress_bar("Drawing streets") as report:
            slug = prepare_demo(settings, progress=report)
        with progress_bar("Making a leaderboard") as report:
            prepare_board(settings, progress=report)
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


@app.command()
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


@app.command()
def baseline(
    split: Annotated[str, typer.Argument(metavar="SPLIT", help="Its slug, as in its address.")], data: DataDir = None
) -> None:
    """Put the pre-labelling pipeline and OpenCV's LSD on a split's board."""
    from app.commands.baseline import queue_baselines, score_queued

    settings = _settings(data_dir=data)
    with progress_bar("Detecting") as report:
        ids = queue_baselines(settings, split, progress=report)
    with progress_bar("Scoring") as report:
        rows = score_queued(settings, ids, progress=report)
    for row in rows:
        number = "" if row.f1 is None else f", F1 {row.f1:.3f}"
        terminal.print(f"{row.name} ({row.label}): {row.status}{number}", markup=False)
    if any(row.status != "scored" for row in rows):
        raise typer.Exit(1)


@app.command()
def card(
    dataset: Annotated[str, typer.Argument(metavar="DATASET", help="Its slug, as in its address.")],
    output: Annotated[Path | None, typer.Option(help="Folder for card.json and card.png, made if missing.")] = None,
    data: DataDir = None,
) -> None:
    """Tell what a dataset holds, and how its candidates did against its labels."""
    if output is not None:
        require_folder_possible(output)
    from app.commands.card import dataset_card_files, print_card

    print_card(dataset_card_files(_settings(data_dir=data), dataset, output), Console(highlight=False, soft_wrap=True))


@tokens.command("create")
def create_token(
    name: Annotated[str, typer.Argument(help="Of its holder; what they do is stored under it.")],
    role: Annotated[str, typer.Option(help="reader, submitter, annotator, maintainer or owner.")],
    expires: Annotated[float | None, typer.Option(metavar="DAYS", help="Good for so many days.")] = None,
    data: DataDir = None,
) -> None:
    """Make a token and print it, this once."""
    from app.commands.token import make_token

    token = make_token(_settings(data_dir=data), name, role, days=expires)
    terminal.print(f"token of {token.name}, {token.role}; it is shown this once:", markup=False)
    typer.echo(token.text)


@tokens.command("list")
def list_tokens(data: DataDir = None) -> None:
    """List names, roles and times of all tokens."""
    from app.commands.token import print_tokens

    print_tokens(_settings(data_dir=data), Console(highlight=False, soft_wrap=True))


@tokens.command("revoke")
def revoke_token(
    name: Annotated[str, typer.Argument(help="As the token was made with.")],
    data: DataDir = None,
) -> None:
    """End a token; what was done under its name stays."""
    from app.commands.token import end_token

    end_token(_settings(data_dir=data), name)
    terminal.print(f"the token of {name} is revoked", markup=False)


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
