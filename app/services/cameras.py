"""Cameras: the images that share one lens, and its estimates."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from typing import Any

from sqlalchemy import func, or_, select
from sqlalchemy.orm import Session

from app.db.models import Camera, CameraEstimate, Dataset, Image, ImageTally, Run
from app.errors import Conflict, InvalidInput, NotFound
from app.formats.naming import composed
from app.services.events import record_event
from app.services.tallies import counts_by

NAME_LENGTH = 300


@dataclass(frozen=True)
class CameraEntry:
    """A camera as lists show it.

    Attributes:
        images: Number of its images.
        reference: ``{"K": 3 x 3, "D": [k1, k2, p1, p2, k3]}`` in OpenCV's convention, px; ``None`` if unknown.
        estimate: The distortion that the newest run estimated (see ``DistortionEstimate.as_dict``).
    """

    id: int
    name: str
    width: int
    height: int
    images: int
    reference: dict[str, Any] | None
    estimate: dict[str, Any] | None


def default_camera_name(image_name: str, width: int, height: int) -> str:
    """Return the camera of an image of which nothing is known: images of one folder and size share it."""
    folder = image_name.rpartition("/")[0]
    return f"{folder} {width}x{height}".strip()[-NAME_LENGTH:]


def camera_for(session: Session, dataset: Dataset, name: str, width: int, height: int, now: datetime) -> Camera:
    """Return the dataset's camera of that name; it is made if new.

    Raises:
        InvalidInput: When the name can't be used, or the camera's images have another size.
    """
    name = checked_camera_name(name)
    query = select(Camera).where(Camera.dataset_id == dataset.id, Camera.name == name)
    camera = session.scalars(query).one_or_none()
    if camera is None:
        camera = Camera(dataset_id=dataset.id, name=name, width=width, height=height, created_at=now)
        session.add(camera)
        session.flush()
    elif (camera.width, camera.height) != (width, height):
        raise InvalidInput(
            f"the camera {name} takes images of {camera.width} x {camera.height} px, not {width} x {height}",
            where="camera",
            expected="one size per camera",
            hint="give these images another camera",
        )
    return camera


def get_camera(session: Session, camera_id: int) -> Camera:
    """Return a camera of a dataset that isn't deleted.

    Raises:
        NotFound: When there is none.
    """
    query = select(Camera).join(Dataset).where(Camera.id == camera_id, Dataset.deleted_at.is_(None))
    camera = session.scalars(query).one_or_none()
    if camera is None:
        raise NotFound(f"there is no camera {camera_id}")
    return camera


def list_cameras(session: Session, dataset: Dataset) -> list[CameraEntry]:
    """Return a dataset's cameras by name; those without images only if they have a reference."""
    return _entries(session, select_cameras_of(dataset))


def camera_entry(session: Session, camera: Camera) -> CameraEntry:
    """Return one camera as lists show it."""
    return _entries(session, select(Camera.id).where(Camera.id == camera.id))[0]


def select_cameras_of(dataset: Dataset) -> Any:
    """Select the ids of cameras that lists show."""
    in_use = select(Image.id).where(Image.camera_id == Camera.id, Image.deleted_at.is_(None)).correlate(Camera).exists()
    return select(Camera.id).where(Camera.dataset_id == dataset.id, or_(in_use, Camera.reference.is_not(None)))


def latest_estimates(session: Session, cameras: Any) -> dict[int, dict[str, Any]]:
    """Return the distortion that the newest run estimated, by camera id.

    Args:
        session: Any session.
        cameras: Ids, or a query that selects them. Deleted runs don't count.
    """
    newest = (
        select(func.max(CameraEstimate.id))
        .join(Run, Run.id == CameraEstimate.run_id)
        .where(CameraEstimate.camera_id.in_(cameras), Run.deleted_at.is_(None))
        .group_by(CameraEstimate.camera_id)
    )
    query = select(CameraEstimate.camera_id, CameraEstimate.distortion).where(CameraEstimate.id.in_(newest))
    return dict(session.execute(query).all())


def rename_camera(session: Session, camera: Camera, name: str, now: datetime, *, person: str | None = None) -> Camera:
    """Give a camera another name.

    Raises:
        InvalidInput: When the name can't be used.
        Conflict: When another camera of the dataset has it.
    """
    name = checked_camera_name(name)
    if name == camera.name:
        return camera
    query = select(Camera.id).where(Camera.dataset_id == camera.dataset_id, Camera.name == name)
    if session.scalars(query).one_or_none() is not None:
        raise Conflict(f"another camera is named {name}", where="name", hint="move its images there instead")
    details = {"from": camera.name, "to": name}
    record_event(session, "camera.renamed", now, dataset_id=camera.dataset_id, person=person, details=details)
    camera.name = name
    session.flush()
    return camera


def _entries(session: Session, chosen: Any) -> list[CameraEntry]:
    cameras = session.scalars(select(Camera).where(Camera.id.in_(chosen)).order_by(Camera.name)).all()
    # of a camera's own dataset, whose tallies an index finds
    datasets = {camera.dataset_id for camera in cameras}
    images = counts_by(
        session, ImageTally.camera_id, ImageTally.dataset_id.in_(datasets), ImageTally.deleted.is_(False)
    )
    estimates = latest_estimates(session, [camera.id for camera in cameras])
    return [
        CameraEntry(
            camera.id,
            camera.name,
            camera.width,
            camera.height,
            images.get(camera.id, 0),
            camera.reference,
            estimates.get(camera.id),
        )
        for camera in cameras
    ]


def checked_camera_name(name: str) -> str:
    """Return the name in Unicode's composed form.

    Raises:
        InvalidInput: When it is empty, too long, or has control characters.
    """
    name = composed(name.strip())
    if not name or len(name) > NAME_LENGTH or not name.isprintable():
        raise InvalidInput("this can't be a camera's name", where="camera", expected=f"1 to {NAME_LENGTH} characters")
    return name
