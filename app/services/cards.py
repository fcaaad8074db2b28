"""A dataset's card: what it holds, how well its candidates did, its figure, and how to cite it."""

from __future__ import annotations

import hashlib
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray
from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.db.models import Dataset, Decision, Image, Review
from app.errors import NotFound
from app.images import decode_display
from app.services.card_figure import draw_panels
from app.services.counts import VerdictCounts, verdict_counts
from app.services.datasets import get_dataset
from app.services.labelled_contents import images_done, labelled_content
from app.storage import BlobStore

SIZES_SHOWN = 5


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
    images = session.execute(
        select(Image, Review.status)
        .join(Review, Review.image_id == Image.id)
        .where(Image.dataset_id == dataset.id, Image.deleted_at.is_(None))
    ).all()
    counts = [sum(getattr(image, f"n_{word}") for image, _ in images) for word in ("keep", "reject", "ambiguous")]
    verdicts = verdict_counts(sum(image.n_candidates for image, _ in images), *counts)
    labelled = sum(status == "done" for _, status in images)
    has_figure = any(status == "done" and image.n_keep for image, status in images)
    return Card(
        slug=dataset.slug,
        name=dataset.name,
        description=dataset.description,
        licence=dataset.licence,
        citation=dataset.citation,
        images=len(images),
        labelled=labelled,
        sources=_sources([(image, status) for image, status in images]),
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
    images = session.scalars(images_done(dataset).where(Image.n_keep > 0).order_by(Image.n_keep, Image.name)).all()
    if not images:
        raise NotFound("no image of the dataset is labelled", where=slug, hint="finish the review of one")
    image = images[len(images) // 2]
    content = labelled_content(session, image)
    pixels = decode_display(blobs.read(image.sha256), max_pixels=max_pixels)
    return _png(draw_panels(pixels, content.candidates, content.kept))


def _sources(images: Sequence[tuple[Image, str]]) -> tuple[CardSource, ...]:
    names = sorted({image.source for image, _ in images}, key=lambda name: (name is None, name or ""))
    return tuple(_source(name, [row for row in images if row[0].source == name]) for name in names)


def _source(name: str | None, images: Sequence[tuple[Image, str]]) -> CardSource:
    sizes = Counter(f"{image.width} x {image.height}" for image, _ in images)
    return CardSource(
        source=name,
        images=len(images),
        labelled=sum(status == "done" for _, status in images),
        sequences=len({image.sequence for image, _ in images if image.sequence}),
        cameras=len({image.camera_id for image, _ in images}),
        sizes=tuple(size for size, _ in sizes.most_common(SIZES_SHOWN)),
    )


def _png(picture: NDArray[np.uint8]) -> bytes:
    return cv2.imencode(".png", picture)[1].tobytes()
