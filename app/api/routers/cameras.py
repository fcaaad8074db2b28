"""Cameras: the images that share one lens, its estimate, and a reference known from elsewhere."""

from __future__ import annotations

from fastapi import APIRouter

from app.api.deps import Now, Reader, ServerDep, ViewerDep
from app.api.problems import answers
from app.api.schemas.base import RowId
from app.api.schemas.images import CameraAnswer, CameraChange
from app.services import cameras
from app.services.datasets import get_dataset

router = APIRouter(tags=["cameras"], responses=answers(404))


@router.get("/datasets/{slug}/cameras")
def list_cameras(session: Reader, slug: str) -> list[CameraAnswer]:
    """List the cameras of a dataset."""
    return [CameraAnswer.model_validate(camera) for camera in cameras.list_cameras(session, get_dataset(session, slug))]


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
            cameras.set_reference(session, camera, reference, now, person=viewer.name)
        return CameraAnswer.model_validate(cameras.camera_entry(session, camera))
