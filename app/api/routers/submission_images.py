"""Images of a submission: numbers, outcomes of every segment, pictures, comparisons."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query, Response

from app.api.deps import Cursor, Limit, Now, Reader, ServerDep, ViewerDep
from app.api.problems import answers
from app.api.schemas.base import RowId
from app.api.schemas.submission_images import (
    ComparisonAnswer,
    ImageScorePage,
    MatchesAnswer,
    ReviewRequest,
    ReviewSent,
    ScoredImageAnswer,
)
from app.services import scored_images, submission_images
from app.services.comparisons import compare_submissions
from app.services.false_positives import send_to_review
from app.services.split_images import entry
from app.services.submission_access import get_detailed
from app.services.submission_matches import matches_of

router = APIRouter(responses=answers(404, 409))
IMAGE = "/submissions/{submission_id}/images/{split_image_id}"
BINARY = {200: {"content": {"application/octet-stream": {"schema": {"type": "string", "format": "binary"}}}}}
PNG = {200: {"content": {"image/png": {"schema": {"type": "string", "format": "binary"}}}}}
Sort = Annotated[str, Query(max_length=60, description="A metric or `name`; with `-` the largest first.")]
Search = Annotated[str | None, Query(max_length=300, description="Part of the name.")]


@router.get("/submissions/{submission_id}/images")
def list_images(
    session: Reader,
    viewer: ViewerDep,
    submission_id: RowId,
    sort: Sort = "name",
    search: Search = None,
    limit: Limit = 100,
    cursor: Cursor = None,
) -> ImageScorePage:
    """List the images of a submission with their numbers, sorted by any of them; undefined ones come last."""
    submission = get_detailed(session, viewer, submission_id)
    score = submission_images.newest_score(session, submission)
    split = submission.split_version.split
    page = submission_images.list_image_scores(
        session, split, score, sort=sort, search=search, limit=limit, cursor=cursor
    )
    return ImageScorePage.model_validate(page)


@router.get(IMAGE)
def read_image(
    server: ServerDep,
    session: Reader,
    viewer: ViewerDep,
    submission_id: RowId,
    split_image_id: RowId,
    sort: Sort = "name",
    search: Search = None,
) -> ScoredImageAnswer:
    """Return one image segment by segment, with the images before and after it in the given order."""
    submission = get_detailed(session, viewer, submission_id)
    score = submission_images.newest_score(session, submission)
    scored = scored_images.scored_segments(session, server.desk.sets, submission, score, split_image_id)
    place = submission_images.neighbours(session, score, split_image_id, sort=sort, search=search)
    pixels = entry(submission.split_version.split, scored.image)
    return ScoredImageAnswer.model_validate(
        {
            **vars(place),
            "image_id": scored.image.id,
            "name": scored.image.name,
            "width": scored.image.width,
            "height": scored.image.height,
            "original": pixels.original,
            "display": pixels.display,
            "thumbnail": pixels.thumbnail,
            "metrics": scored.numbers.metrics or {},
            "truth": scored_images.label_entries(scored),
            "predictions": scored_images.prediction_entries(scored),
            "review_target": scored_images.review_target(session, scored.image),
        }
    )


@router.get(
    "/submissions/{submission_id}/images/{split_image_id}/points", response_class=Response, responses={**BINARY}
)
def read_points(
    server: ServerDep, session: Reader, viewer: ViewerDep, submission_id: RowId, split_image_id: RowId
) -> Response:
    """Return the points of labels and predictions in one binary answer, in the form of an image's candidates.

    The L labels have the ids 0 to L - 1, the P predictions L to L + P - 1.
    """
    submission = get_detailed(session, viewer, submission_id)
    score = submission_images.newest_score(session, submission)
    scored = scored_images.scored_segments(session, server.desk.sets, submission, score, split_image_id)
    content = scored_images.points_of(scored)
    return Response(content, media_type="application/octet-stream", headers={"Cache-Control": "no-cache"})


@router.get(
    "/submissions/{submission_id}/images/{split_image_id}/overlay.png", response_class=Response, responses={**PNG}
)
def read_overlay(
    server: ServerDep, session: Reader, viewer: ViewerDep, submission_id: RowId, split_image_id: RowId
) -> Response:
    """Return the image with hits (green), false alarms (red, dashed) and misses (orange, dotted), and a legend."""
    submission = get_detailed(session, viewer, submission_id)
    score = submission_images.newest_score(session, submission)
    scored = scored_images.scored_segments(session, server.desk.sets, submission, score, split_image_id)
    content = scored_images.overlay_of(scored, server.blobs, max_pixels=server.settings.max_image_pixels)
    return Response(content, media_type="image/png", headers={"Cache-Control": "no-cache"})


@router.post(IMAGE + "/review")
def send_false_positives(
    server: ServerDep,
    viewer: ViewerDep,
    now: Now,
    submission_id: RowId,
    split_image_id: RowId,
    given: ReviewRequest,
) -> ReviewSent:
    """Put false positives into the image's candidates, undecided: perhaps the label is what is missing."""
    with server.database.write() as session:
        submission = get_detailed(session, viewer, submission_id)
        score = submission_images.newest_score(session, submission)
        scored = scored_images.scored_segments(session, server.desk.sets, submission, score, split_image_id)
        sent = send_to_review(session, viewer, submission_id, scored, given.predictions, now)
        return ReviewSent.model_validate(sent)


@router.get("/submissions/{submission_id}/matches")
def read_matches(session: Reader, viewer: ViewerDep, submission_id: RowId) -> MatchesAnswer:
    """Return what became of every segment of every image."""
    submission = get_detailed(session, viewer, submission_id)
    score = submission_images.newest_score(session, submission)
    return MatchesAnswer.model_validate(matches_of(session, submission, score))


@router.get("/submissions/{submission_id}/compare/{other}")
def compare(session: Reader, viewer: ViewerDep, submission_id: RowId, other: RowId) -> ComparisonAnswer:
    """Compare two submissions on the same images: differences are `other` minus this one, paired."""
    first, second = get_detailed(session, viewer, submission_id), get_detailed(session, viewer, other)
    return ComparisonAnswer.model_validate(compare_submissions(session, first, second))
