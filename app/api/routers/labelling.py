"""Candidates of an image, decisions on them, and the image's review."""

from __future__ import annotations

from fastapi import APIRouter, Response

from app.api.deps import Now, Reader, ServerDep, ViewerDep
from app.api.problems import answers
from app.api.schemas.base import RowId
from app.api.schemas.labelling import (
    DecisionsGiven,
    DecisionsStored,
    History,
    ReviewAnswer,
    ReviewGiven,
    SegmentsAnswer,
)
from app.services import labelling, reviews

router = APIRouter(prefix="/images/{image_id}", tags=["labelling"], responses=answers(404))


@router.get("/segments")
def read_segments(session: Reader, image_id: RowId) -> SegmentsAnswer:
    """Return the current candidates of an image, without their points."""
    return SegmentsAnswer.model_validate(labelling.segments_of_image(session, image_id))


@router.get(
    "/points",
    response_class=Response,
    responses={200: {"content": {"application/octet-stream": {"schema": {"type": "string", "format": "binary"}}}}},
)
def read_points(session: Reader, image_id: RowId) -> Response:
    """Return the points of the current candidates in one binary answer, little endian.

    The bytes ``CLP1``, then uint32 revision, S and N, then S uint32 segment ids, S + 1 uint32 offsets and N pairs of
    float32 x, y in px. Segment s is ``points[offsets[s]:offsets[s + 1]]``.
    """
    content = labelling.points_of_image(session, image_id)
    return Response(content, media_type="application/octet-stream", headers={"Cache-Control": "no-cache"})


@router.get("/decisions")
def read_decisions(session: Reader, image_id: RowId) -> History:
    """Return all decisions on an image, oldest first."""
    return History.model_validate({"decisions": labelling.history(session, image_id)})


@router.post("/decisions", responses=answers(409))
def decide(server: ServerDep, viewer: ViewerDep, now: Now, image_id: RowId, given: DecisionsGiven) -> DecisionsStored:
    """Store verdicts; all of them or none. A decision whose ``client_id`` is known already changes nothing."""
    with server.database.write() as session:
        stored = labelling.decide(session, image_id, given.decisions, person=viewer.name, now=now)
        return DecisionsStored.model_validate(stored)


@router.put("/review", responses=answers(409))
def set_review(server: ServerDep, viewer: ViewerDep, now: Now, image_id: RowId, given: ReviewGiven) -> ReviewAnswer:
    """Say how far the people are with an image. ``done`` is refused while candidates are undecided."""
    with server.database.write() as session:
        review = reviews.set_review(
            session,
            image_id,
            given.status,
            reason=given.reason,
            allow_undecided=given.allow_undecided,
            person=viewer.name,
            now=now,
        )
        return ReviewAnswer.model_validate(review)
