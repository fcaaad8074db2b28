"""The images that wait for a second review: a share of those whose first one is done.

Which images these are follows from their content, so that nobody chooses them and the same share is the same images
wherever the dataset is imported.
"""

from __future__ import annotations

from dataclasses import dataclass

from sqlalchemy import ColumnElement, Select, exists, false, func, select

from app.db.models import Dataset, Image, Review, SecondReview
from app.services.image_candidates import has_decided

HEX_DIGITS = 8


@dataclass(frozen=True)
class DueImage:
    """An image that waits for a second review."""

    image_id: int
    name: str
    candidates: int


def is_in_share(share: float) -> ColumnElement[bool]:
    """Return the condition on ``Image`` that its content is in the share: the first digits of its hash decide."""
    if share <= 0.0:
        return false()
    if share >= 1.0:
        return Image.id.is_not(None)
    return func.substr(Image.sha256, 1, HEX_DIGITS) < f"{round(share * 16**HEX_DIGITS):0{HEX_DIGITS}x}"


def due_images(dataset: Dataset, share: float, person: str | None) -> Select[int, str, int]:
    """Select the columns of ``DueImage`` of the images that a person can begin with."""
    begun = exists().where(SecondReview.image_id == Image.id)
    return (
        select(Image.id, Image.name, Image.n_candidates)
        .join(Review, Review.image_id == Image.id)
        .where(
            Image.dataset_id == dataset.id,
            Image.deleted_at.is_(None),
            Image.n_candidates > 0,
            is_in_share(share),
            Image.review_status == "done",
            Review.person.is_distinct_from(person),
            *([] if person is None else [~has_decided(person)]),
            ~begun.correlate(Image),
        )
    )
