"""Our own formats, one file per image."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from app.formats.json_writer import write_json
from app.formats.labelled_image import LabelledImage
from app.formats.npz import write_npz


def export_npz(images: Iterable[LabelledImage]) -> Iterator[tuple[str, bytes]]:
    """Yield ``NAME.npz`` per image, as `app.formats.npz` reads it."""
    for image in images:
        yield f"{image.name}.npz", write_npz(image.labelled)


def export_json(images: Iterable[LabelledImage]) -> Iterator[tuple[str, bytes]]:
    """Yield ``NAME.json`` per image, as `app.formats.json_segments` reads it."""
    for image in images:
        yield f"{image.name}.json", write_json(image.labelled)
