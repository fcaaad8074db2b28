"""Candidates on which first and second review differ, and what a third look decided."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from sqlalchemy import Select, and_, func, select
from sqlalchemy.orm import Session

from app.db.models import Adjudication, Dataset, Image, SecondReview, Segment
from app.services.batches import in_batches
from app.services.paging import Order, Page, checked_limit, page_of, read_cursor
from app.services.verdict_pairs import select_pairs

BY_IMAGE = Order("image", Image.name, Segment.id)
IMAGES_AT_ONCE = 20


@dataclass(frozen=True)
class GivenVerdict:
    """A verdict and who gave it."""

    verdict: str
    person: str | None


@dataclass(frozen=True)
class Adjudicated:
    """What was decided where two differed."""

    verdict: str
    person: str | None
    created_at: datetime


@dataclass(frozen=True)
class Difference:
    """A candidate with two verdicts.

    Attributes:
        image: Name of the image.
        length: Arc length, px.
        box: x0, y0, x1, y1 in px.
        adjudicated: ``None`` while nobody has decided between the two.
    """

    second_review_id: int
    image_id: int
    image: str
    segment_id: int
    length: float
    box: tuple[float, float, float, float]
    first: GivenVerdict
    second: GivenVerdict
    adjudicated: Adjudicated | None


def list_differences(
    session: Session,
    dataset: Dataset,
    *,
    adjudicated: bool | None = None,
    limit: int = 100,
    cursor: str | None = None,
    total: int | None = None,
) -> Page[Difference]:
    """Return a page of the candidates on which second reviews that are done differ from the first.

    Only as many images are compared as the page shows.

    Args:
        session: Any session.
        dataset: The dataset.
        adjudicated: Only those that were decided on since, or only those that weren't.
        limit: Of a page.
        cursor: Of the page before.
        total: Their number on all pages, where it was counted lately.

    Raises:
        InvalidInput: On a limit or cursor that can't be.
    """
    limit = checked_limit(limit)
    if total is None:
        total = count_differences(session, dataset, adjudicated=adjudicated)
    after = None if cursor is None else BY_IMAGE.after(cursor)
    since = None if cursor is None else str(read_cursor(BY_IMAGE.name, cursor)[0])
    rows: list[Any] = []
    for images in in_batches(_compared_images(session, dataset, since), IMAGES_AT_ONCE):
        query = _chosen(select_differences(dataset, images), adjudicated)
        query = query if after is None else query.where(after)
        rows += session.execute(query.order_by(*BY_IMAGE.clauses()).limit(limit + 1 - len(rows))).all()
        if len(rows) > limit:
            break
    return page_of(rows, limit, BY_IMAGE, lambda row: (row.image, row.segment_id), total).map(_difference)


def count_differences(session: Session, dataset: Dataset, *, adjudicated: bool | None = None) -> int:
    """Count the differences; this compares all images that were reviewed twice."""
    query = _chosen(select_differences(dataset), adjudicated)
    return session.scalar(query.with_only_columns(func.count(Segment.id))) or 0


def difference_on(session: Session, dataset: Dataset, second_review_id: int, segment_id: int) -> Difference | None:
    """Return one difference; ``None`` where both agree, or one of them said nothing."""
    review = session.get(SecondReview, second_review_id)
    images = [] if review is None else [review.image_id]
    query = select_differences(dataset, images).where(SecondReview.id == second_review_id, Segment.id == segment_id)
    row = session.execute(query).one_or_none()
    return None if row is None else _difference(row)


def _compared_images(session: Session, dataset: Dataset, since: str | None) -> Sequence[int]:
    """Return the images whose second review is done, by name, from this name on."""
    query = (
        select(Image.id)
        .join(SecondReview, SecondReview.image_id == Image.id)
        .where(Image.dataset_id == dataset.id, Image.deleted_at.is_(None), SecondReview.status == "done")
        .order_by(Image.name, Image.id)
    )
    return session.scalars(query if since is None else query.where(Image.name >= since)).all()


def _chosen(query: Select[*tuple[Any, ...]], adjudicated: bool | None) -> Select[*tuple[Any, ...]]:
    if adjudicated is None:
        return query
    decided = Adjudication.verdict.is_not(None)
    return query.where(decided if adjudicated else ~decided)


def select_differences(dataset: Dataset, image_ids: Collection[int] | None = None) -> Select[*tuple[Any, ...]]:
    """Select the columns of ``VerdictPair``, the candidate's box, and what was decided since."""
    here = and_(Adjudication.second_review_id == SecondReview.id, Adjudication.segment_id == Segment.id)
    return (
        select_pairs(dataset, image_ids, differing=True)
        .add_columns(
            Segment.x0,
            Segment.y0,
            Segment.x1,
            Segment.y1,
            Adjudication.verdict.label("verdict"),
            Adjudication.person.label("adjudicator"),
            Adjudication.created_at.label("adjudicated_at"),
        )
        .outerjoin(Adjudication, here)
    )


def _difference(row: Any) -> Difference:
    decided = None if row.verdict is None else Adjudicated(row.verdict, row.adjudicator, row.adjudicated_at)
    return Difference(
        second_review_id=row.second_review_id,
        image_id=row.image_id,
        image=row.image,
        segment_id=row.segment_id,
        length=row.length,
        box=(row.x0, row.y0, row.x1, row.y1),
        first=GivenVerdict(row.first, row.first_person),
        second=GivenVerdict(row.second, row.second_person),
        adjudicated=decided,
    )
