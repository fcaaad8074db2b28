"""Candidates of an image, decisions on them, and the image's review."""

from __future__ import annotations

from typing import Annotated, Literal

from fastapi import APIRouter, Query, Response
from pydantic_core import to_json

from app.api.deps import Now, Reader, ServerDep, ViewerDep
from app.api.problems import answers
from app.api.schemas.base import RowId
from app.api.schemas.labelling import (
    DecisionsGiven,
    DecisionsStored,
    History,
    NeighbourVerdict,
    ReviewAnswer,
    ReviewGiven,
    SegmentsAnswer,
)
from app.services import labelling, reviews
from app.services.neighbour_verdicts import frames_to_match, neighbour_verdicts
from app.services.viewed_points import undistorted_points

router = APIRouter(prefix="/images/{image_id}", tags=["labelling"], responses=answers(404))


@router.get("/segments", response_model=SegmentsAnswer)
def read_segments(session: Reader, image_id: RowId) -> Response:
    """Return the current candidates of an image, without their points."""
    found = labelling.segments_of_image(session, image_id)
    # not through the answer's model: to check thousands of our own rows takes as long as to read them
    content = to_json({**vars(found), "segments": [entry._asdict() for entry in found.segments]})
    return Response(content, media_type="application/json")


@router.get(
    "/points",
    response_class=Response,
    responses={
        200: {"content": {"application/octet-stream": {"schema": {"type": "string", "format": "binary"}}}},
        **answers(409),
    },
)
def read_points(
    session: Reader,
    image_id: RowId,
    view: Annotated[
        Literal["plain", "undistorted"], Query(description="Places in the image, or in its undistorted display.")
    ] = "plain",
) -> Response:
    """Return the points of the current candidates in one binary answer, little endian.

    The bytes ``CLP1``, then uint32 revision, S and N, then S uint32 segment ids, S + 1 uint32 offsets and N pairs of
    float32 x, y in px. Segment s is ``points[offsets[s]:offsets[s + 1]]``.
    """
    content = labelling.points_of_image(session, image_id) if view == "plain" else undistorted_points(session, image_id)
    return Response(content, media_type="application/octet-stream", headers={"Cache-Control": "no-cache"})


@router.get("/decisions")
def read_decisions(session: Reader, image_id: RowId) -> History:
    """Return all decisions on an image, oldest first."""
    return History.model_validate({"decisions": labelling.history(session, image_id)})


@router.get("/neighbour_verdicts", responses=answers(503))
def read_neighbour_verdicts(server: ServerDep, image_id: RowId) -> list[NeighbourVerdict]:
    """Return verdicts of the same edges in the frames before and after, for candidates that are undecided here."""
    with server.database.read() as session:  # given back before the frames are matched
        frames = frames_to_match(session, image_id)
    with server.decoding.place():  # as long as decoding, and as large
        verdicts = neighbour_verdicts(frames)
    return [NeighbourVerdict.model_validate(found) for found in verdicts]


@router.post("/decisions", responses=answers(409))
def decide(server: ServerDep, viewer: ViewerDep, now: Now, image_id: RowId, given: DecisionsGiven) -> DecisionsStored:
    """Store verdicts; all of them or none. A decision whose ``client_id`` is known already changes nothing.

    With ``seen``, 409 with the code ``stale-verdict`` when someone else decided differently after it, and in
    `details.conflicts` of each `client_id`, `segment_id`, `yours`, `theirs` (`verdict`, `person`, `created_at`,
    `decision_id`).
    """
    with server.database.write() as session:
        stored = labelling.decide(session, image_id, given.decisions, person=viewer.name, now=now, seen=given.seen)
        return DecisionsStored.model_validate(stored)


@router.put("/review", responses=answers(409))
def set_review(server: ServerDep, viewer: ViewerDep, now: Now, image_id: RowId, given: ReviewGiven) -> ReviewAnswer:
    """Say how far the people are with an image. ``done`` is refused while candidates are undecided.

    409 with the code `recall-asked` when the dataset's rules ask for the recall and it isn't told.
    """
    with server.database.write() as session:
        review = reviews.set_review(
            session,
            image_id,
            given.status,
            reason=given.reason,
            allow_undecided=given.allow_undecided,
            recall=given.recall,
            person=viewer.name,
            now=now,
        )
        return ReviewAnswer.model_validate(review)
