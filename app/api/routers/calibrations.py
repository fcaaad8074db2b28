"""Calibrations: watch, cancel, delete and restore them; their lines, images and advice."""

from __future__ import annotations

from fastapi import APIRouter, Response
from pydantic_core import to_json

from app.api.deps import Cursor, Limit, Now, Reader, ServerDep, ViewerDep
from app.api.problems import answers
from app.api.schemas.base import RowId
from app.api.schemas.calibrations import (
    Advice,
    CalibrationAnswer,
    CalibrationBrief,
    CalibrationImage,
    CalibrationLinePage,
    ImageLines,
)
from app.api.schemas.datasets import Deleted
from app.services import calibration_images, calibration_summaries, calibrations
from app.services.calibration_advice import advice_of
from app.services.calibration_lines import LineOrder, list_lines

router = APIRouter(prefix="/calibrations/{calibration_id}", tags=["cameras"], responses=answers(404))


@router.get("", response_model=CalibrationAnswer)
def read_calibration(server: ServerDep, session: Reader, calibration_id: RowId) -> Response:
    """Return a calibration: how far it is, and its whole result once it is done."""
    found = calibration_summaries.calibration_whole(session, calibration_id, grace=server.settings.grace)
    # not through the answer's model: maps of thousands of our own numbers needn't be checked one by one
    return Response(to_json(vars(found)), media_type="application/json")


@router.post("/cancel", responses=answers(409))
def cancel_calibration(server: ServerDep, viewer: ViewerDep, now: Now, calibration_id: RowId) -> CalibrationBrief:
    """Stop a calibration."""
    with server.database.write() as session:
        row = calibrations.cancel_calibration(session, calibration_id, now, person=viewer.name)
        brief = calibration_summaries.calibration_brief(row, grace=server.settings.grace)
    server.dispatcher.wake()
    return CalibrationBrief.model_validate(brief)


@router.delete("")
def delete_calibration(server: ServerDep, viewer: ViewerDep, now: Now, calibration_id: RowId) -> Deleted:
    """Delete a calibration; it can be restored during the grace period."""
    grace = server.settings.grace
    with server.database.write() as session:
        deleted = calibrations.delete_calibration(session, calibration_id, now, grace=grace, person=viewer.name)
    server.dispatcher.wake()
    return Deleted.model_validate(deleted)


@router.post("/restore", responses=answers(409))
def restore_calibration(server: ServerDep, viewer: ViewerDep, now: Now, calibration_id: RowId) -> CalibrationBrief:
    """Bring a deleted calibration back."""
    with server.database.write() as session:
        row = calibrations.restore_calibration(session, calibration_id, now, person=viewer.name)
        return CalibrationBrief.model_validate(
            calibration_summaries.calibration_brief(row, grace=server.settings.grace)
        )


@router.get("/lines", responses=answers(409))
def list_calibration_lines(
    session: Reader,
    calibration_id: RowId,
    order: LineOrder = "residual",
    limit: Limit = 100,
    cursor: Cursor = None,
) -> CalibrationLinePage:
    """List the lines of a calibration, those furthest from straight first.

    Decisions and edits made later change nothing here; `state` says what became of a line's segment.
    """
    row = calibrations.finished_calibration(session, calibration_id)
    return CalibrationLinePage.model_validate(list_lines(session, row, order=order, limit=limit, cursor=cursor))


@router.get("/images", responses=answers(409))
def list_calibration_images(session: Reader, calibration_id: RowId) -> list[CalibrationImage]:
    """List the images that a calibration read, those best suited to look at first."""
    row = calibrations.finished_calibration(session, calibration_id)
    return [CalibrationImage.model_validate(image) for image in calibration_images.images_of_result(session, row)]


@router.get("/images/{image_id}/lines", responses=answers(409))
def read_image_lines(session: Reader, calibration_id: RowId, image_id: RowId) -> ImageLines:
    """Return the lines of one image as they were measured, and with the lens taken out."""
    row = calibrations.finished_calibration(session, calibration_id)
    image = calibration_images.image_for(session, row, image_id)
    return ImageLines.model_validate(calibration_images.viewed_lines(session, row, image))


@router.get("/advice", responses=answers(409))
def read_advice(session: Reader, calibration_id: RowId) -> Advice:
    """Return where more lines would help most, and the images to label next."""
    return Advice.model_validate(advice_of(session, calibrations.finished_calibration(session, calibration_id)))
