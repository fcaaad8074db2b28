"""Which images and lines of a camera a calibration may read."""

from __future__ import annotations

from sqlalchemy import ColumnElement, Select, func, select
from sqlalchemy.orm import Session, aliased

from app.db.models import Camera, Decision, Image, Segment, SegmentState


def images_of_camera(camera: Camera) -> ColumnElement[bool]:
    """Return the condition on ``Image`` of those that a camera's lens shows; all of them have its size."""
    return (Image.camera_id == camera.id) & (Image.dataset_id == camera.dataset_id) & Image.deleted_at.is_(None)


def images_with_lines(camera: Camera, source: str) -> Select[int, int]:
    """Select id and number of ``segments`` of the images with lines of a source, by name.

    Args:
        camera: The camera.
        source: ``labels`` or ``candidates``; rejected ones are in neither.
    """
    number = Image.n_keep if source == "labels" else Image.n_candidates - Image.n_reject
    query = select(Image.id, number.label("segments")).where(images_of_camera(camera), number > 0)
    return query.order_by(Image.name)


def newest_decision(session: Session, camera: Camera) -> int:
    """Return the id of the newest decision on a camera's images; 0 where there is none."""
    newest = select(func.max(Decision.id)).where(Decision.image_id == Image.id).correlate(Image).scalar_subquery()
    return session.scalar(select(func.max(newest)).select_from(Image).where(images_of_camera(camera))) or 0


def kept_lines_changed(session: Session, camera: Camera, since: int) -> int:
    """Count the segments of a camera's images that are kept now and weren't then, or the other way round.

    Args:
        session: Any session.
        camera: The camera.
        since: The decision that was the newest then.
    """
    first = (
        select(func.min(Decision.id).label("id"))
        .join(Image, Image.id == Decision.image_id)
        .where(images_of_camera(camera), Decision.id > since)
        .group_by(Decision.segment_id)
        .subquery()
    )
    then = aliased(Decision)
    is_kept = (func.coalesce(SegmentState.verdict, "undecided") == "keep") & Segment.retired_at.is_(None)
    query = (
        select(func.count())
        .select_from(first)
        .join(then, then.id == first.c.id)
        .join(Segment, Segment.id == then.segment_id)
        .outerjoin(SegmentState, SegmentState.segment_id == then.segment_id)
        .where((then.previous == "keep") != is_kept)
    )
    return session.scalar(query) or 0
