"""First and second verdict of each candidate that two people judged without knowing of one another.

The first verdict is the one that stood when the second review began, the second one the one that stood when it was
first done: what was changed later, by an adjudication or by who had seen the differences, was no longer independent.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

from sqlalchemy import CTE, Select, Subquery, func, or_, select
from sqlalchemy.orm import Session, aliased

from app.db.models import Dataset, Decision, Image, SecondDecision, SecondReview, Segment
from app.services.successors import last_of_each

JUDGED = ("keep", "reject", "ambiguous")
"""Verdicts that can agree; who left a candidate undecided said nothing."""

First = aliased(Decision, name="first_decision")
Second = aliased(SecondDecision, name="second_decision")


@dataclass(frozen=True)
class VerdictPair:
    """Two verdicts on one candidate.

    Attributes:
        length: Arc length, px.
        first: The first person's verdict.
        second: The second person's.
    """

    second_review_id: int
    image_id: int
    image: str
    segment_id: int
    length: float
    first: str
    first_person: str | None
    second: str
    second_person: str | None


def select_pairs(
    dataset: Dataset, image_ids: Collection[int] | None = None, *, differing: bool = False
) -> Select[int, int, str, int, float, str, str | None, str, str | None]:
    """Select the columns of ``VerdictPair`` for all candidates that both judged in second reviews that are done.

    What a hand drew is no candidate: whoever drew it kept it.

    Args:
        dataset: The dataset.
        image_ids: Of these images alone.
        differing: Only candidates on which both differ.
    """
    judged = _judged_by_both(_compared(dataset, image_ids), differing=differing)
    return (
        select(
            SecondReview.id.label("second_review_id"),
            Image.id.label("image_id"),
            Image.name.label("image"),
            Segment.id.label("segment_id"),
            Segment.length,
            judged.c.first,
            judged.c.first_person,
            judged.c.second,
            SecondReview.person.label("second_person"),
        )
        .select_from(judged)
        .join(SecondReview, SecondReview.id == judged.c.second_review_id)
        .join(Segment, Segment.id == judged.c.segment_id)
        .join(Image, Image.id == SecondReview.image_id)
        .where(Segment.origin != "manual")
    )


def verdict_pairs(session: Session, dataset: Dataset) -> list[VerdictPair]:
    """Return the pairs of a dataset, by image and candidate."""
    rows = session.execute(select_pairs(dataset).order_by(Image.name, Segment.id))
    return [VerdictPair(*row) for row in rows]


def _compared(dataset: Dataset, image_ids: Collection[int] | None) -> CTE:
    """Return the second reviews whose verdicts are compared with the first ones."""
    query = (
        select(SecondReview.id, SecondReview.image_id, SecondReview.first_decision_id, SecondReview.done_at)
        .join(Image, Image.id == SecondReview.image_id)
        .where(Image.dataset_id == dataset.id, Image.deleted_at.is_(None), SecondReview.status == "done")
    )
    return (query if image_ids is None else query.where(SecondReview.image_id.in_(image_ids))).cte("compared")


def _judged_by_both(compared: CTE, *, differing: bool) -> CTE:
    """Return both verdicts on each candidate, found before anything is looked up that is only shown."""
    first, second = _latest_first(compared), _latest_second(compared)
    pairs = (
        select(
            Second.second_review_id,
            Second.segment_id,
            First.verdict.label("first"),
            First.person.label("first_person"),
            Second.verdict.label("second"),
        )
        .select_from(second)
        .join(Second, Second.id == second.c.id)
        .join(first, first.c.segment_id == Second.segment_id)
        .join(First, First.id == first.c.id)
        .where(First.verdict.in_(JUDGED), Second.verdict.in_(JUDGED))
    )
    pairs = pairs.where(First.verdict != Second.verdict) if differing else pairs
    return pairs.cte("judged").prefix_with("MATERIALIZED", dialect="postgresql")


def _latest_first(compared: CTE) -> Subquery:
    # a run's carrying repeats what was said before it
    before = or_(Decision.id <= compared.c.first_decision_id, Decision.kind == "carry")
    return (
        select(Decision.segment_id, func.max(Decision.id).label("id"))
        .join(compared, compared.c.image_id == Decision.image_id)
        .where(before)
        .group_by(Decision.segment_id)
        .subquery("latest_first")
    )


def _latest_second(compared: CTE) -> Subquery:
    # one of each candidate, though runs replaced its segment while it was being judged
    judged = select(SecondDecision.segment_id).join(compared, compared.c.id == SecondDecision.second_review_id)
    last = last_of_each(judged, "succession")
    return (
        select(func.max(SecondDecision.id).label("id"))
        .join(compared, compared.c.id == SecondDecision.second_review_id)
        .join(last, last.c.segment_id == SecondDecision.segment_id)
        .where(SecondDecision.created_at <= compared.c.done_at)
        .group_by(SecondDecision.second_review_id, last.c.last_id)
        .subquery("latest_second")
    )
