"""One segment: how it was found, and what speaks for it."""

from __future__ import annotations

from fastapi import APIRouter

from app.api.deps import ServerDep
from app.api.problems import answers
from app.api.schemas.base import RowId
from app.api.schemas.evidence import Evidence
from app.api.schemas.segments import StageHistory
from app.services.evidence import measure_evidence, subject_of
from app.services.segment_history import detection_behind

router = APIRouter(prefix="/segments/{segment_id}", tags=["labelling"], responses=answers(404))


@router.get("/history", responses=answers(503))
def read_history(server: ServerDep, segment_id: RowId) -> StageHistory:
    """Return how a candidate was found: its pieces, what joined them, what was added and cut, and its score's parts.

    Nothing of it is stored: the image is detected again with the run's parameters. 404 with the code ``no-history``
    when a person drew the segment, it was imported, or another version of the detector found it.
    """
    with server.database.read() as session:  # given back before the detection, which takes seconds on a large image
        found = detection_behind(session, segment_id)
    return StageHistory.model_validate(server.histories.tell(found))


@router.get("/evidence")
def read_evidence(server: ServerDep, segment_id: RowId) -> Evidence:
    """Return what speaks for a candidate, measured along it: deviation from straight under the lens, and contrast."""
    with server.database.read() as session:  # given back before the image is decoded
        subject = subject_of(session, segment_id)
    with server.decoding.place():
        content = server.blobs.read(subject.sha256)
        found = measure_evidence(subject, content, max_pixels=server.settings.max_image_pixels)
    return Evidence.model_validate(found)
