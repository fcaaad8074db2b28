"""Verdicts of a second review: its candidates as if nobody had judged them, but for what its own person said."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.db.models import SecondDecision, SecondReview, Segment
from app.errors import Conflict
from app.services.candidates import is_current
from app.services.counts import VerdictCounts
from app.services.decision_batch import (
    DecisionGiven,
    new_wishes,
    require_known_groups,
    second_ledger,
    segments_named,
)
from app.services.labelling import SegmentEntry, segments_of_image
from app.services.successors import last_of_each, successors_of


@dataclass(frozen=True)
class SecondSegments:
    """The current segments of an image, with the verdicts of one second review.

    Attributes:
        revision: Of the image.
        status: Of the second review.
        segments: In the order of ``points_of_image``, without those that a hand drew: whoever did kept them. They tell
            neither reasons nor where they come from.
    """

    second_review_id: int
    image_id: int
    revision: int
    width: int
    height: int
    status: str
    segments: tuple[SegmentEntry, ...]


@dataclass(frozen=True)
class SecondStored:
    """What became of a request.

    Attributes:
        stored: Decisions that are new.
        repeated: Decisions that were known by their client id.
        verdicts: The image's current segments, without those that a hand drew, by verdict of this review.
        status: Of this review.
    """

    stored: int
    repeated: int
    verdicts: VerdictCounts
    status: str


def second_segments(session: Session, review: SecondReview) -> SecondSegments:
    """Return the image's current segments with the verdicts of a second review."""
    image = segments_of_image(session, review.image_id)
    mine = latest_verdicts(session, review.id)
    return SecondSegments(
        review.id,
        image.image_id,
        image.revision,
        image.width,
        image.height,
        review.status,
        tuple(
            entry._replace(verdict=mine.get(entry.id, "undecided"), reason=None, origin="pipeline")
            for entry in image.segments
            if entry.origin != "manual"
        ),
    )


def decide_second(
    session: Session, review: SecondReview, decisions: Sequence[DecisionGiven], person: str | None, now: datetime
) -> SecondStored:
    """Store decisions of a second review by the rules of the first: all of them or none, each once.

    Args:
        session: A writing session.
        review: The review, locked.
        decisions: 1 to 5,000, oldest first.
        person: Whose review it is.
        now: Time of the request.

    Raises:
        InvalidInput: On a segment of another image, an unknown verdict or kind, an undo of what wasn't done.
        Conflict: When a client id is known with another content, or the review is done.
        TooLarge: On more than 5,000 decisions.
    """
    ledger = second_ledger(review.id)
    wishes = new_wishes(session, ledger, decisions)
    successors = successors_of(session, segments_named(session, review.image_id, wishes))
    require_known_groups(session, ledger, wishes)
    if wishes and review.status == "done":
        raise Conflict("this second review is done", hint="open it again first")
    verdicts = latest_verdicts(session, review.id)
    rows: list[SecondDecision] = []
    for wish in wishes:
        successor = successors.get(wish.segment_id)
        stands_for = wish.segment_id if successor is None else successor.id
        rows.append(
            SecondDecision(
                second_review_id=review.id,
                segment_id=wish.segment_id,
                person=person,
                verdict=wish.verdict,
                previous=verdicts.get(stands_for, "undecided"),
                kind=wish.kind,
                client_id=wish.client_id,
                group_id=wish.group_id,
                target_group_id=wish.target_group_id,
                elapsed_ms=wish.elapsed_ms,
                created_at=now,
            )
        )
        verdicts[stands_for] = wish.verdict
    session.add_all(rows)
    session.flush()
    counts = second_counts(session, review)
    return SecondStored(len(wishes), len(decisions) - len(wishes), counts, review.status)


def second_history(session: Session, review: SecondReview) -> Sequence[SecondDecision]:
    """Return all decisions of a second review, oldest first."""
    query = select(SecondDecision).where(SecondDecision.second_review_id == review.id)
    return session.scalars(query.order_by(SecondDecision.id)).all()


def second_counts(session: Session, review: SecondReview) -> VerdictCounts:
    """Return the image's current segments, without those that a hand drew, by verdict of a second review."""
    verdicts = latest_verdicts(session, review.id)
    of_image = (Segment.image_id == review.image_id) & (Segment.origin != "manual")
    current = session.scalars(select(Segment.id).where(of_image, is_current()))
    return VerdictCounts(**Counter(verdicts.get(segment_id, "undecided") for segment_id in current))


def latest_verdicts(session: Session, second_review_id: int) -> dict[int, str]:
    """Return the standing verdicts of a second review by segment.

    Those on segments that runs replaced stand for the segments that took their place.
    """
    of_review = SecondDecision.second_review_id == second_review_id
    last = last_of_each(select(SecondDecision.segment_id).where(of_review), "succession")
    latest = (
        select(last.c.last_id, func.max(SecondDecision.id).label("id"))
        .join(SecondDecision, SecondDecision.segment_id == last.c.segment_id)
        .where(of_review)
        .group_by(last.c.last_id)
        .subquery()
    )
    rows = session.execute(
        select(latest.c.last_id, SecondDecision.verdict).join(SecondDecision, SecondDecision.id == latest.c.id)
    )
    return dict(rows.all())
