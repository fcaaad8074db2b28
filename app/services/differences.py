"""Candidates on which first and second review differ, and what a third look decided."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from typing import Any

from sqlalchemy import Select, and_, func
from sqlalchemy.orm import Session

from app.db.models import Adjudication, Dataset, Image, Segment
from app.services.paging import Order, Page, checked_limit, page_of
from app.services.verdict_pairs import First, Second, select_pairs

BY_IMAGE = Order("image", Image.name, Segment.id)


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
) -> Page[Difference]:
    """Return a page of the candidates on which second reviews that are done differ from the first.

    Args:
        session: Any session.
        dataset: The dataset.
        adjudicated: Only those that were decided on since, or only those that weren't.
        limit: Of a page.
        cursor: Of the page before.

    Raises:
        InvalidInput: On a limit or cursor that can't be.
    """
    limit = checked_limit(limit)
    query = select_differences(dataset)
    if adjudicated is not None:
        decided = Adjudication.verdict.is_not(None)
        query = query.where(decided if adjudicated else ~decided)
    total = session.scalar(query.with_only_columns(func.count(Segment.id))) or 0
    if cursor:
        query = query.where(BY_IMAGE.after(cursor))
    rows = session.execute(query.order_by(*BY_IMAGE.clauses()).limit(limit + 1)).all()
    return page_of(rows, limit, BY_IMAGE, lambda row: (row.image, row.segment_id), total).map(_difference)


def difference_on(session: Session, dataset: Dataset, second_review_id: int, segment_id: int) -> Difference | None:
    """Return one difference; ``None`` where both agree, or one of them said nothing."""
    query = select_differences(dataset).where(
        Second.second_review_id == second_review_id, Second.segment_id == segment_id
    )
    row = session.execute(query).one_or_none()
    return None if row is None else _difference(row)


def select_differences(dataset: Dataset) -> Select[*tuple[Any, ...]]:
    """Select the columns of ``VerdictPair``, the candidate's box, and what was decided since."""
    here = and_(Adjudication.second_review_id == Second.second_review_id, Adjudication.segment_id == Second.segment_id)
    return (
        select_pairs(dataset)
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
        .where(First.verdict != Second.verdict)
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
