"""The lens that an image's candidates were judged under."""

from __future__ import annotations

from typing import Any

from sqlalchemy.orm import Session

from app.db.models import CameraEstimate, Image, RunImage
from app.services.cameras import latest_estimates
from app.vision.distortion import DistortionEstimate


def lens_fields(session: Session, image: Image, work: RunImage | None) -> dict[str, Any] | None:
    """Return the distortion that an image's candidates were judged under, else its camera's newest one.

    Args:
        session: Any session.
        image: The image.
        work: The run's work that its current candidates come from.
    """
    if work is not None and work.distortion is not None:
        return work.distortion
    if work is not None and work.camera_estimate_id is not None:
        return session.get_one(CameraEstimate, work.camera_estimate_id).distortion
    return latest_estimates(session, [image.camera_id]).get(image.camera_id)


def lens_of_image(session: Session, image: Image) -> DistortionEstimate | None:
    """Return the estimate behind `lens_fields`, accepted or not; ``None`` where there is none."""
    work = session.get(RunImage, image.current_run_image_id) if image.current_run_image_id else None
    fields = lens_fields(session, image, work)
    return None if fields is None else DistortionEstimate.from_dict(fields)
