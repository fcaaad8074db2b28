"""Second reviews: a share of the images is judged again by another person, who is told nothing of the first review."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.db.models import SECOND_REVIEW_STATES, Dataset, Image, Review, SecondReview
from app.errors import Conflict, Forbidden, InvalidInput, NotFound, UndecidedLeft
from app.services.dataset_rules import rules_of
from app.services.due_second_reviews import DueImage, due_images
from app.services.events import record_event
from app.services.images import get_image
from app.services.people import first_reviewers
from app.services.second_verdicts import second_counts
from app.services.stale_verdicts import last_decision_id

MOST_LISTED = 1_000


class NotBlind(Conflict):
    """Who reviewed an image first can't review it a second time."""

    code = "not-blind"


class SecondReviewTaken(Conflict):
    """Another person reviews the image a second time already."""

    code = "second-review-taken"


@dataclass(frozen=True)
class SecondReviewEntry:
    """A second review, and how far it is.

    Attributes:
        mine: Whether it is the one's who asks.
    """

    id: int
    image_id: int
    name: str
    person: str | None
    mine: bool
    status: str
    created_at: datetime
    done_at: datetime | None


@dataclass(frozen=True)
class SecondReviews:
    """The second reviews of a dataset.

    Attributes:
        share: Of the images that are to be reviewed twice.
        due: Images that the person who asks can begin with, by name; at most ``MOST_LISTED``.
        due_total: Their number.
        reviews: Begun ones, the person's own before the others.
    """

    share: float
    due: tuple[DueImage, ...]
    due_total: int
    reviews: tuple[SecondReviewEntry, ...]


def second_reviews_of(session: Session, dataset: Dataset, person: str | None) -> SecondReviews:
    """Return the second reviews of a dataset, and what a person can begin with."""
    share = rules_of(dataset).second_share
    due = due_images(dataset, share, person)
    total = session.scalar(due.with_only_columns(func.count(Image.id))) or 0
    found = session.execute(due.order_by(Image.name, Image.id).limit(MOST_LISTED))
    begun = session.execute(
        select(SecondReview, Image.name)
        .join(Image, Image.id == SecondReview.image_id)
        .where(Image.dataset_id == dataset.id, Image.deleted_at.is_(None))
        .order_by(Image.name, SecondReview.id)
    )
    entries = [_entry(review, name, person) for review, name in begun]
    return SecondReviews(
        share,
        tuple(DueImage(*row) for row in found),
        total,
        tuple(sorted(entries, key=lambda entry: (not entry.mine, entry.status == "done"))),
    )


def start_second_review(session: Session, image_id: int, person: str | None, now: datetime) -> SecondReviewEntry:
    """Begin a second review, or return one's own.

    Args:
        session: A writing session.
        image_id: An image whose first review is done; it needn't be in the dataset's share.
        person: Who begins.
        now: When.

    Raises:
        NotFound: When there is no such image, or it is deleted.
        NotBlind: When the person took part in the first review.
        SecondReviewTaken: When another person has begun or done it.
        Conflict: When the first review isn't done.
    """
    get_image(session, image_id)
    image = session.get_one(Image, image_id, with_for_update=True)
    known = session.scalars(select(SecondReview).where(SecondReview.image_id == image_id)).one_or_none()
    if known is not None and known.person != person:
        raise SecondReviewTaken(f"{known.person or 'someone else'} reviews this image", where=image.name)
    if known is None:
        _require_blind(session, image, person)
        known = SecondReview(
            image_id=image_id,
            person=person,
            status="open",
            first_decision_id=last_decision_id(session, image_id),
            created_at=now,
        )
        session.add(known)
        session.flush()
        details = {"image": image_id, "second_review": known.id}
        record_event(session, "second-review.begun", now, dataset_id=image.dataset_id, person=person, details=details)
    return _entry(known, image.name, person)


def own_second_review(
    session: Session, second_review_id: int, person: str | None, *, lock: bool = False
) -> tuple[SecondReview, Image]:
    """Return a person's own second review and its image.

    Raises:
        NotFound: When there is none, or its image is deleted.
        Forbidden: When it is another person's.
    """
    review = session.get(SecondReview, second_review_id, with_for_update=lock)
    if review is None:
        raise NotFound(f"there is no second review {second_review_id}")
    image = get_image(session, review.image_id)
    if review.person != person:
        raise Forbidden(f"this is {review.person or 'another person'}'s review", where=image.name)
    return review, image


def set_second_review(
    session: Session,
    second_review_id: int,
    status: str,
    person: str | None,
    now: datetime,
    *,
    allow_undecided: bool = False,
) -> SecondReviewEntry:
    """Say that one's second review is done, or open again; what is changed then was no longer judged blindly.

    Args:
        session: A writing session.
        second_review_id: The review.
        status: ``open`` or ``done``.
        person: Whose it is.
        now: When.
        allow_undecided: Done although candidates are undecided: they count for nothing then.

    Raises:
        NotFound: When there is none, or its image is deleted.
        Forbidden: When it is another person's.
        InvalidInput: On an unknown status.
        UndecidedLeft: When it should be done and candidates wait for a verdict.
    """
    if status not in SECOND_REVIEW_STATES:
        raise InvalidInput(f"{status!r} is no status", where="status", expected=", ".join(SECOND_REVIEW_STATES))
    review, image = own_second_review(session, second_review_id, person, lock=True)
    undecided = second_counts(session, review).undecided
    if status == "done" and undecided and not allow_undecided:
        raise UndecidedLeft(
            f"{undecided} candidates wait for a verdict" if undecided > 1 else "one candidate waits for a verdict",
            where=image.name,
            hint="decide on them, or reject all that are left",
            details={"undecided": undecided},
        )
    if review.status != status:
        review.status, review.done_at = status, review.done_at or now  # from the first time on differences are shown
        details = {"image": image.id, "second_review": review.id, "to": status}
        record_event(session, "second-review.changed", now, dataset_id=image.dataset_id, person=person, details=details)
        session.flush()
    return _entry(review, image.name, person)


def _require_blind(session: Session, image: Image, person: str | None) -> None:
    review = session.get(Review, image.id)
    if review is None or review.status != "done":
        raise Conflict("the first review of this image isn't done", where=image.name)
    if person is None or person in first_reviewers(session, [image.id])[image.id]:
        raise NotBlind(
            f"{person or 'nobody'} can't review this image a second time",
            where=image.name,
            expected="a person who took no part in the first review",
        )


def _entry(review: SecondReview, name: str, person: str | None) -> SecondReviewEntry:
    return SecondReviewEntry(
        id=review.id,
        image_id=review.image_id,
        name=name,
        person=review.person,
        mine=review.person == person,
        status=review.status,
        created_at=review.created_at,
        done_at=review.done_at,
    )
