"""How far the people are with an image: open, done or discarded."""

from __future__ import annotations

from datetime import datetime

from sqlalchemy.orm import Session

from app.db.models import RECALLS, REVIEW_STATES, Image, Review, Segment
from app.errors import Conflict, InvalidInput, UndecidedLeft
from app.services.candidates import current_segments
from app.services.counts import verdict_counts
from app.services.dataset_rules import rules_of
from app.services.events import record_event
from app.services.images import dataset_of, get_image

REASON_LENGTH = 2_000


class RecallAsked(Conflict):
    """The dataset's rules ask how complete the labels are, and it wasn't told."""

    code = "recall-asked"


def set_review(
    session: Session,
    image_id: int,
    status: str,
    *,
    now: datetime,
    reason: str | None = None,
    allow_undecided: bool = False,
    recall: str | None = None,
    person: str | None = None,
) -> Review:
    """Say how far the people are with an image.

    Args:
        session: A writing session.
        image_id: The image.
        status: ``open``, ``done`` or ``discarded``.
        now: Time of the change.
        reason: Why, above all for discarding.
        allow_undecided: Done although candidates are undecided, or although nobody has looked for any.
        recall: How much of what is straight the labels hold; asked for when the dataset's rules say so.
        person: Who says so.

    Raises:
        NotFound: When there is no such image, or it is deleted.
        InvalidInput: On an unknown status or recall, or a reason too long.
        UndecidedLeft: When it should be done and candidates wait for a verdict.
        RecallAsked: When it should be done, the rules ask for the recall, and it isn't told.
        Conflict: When it should be done and was never pre-labelled or labelled.
    """
    if status not in REVIEW_STATES:
        raise InvalidInput(f"{status!r} is no review status", where="status", expected=", ".join(REVIEW_STATES))
    reason = (reason or "").strip() or None
    if reason and (len(reason) > REASON_LENGTH or "\0" in reason):
        raise InvalidInput(
            "the reason is too long or holds a NUL character",
            where="reason",
            expected=f"at most {REASON_LENGTH} characters of text",
        )
    if recall is not None and (recall not in RECALLS or status != "done"):
        raise InvalidInput(
            f"{recall!r:.60} can't be the recall",
            where="recall",
            expected=f"{', '.join(RECALLS)}, with the status done",
        )
    get_image(session, image_id)
    image = session.get_one(Image, image_id, with_for_update=True, populate_existing=True)
    if status == "done" and not allow_undecided:
        _require_decided(session, image)
    if status == "done" and recall is None:
        _require_no_question(session, image)
    review = session.get(Review, image.id) or Review(image_id=image.id, status="open", updated_at=now)
    session.add(review)
    before = review.status
    if (before, review.reason, review.recall) != (status, reason, recall):
        review.status = status
        review.reason = reason
        review.recall = recall
        review.person = person
        review.updated_at = now
        details = {"image": image.id, "from": before, "to": status, "reason": reason, "recall": recall}
        record_event(session, "image.reviewed", now, dataset_id=image.dataset_id, person=person, details=details)
    session.flush()
    return review


def _require_no_question(session: Session, image: Image) -> None:
    if rules_of(dataset_of(session, image)).ask_recall:
        raise RecallAsked(
            "how complete are the labels of this image?", where=image.name, expected=f"recall: {', '.join(RECALLS)}"
        )


def _require_decided(session: Session, image: Image) -> None:
    undecided = verdict_counts(image.n_candidates, image.n_keep, image.n_reject, image.n_ambiguous).undecided
    if undecided:
        raise UndecidedLeft(
            f"{undecided} candidates wait for a verdict" if undecided > 1 else "one candidate waits for a verdict",
            where=image.name,
            hint="decide on them, or reject all that are left",
            details={"undecided": undecided},
        )
    labelled = session.scalar(current_segments(Segment.id).where(Segment.image_id == image.id).limit(1))
    if image.current_run_image_id is None and labelled is None:
        raise Conflict(
            "the image was never pre-labelled nor labelled",
            where=image.name,
            hint="start a run, or say that there is nothing to label",
        )
