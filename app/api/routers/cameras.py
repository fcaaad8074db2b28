"""Cameras: the images that share one lens, its estimates and calibrations, and a reference known from elsewhere."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, File, UploadFile, status

from app.api.deps import Cursor, Limit, Now, Reader, ServerDep, ViewerDep
from app.api.problems import answers
from app.api.schemas.base import RowId
from app.api.schemas.calibrations import CalibrationBrief, CalibrationGiven, CalibrationPage, CameraDetail
from app.api.schemas.images import CameraAnswer, CameraChange
from app.formats.calibration_files import FILE_LIMIT
from app.services import calibration_summaries, calibrations, camera_references, cameras
from app.services.camera_details import camera_detail
from app.services.datasets import get_dataset

router = APIRouter(tags=["cameras"], responses=answers(404))


@router.get("/datasets/{slug}/cameras")
def list_cameras(session: Reader, slug: str) -> list[CameraAnswer]:
    """List the cameras of a dataset."""
    return [CameraAnswer.model_validate(camera) for camera in cameras.list_cameras(session, get_dataset(session, slug))]


@router.get("/cameras/{camera_id}")
def read_camera(server: ServerDep, session: Reader, camera_id: RowId) -> CameraDetail:
    """Return a camera with its newest calibration, the one at work, and what has changed since."""
    camera = cameras.get_camera(session, camera_id)
    return CameraDetail.model_validate(camera_detail(session, camera, grace=server.settings.grace))


@router.patch("/cameras/{camera_id}", responses=answers(409))
def change_camera(
    server: ServerDep, viewer: ViewerDep, now: Now, camera_id: RowId, given: CameraChange
) -> CameraAnswer:
    """Rename a camera, or set or clear its reference distortion."""
    with server.database.write() as session:
        camera = cameras.get_camera(session, camera_id)
        if given.name is not None:
            cameras.rename_camera(session, camera, given.name, now, person=viewer.name)
        if "reference" in given.model_fields_set:
            reference = None if given.reference is None else given.reference.model_dump()
            camera_references.set_reference(session, camera, reference, now, person=viewer.name)
        return CameraAnswer.model_validate(cameras.camera_entry(session, camera))


@router.post("/cameras/{camera_id}/reference-file", responses=answers(413))
def upload_reference(
    server: ServerDep,
    viewer: ViewerDep,
    now: Now,
    camera_id: RowId,
    file: Annotated[UploadFile, File(description="OpenCV's YAML or JSON, ROS's camera_info, or cameras.json.")],
) -> CameraAnswer:
    """Set a camera's reference distortion from a file that another tool wrote."""
    content = file.file.read(FILE_LIMIT + 1)  # one byte over the limit is refused by the reader
    with server.database.write() as session:
        camera = cameras.get_camera(session, camera_id)
        camera_references.set_reference_from_file(
            session, camera, content, file.filename or "", now, person=viewer.name
        )
        return CameraAnswer.model_validate(cameras.camera_entry(session, camera))


@router.post("/cameras/{camera_id}/calibrations", status_code=status.HTTP_202_ACCEPTED, responses=answers(409))
def start_calibration(
    server: ServerDep, viewer: ViewerDep, now: Now, camera_id: RowId, given: CalibrationGiven
) -> CalibrationBrief:
    """Have the camera's lens estimated from lines of its images; a worker begins at once.

    409 while another one of this camera is at work, named in `details.calibration`.
    """
    with server.database.write() as session:
        camera = cameras.get_camera(session, camera_id)
        row = calibrations.start_calibration(session, camera, given.source, given.family, now, person=viewer.name)
        brief = calibration_summaries.calibration_brief(row, grace=server.settings.grace)
    server.dispatcher.wake()
    return CalibrationBrief.model_validate(brief)


@router.get("/cameras/{camera_id}/calibrations")
def list_calibrations(
    server: ServerDep,
    session: Reader,
    camera_id: RowId,
    deleted: bool = False,
    limit: Limit = 100,
    cursor: Cursor = None,
) -> CalibrationPage:
    """List a camera's calibrations, newest first; with ``deleted`` those that can still be restored."""
    camera = cameras.get_camera(session, camera_id)
    grace = server.settings.grace
    page = calibration_summaries.list_calibrations(
        session, camera, grace=grace, deleted=deleted, limit=limit, cursor=cursor
    )
    return CalibrationPage.model_validate(page)
