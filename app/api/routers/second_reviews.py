"""Second reviews: begin one, judge without seeing the first, finish."""

from __future__ import annotations

from fastapi import APIRouter

from app.api.deps import Now, Reader, ServerDep, ViewerDep
from app.api.problems import answers
from app.api.schemas.base import RowId
from app.api.schemas.second_reviews import (
    SecondDecisionsGiven,
    SecondDecisionsStored,
    SecondHistory,
    SecondReviewAnswer,
    SecondReviewGiven,
    SecondReviewsAnswer,
    SecondSegmentsAnswer,
)
from app.services import second_reviews, second_verdicts
from app.services.datasets import get_dataset

router = APIRouter(tags=["second reviews"], responses=answers(404))


@router.get("/datasets/{slug}/second-reviews")
def list_second_reviews(session: Reader, viewer: ViewerDep, slug: str) -> SecondReviewsAnswer:
    """List a dataset's second reviews, and the images that you can begin one of.

    Which images are due follows from their content and the dataset's rule `second_share`.
    """
    found = second_reviews.second_reviews_of(session, get_dataset(session, slug), viewer.name)
    return SecondReviewsAnswer.model_validate(found)


@router.post("/images/{image_id}/second-review", responses=answers(409))
def begin_second_review(server: ServerDep, viewer: ViewerDep, now: Now, image_id: RowId) -> SecondReviewAnswer:
    """Begin a second review of an image, or return your own.

    409 with the code `not-blind` when you took part in the first, `second-review-taken` when another person has it.
    """
    with server.database.write() as session:
        return SecondReviewAnswer.model_validate(
            second_reviews.start_second_review(session, image_id, viewer.name, now)
        )


@router.get("/second-reviews/{second_review_id}/segments")
def read_second_segments(session: Reader, viewer: ViewerDep, second_review_id: RowId) -> SecondSegmentsAnswer:
    """Return the image's candidates with your verdicts of this review alone; their points are the image's."""
    review, _ = second_reviews.own_second_review(session, second_review_id, viewer.name)
    return SecondSegmentsAnswer.model_validate(second_verdicts.second_segments(session, review))


@router.get("/second-reviews/{second_review_id}/decisions")
def read_second_decisions(session: Reader, viewer: ViewerDep, second_review_id: RowId) -> SecondHistory:
    """Return all decisions of your second review, oldest first."""
    review, _ = second_reviews.own_second_review(session, second_review_id, viewer.name)
    return SecondHistory.model_validate({"decisions": second_verdicts.second_history(session, review)})


@router.post("/second-reviews/{second_review_id}/decisions", responses=answers(409))
def decide_second(
    server: ServerDep, viewer: ViewerDep, now: Now, second_review_id: RowId, given: SecondDecisionsGiven
) -> SecondDecisionsStored:
    """Store verdicts of your second review; all of them or none. Sending one again changes nothing."""
    with server.database.write() as session:
        review, _ = second_reviews.own_second_review(session, second_review_id, viewer.name, lock=True)
        stored = second_verdicts.decide_second(session, review, given.decisions, viewer.name, now)
        return SecondDecisionsStored.model_validate(stored)


@router.put("/second-reviews/{second_review_id}/review", responses=answers(409))
def set_second_review(
    server: ServerDep, viewer: ViewerDep, now: Now, second_review_id: RowId, given: SecondReviewGiven
) -> SecondReviewAnswer:
    """Say that your second review is done, or open again. `done` is refused while candidates are undecided."""
    with server.database.write() as session:
        entry = second_reviews.set_second_review(
            session, second_review_id, given.status, viewer.name, now, allow_undecided=given.allow_undecided
        )
        return SecondReviewAnswer.model_validate(entry)
