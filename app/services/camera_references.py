"""A camera's distortion as it is known from elsewhere, to compare with."""

from __future__ import annotations

import json
from collections.abc import Mapping
from datetime import datetime
from typing import Any

from sqlalchemy.orm import Session

from app.db.models import Camera
from app.errors import InvalidInput
from app.formats.calibration_files import read_calibration_file
from app.formats.reference_camera import ReferenceCamera, read_cameras
from app.services.events import record_event


def set_reference(
    session: Session,
    camera: Camera,
    reference: Mapping[str, Any] | None,
    now: datetime,
    *,
    person: str | None = None,
) -> Camera:
    """Store a calibration that is known from elsewhere, or clear it.

    Args:
        session: A writing session.
        camera: The camera.
        reference: ``{"K": 3 x 3, "D": [k1, k2, p1, p2, ...]}`` in OpenCV's convention, K in px; ``None`` clears it.
        now: When.
        person: Who did it.

    Raises:
        InvalidInput: When it is no such calibration, or one for another image size.
    """
    checked = None if reference is None else checked_reference(reference, camera.width, camera.height)
    return _store_reference(session, camera, checked, now, person)


def set_reference_from_file(
    session: Session, camera: Camera, content: bytes, file_name: str, now: datetime, *, person: str | None = None
) -> Camera:
    """Store a calibration that another tool wrote.

    Args:
        session: A writing session.
        camera: The camera.
        content: The file; `app.formats.calibration_files` says which kinds are read.
        file_name: Its name, for messages.
        now: When.
        person: Who did it.

    Raises:
        InvalidInput: When it holds no such calibration, or one for another image size.
        TooLarge: When it is larger than any calibration.
    """
    size = (camera.width, camera.height)
    reference = read_calibration_file(content, where=file_name or "file", size=size, camera=camera.name)
    return _store_reference(session, camera, stored_reference(reference, *size), now, person)


def checked_reference(reference: Mapping[str, Any], width: int, height: int) -> dict[str, Any]:
    """Return ``K`` and ``D`` as plain floats.

    Raises:
        InvalidInput: Naming the field that is wrong.
    """
    entry = {"width": width, "height": height, **reference}
    try:
        document = json.dumps({"reference": entry}, allow_nan=False).encode()
    except (TypeError, ValueError) as error:
        raise InvalidInput("a value is no finite number", where="reference") from error
    return stored_reference(read_cameras(document, where="reference")["reference"], width, height)


def stored_reference(reference: ReferenceCamera, width: int, height: int) -> dict[str, Any]:
    """Return a reference in the form of the camera's column.

    Raises:
        InvalidInput: When it is for images of another size.
    """
    if (reference.width, reference.height) != (width, height):
        raise InvalidInput(
            f"the calibration is for images of {reference.width} x {reference.height} px",
            where="reference",
            expected=f"{width} x {height} px",
        )
    return {"K": [list(row) for row in reference.matrix], "D": list(reference.distortion)}


def reference_camera(camera: Camera) -> ReferenceCamera | None:
    """Return a camera's reference in the form that files have."""
    if camera.reference is None:
        return None
    rows = tuple((float(a), float(b), float(c)) for a, b, c in camera.reference["K"])
    return ReferenceCamera(camera.width, camera.height, rows, tuple(camera.reference["D"]))


def _store_reference(
    session: Session, camera: Camera, reference: dict[str, Any] | None, now: datetime, person: str | None
) -> Camera:
    camera.reference = reference
    session.flush()
    details = {"camera": camera.name, "reference": camera.reference}
    record_event(session, "camera.reference", now, dataset_id=camera.dataset_id, person=person, details=details)
    return camera
