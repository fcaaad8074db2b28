"""A dataset's card: what it holds, how well its candidates did, its figure, and how to cite it."""

from __future__ import annotations

import hashlib
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray
from sqlalchemy import Row, func, select
from sqlalchemy.orm import Session

from app.db.models import Camera, Dataset, Decision, Image, ImageTally, Review
from app.errors import NotFound
from app.images import decode_display
from app.services.card_figure import draw_panels
from app.services.counts import VerdictCounts, verdict_counts
from app.services.datasets import get_dataset
from app.services.labelled_contents import images_done, labelled_content
from app.services.tallies import of_dataset, summed
from app.storage import BlobStore

SIZES_SHOWN = 5
COUNTED = ("images", "candidates", "keep", "reject", "ambiguous")


@dataclass(frozen=True)
class CardSource:
    """Images of one origin.

    Attributes:
        labelled: Images whose review is done.
        sizes: Widths and heights that occur, the most frequent first.
    """

    source: str | None
    images: int
    labelled: int
    sequences: int
    cameras: int
    sizes: tuple[str, ...]


@dataclass(frozen=True)
class Card:
    """What a dataset's card says.

    Attributes:
        labels: Kept segments.
        figure: Address of the picture; ``None`` without labels.
    """

    slug: str
    name: str
    description: str | None
    licence: str | None
    citation: str | None
    images: int
    labelled: int
    sources: tuple[CardSource, ...]
    labels: int
    verdicts: VerdictCounts
    figure: str | None


def dataset_card(session: Session, slug: str) -> Card:
    """Return a dataset's card.

    Raises:
        NotFound: When there is no such dataset.
    """
    dataset = get_dataset(session, slug)
    rows = _tallied(session, dataset)
    images, *counts = (sum(getattr(row, word) for row in rows) for word in COUNTED)
    verdicts = verdict_counts(*counts)
    done = [row for row in rows if row.review_status == "done"]
    labelled = sum(row.images for row in done)
    has_figure = any(row.labelled for row in done)
    return Card(
        slug=dataset.slug,
        name=dataset.name,
        description=dataset.description,
        licence=dataset.licence,
        citation=dataset.citation,
        images=images,
        labelled=labelled,
        sources=_sources(rows, _sizes(session, dataset)),
        labels=verdicts.keep,
        verdicts=verdicts,
        figure=f"/api/datasets/{dataset.slug}/card.png" if has_figure else None,
    )


def labels_mark(session: Session, dataset: Dataset) -> str:
    """Return a text that differs when images, candidates, verdicts or reviews of a dataset have changed."""
    alive = (Image.dataset_id == dataset.id) & Image.deleted_at.is_(None)
    rows = session.execute(
        select(Image.id, Image.revision, Image.source, Review.status)
        .join(Review, Review.image_id == Image.id)
        .where(alive)
        .order_by(Image.id)
    ).all()
    decision = session.scalar(select(func.max(Decision.id)).join(Image, Image.id == Decision.image_id).where(alive))
    return hashlib.sha256(repr((dataset.id, decision, [tuple(row) for row in rows])).encode()).hexdigest()


def card_figure(session: Session, blobs: BlobStore, slug: str, *, max_pixels: int) -> bytes:
    """Return the card's figure as a PNG: an image, its candidates, what was kept of them.

    The image is the one with the median number of kept segments among those whose review is done. Where its candidates
    aren't known, their panel is left out.

    Raises:
        NotFound: When there is no such dataset, or nothing is labelled.
    """
    dataset = get_dataset(session, slug)
    labelled = images_done(dataset).where(Image.n_keep > 0)
    number = session.scalar(labelled.with_only_columns(func.count(Image.id))) or 0
    image = session.scalars(labelled.order_by(Image.n_keep, Image.name).offset(number // 2).limit(1)).one_or_none()
    if image is None:
        raise NotFound("no image of the dataset is labelled", where=slug, hint="finish the review of one")
    content = labelled_content(session, image)
    pixels = decode_display(blobs.read(image.sha256), max_pixels=max_pixels)
    return _png(draw_panels(pixels, content.candidates, content.kept))


def _tallied(session: Session, dataset: Dataset) -> Sequence[Row[*tuple[Any, ...]]]:
    """Return sums over the images that are alike in source, drive, camera and review."""
    keys = (ImageTally.source, ImageTally.sequence, ImageTally.camera_id, ImageTally.review_status)
    sums = (getattr(ImageTally, name) for name in (*COUNTED, "labelled"))
    query = select(*keys, *(summed(column).label(column.key) for column in sums)).where(of_dataset(dataset))
    return [row for row in session.execute(query.group_by(*keys)) if row.images]


def _sizes(session: Session, dataset: Dataset) -> dict[int, str]:
    """Return the size of the images of each camera."""
    cameras = session.scalars(select(Camera).where(Camera.dataset_id == dataset.id))
    return {camera.id: f"{camera.width} x {camera.height}" for camera in cameras}


def _sources(rows: Sequence[Row[*tuple[Any, ...]]], sizes: Mapping[int, str]) -> tuple[CardSource, ...]:
    names = sorted({row.source for row in rows}, key=lambda name: (name is None, name or ""))
    return tuple(_source(name, [row for row in rows if row.source == name], sizes) for name in names)


def _source(name: str | None, rows: Sequence[Row[*tuple[Any, ...]]], sizes: Mapping[int, str]) -> CardSource:
    of_size = Counter[str]()
    for row in rows:
        of_size[sizes[row.camera_id]] += row.images
    return CardSource(
        source=name,
        images=of_size.total(),
        labelled=sum(row.images for row in rows if row.review_status == "done"),
        sequences=len({row.sequence for row in rows if row.sequence}),
        cameras=len({row.camera_id for row in rows}),
        sizes=tuple(size for size, _ in of_size.most_common(SIZES_SHOWN)),
    )


def _png(picture: NDArray[np.uint8]) -> bytes:
    return cv2.imencode(".png", picture)[1].tobytes()
