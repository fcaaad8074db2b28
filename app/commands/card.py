"""``clearlines card``: what a dataset holds and how well the pipeline did on it, as text, JSON and a figure."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path

from rich.console import Console
from rich.table import Table

from app.commands.stores import opened_stores
from app.commands.whole_files import json_bytes, write_whole
from app.db.models import Image
from app.evaluation.table_one import TableRow, table_text
from app.images.decode import decode_gray
from app.services.baseline_detectors import detect_candidates
from app.services.card_tables import CardTables, table_content
from app.services.cards import Card, card_figure, dataset_card
from app.settings import Settings
from app.storage import BlobStore
from app.vision.segments import Segments

Progress = Callable[[str], None]

NAMELESS = "(no source)"


@dataclass(frozen=True)
class WrittenCard:
    """A card, its table, and the files that were written."""

    card: Card
    table: tuple[TableRow, ...]
    files: tuple[Path, ...]


def dataset_card_files(
    settings: Settings,
    slug: str,
    output: Path | None = None,
    *,
    detect: bool = False,
    min_length: float = 0.0,
    progress: Progress | None = None,
) -> WrittenCard:
    """Return a dataset's card; with ``output`` write ``card.json`` and, where there are labels, ``card.png`` there.

    Args:
        settings: Say where the database and the blobs are.
        slug: Of the dataset.
        output: Folder of the files.
        detect: Whether to run the pipeline on labelled images that it hasn't been run on, for the table.
        min_length: Labels of less arc length, px, are ignored in the table.
        progress: Called with the name of each image that it is run on.

    Raises:
        NotFound: When there is no such dataset.
        OSError: When the folder can't be written to.
    """
    with opened_stores(settings) as (database, blobs):
        find = _detector(blobs, settings.max_image_pixels, progress) if detect else None
        table = CardTables(database, find, min_length=min_length).table_of(slug)
        with database.read() as session:
            card = dataset_card(session, slug)
            picture = None
            if output is not None and card.figure is not None:
                picture = card_figure(session, blobs, slug, max_pixels=settings.max_image_pixels)
    if output is None:
        return WrittenCard(card, table, ())
    content = {**asdict(card), "table_one": table_content(table), "figure": picture and "card.png"}
    files = {output / "card.json": json_bytes(content)}
    if picture is not None:
        files[output / "card.png"] = picture
    for path, data in files.items():
        write_whole(path, data)
    return WrittenCard(card, table, tuple(files))


def _detector(blobs: BlobStore, max_pixels: int, progress: Progress | None) -> Callable[[Image], Segments]:
    def find(image: Image) -> Segments:
        if progress is not None:
            progress(image.name)
        return detect_candidates(decode_gray(blobs.read(image.sha256), max_pixels=max_pixels), 0.0)

    return find


def print_card(written: WrittenCard, console: Console) -> None:
    """Tell what the card says: the dataset's own words, its images by source, and the table of its candidates."""
    card = written.card
    console.print(f"{card.name}: {card.images} images, {card.labelled} done, {card.labels} labels", markup=False)
    for word, text in (("", card.description), ("licence: ", card.licence), ("citation: ", card.citation)):
        if text:
            console.print(f"{word}{text}", markup=False)
    console.print(_sources(card))
    if written.table:
        console.print("Candidates against labels (precision, recall and F1 under official-v1):")
        console.print(table_text(written.table, NAMELESS), markup=False, end="")
    elif card.labelled:
        console.print("No candidates to compare with the labels: pre-label the images, or ask for --detect.")
    if written.files:
        console.print(f"the card is in {', '.join(str(path) for path in written.files)}", markup=False)


def _sources(card: Card) -> Table:
    table = Table(box=None, pad_edge=False)
    for column in ("source", "images", "done", "sequences", "cameras", "sizes"):
        table.add_column(column, justify="left" if column in ("source", "sizes") else "right")
    for source in card.sources:
        numbers = (source.images, source.labelled, source.sequences, source.cameras)
        table.add_row(source.source or NAMELESS, *map(str, numbers), ", ".join(source.sizes))
    return table
