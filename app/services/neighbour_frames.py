"""The frames before and after an image in its drive."""

from __future__ import annotations

from dataclasses import dataclass

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import Image


@dataclass(frozen=True)
class FramesBeside:
    """The images of one camera and sequence next to an image, in the order of their names; ``None`` at the ends."""

    before: Image | None
    after: Image | None


def frames_beside(session: Session, image: Image) -> FramesBeside:
    """Return the neighbours of an image; none where it isn't known which drive it is of."""
    if image.sequence is None:
        return FramesBeside(None, None)
    same = select(Image).where(
        Image.dataset_id == image.dataset_id,
        Image.camera_id == image.camera_id,
        Image.sequence == image.sequence,
        Image.deleted_at.is_(None),
    )
    return FramesBeside(
        session.scalar(same.where(Image.name < image.name).order_by(Image.name.desc()).limit(1)),
        session.scalar(same.where(Image.name > image.name).order_by(Image.name).limit(1)),
    )
