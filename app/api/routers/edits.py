"""Edits of an image's segments by hand, and the tracing of edges that they begin with."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from fastapi import APIRouter
from numpy.typing import NDArray

from app.api.deps import Now, Reader, Server, ServerDep, ViewerDep
from app.api.problems import answers
from app.api.schemas.base import RowId
from app.api.schemas.edits import EditGiven, EditsAnswer, EditStored, TraceAnswer, TraceGiven
from app.jobs.tracing import Wanted
from app.services import edits, stored_edits
from app.services.edited_points import EditedImage, Points, edited_image, made_polylines, require_inside

router = APIRouter(prefix="/images/{image_id}", tags=["labelling"], responses=answers(404))

REACH_AT_A_JOIN = 3.0
"""px; the ends of segments lie on their edge."""


@router.post("/trace", responses=answers(503))
def trace(server: ServerDep, image_id: RowId, given: TraceGiven) -> TraceAnswer:
    """Trace the edge between two to twenty points, or beyond both ends of a segment; nothing is stored.

    The points are those that the pipeline measures. 422 with the code ``no-edge`` where no edge runs; with
    ``straight`` the line as drawn comes back instead, bent as the image's lens bends a straight line.
    """
    with server.database.read() as session:  # given back before the image is decoded
        image = edited_image(session, image_id, [] if given.segment_id is None else [given.segment_id])
    how = "extend" if given.extend else "straight" if given.straight else "edge"
    points = np.array(given.points, np.float64) if given.points is not None else image.polylines[0]
    found = server.tracer.trace(_wanted(image, points, how, given.reach))
    return TraceAnswer(points=found.points.tolist(), length=found.length, residual=found.residual)


@router.get("/edits")
def read_edits(session: Reader, image_id: RowId) -> EditsAnswer:
    """Return all edits of an image, oldest first."""
    return EditsAnswer.model_validate({"edits": stored_edits.edits_of_image(session, image_id)})


@router.post("/edits", responses=answers(409, 413, 503))
def edit(server: ServerDep, viewer: ViewerDep, now: Now, image_id: RowId, given: EditGiven) -> EditStored:
    """Replace segments by others, all or nothing. An edit whose ``client_id`` is known already changes nothing.

    What comes is of origin ``manual`` and kept; the parts of a cut have the verdict of what was cut. Decisions of kind
    ``undo`` and ``redo`` whose ``target_group_id`` is the ``client_id`` take it back and do it again. 409 with the code
    ``stale-edit`` when a segment was changed meanwhile, and in `details.current` what took its place. With ``seen``,
    409 with the code ``stale-verdict`` when someone else decided on a segment after it and the edit would overrule it.
    """
    adds = None if given.adds is None else tuple(np.array(points, np.float64) for points in given.adds)
    wanted = stored_edits.EditGiven(given.client_id, given.kind, tuple(given.replaces), adds, given.seen)
    if adds is None and given.kind != "trace":
        with server.database.read() as session:
            known = stored_edits.stored_edit(session, image_id, wanted)
        if known is not None:  # sent again: the edge isn't traced again
            return EditStored.model_validate(known)
        wanted = replace(wanted, adds=tuple(_made(server, image_id, given)))
    with server.database.write() as session:
        return EditStored.model_validate(edits.store_edit(session, image_id, wanted, viewer.name, now))


def _made(server: Server, image_id: int, given: EditGiven) -> list[Points]:
    """Make what an edit adds of what it replaces, before anything is written."""
    edits.require_number(given.kind, given.replaces)
    with server.database.read() as session:
        image = edited_image(session, image_id, given.replaces)
    require_inside(given.at, image)

    def traced(points: NDArray[Any], how: str) -> Points:
        return server.tracer.trace(_wanted(image, points, how, REACH_AT_A_JOIN)).points

    return made_polylines(given.kind, image.polylines, given.at, traced)


def _wanted(image: EditedImage, points: NDArray[Any], how: str, reach: float) -> Wanted:
    return Wanted(image.sha256, image.name, image.distortion, np.asarray(points, np.float64), how, reach)
