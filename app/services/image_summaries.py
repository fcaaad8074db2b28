"""Images at a glance, with their review, camera and newest work: any number of them in two queries."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from sqlalchemy import ColumnElement, Select, Subquery, func, select
from sqlalchemy.orm import Session

from app.db.models import Camera, Image, Review, Run, RunImage
from app.services.counts import VerdictCounts, verdict_counts


@dataclass(frozen=True)
class CameraName:
    """Which camera took an image."""

    id: int
    name: str


@dataclass(frozen=True)
class ImageSummary:
    """An image as lists show it.

    Attributes:
        bits: Per channel, 8 or 16.
        assignee: Whose task it is; ``None`` while it is nobody's.
        status: Of its review: open, done or discarded; ``reason`` says why it was discarded.
        prelabel: Of the newest run that includes it: none, queued, running, done or failed.
        error: Why that run failed on it (see ``ClearLinesError.as_dict``).
        candidates: Number of current segments, by verdict in ``verdicts``.
    """

    id: int
    name: str
    file_name: str
    width: int
    height: int
    bits: int
    camera: CameraName
    source: str | None
    sequence: str | None
    assignee: str | None
    status: str
    reason: str | None
    prelabel: str
    error: dict[str, Any] | None
    candidates: int
    verdicts: VerdictCounts
    created_at: datetime
    deleted_at: datetime | None


def select_summaries() -> Select[Image, Review, str]:
    """Select what summaries are made of, for all images of all datasets."""
    return (
        select(Image, Review, Camera.name.label("camera_name"))
        .join(Review, Review.image_id == Image.id)
        .join(Camera, Camera.id == Image.camera_id)
    )


def image_summary(session: Session, image: Image) -> ImageSummary:
    """Return one image as lists show it."""
    return image_summaries(session, [image.id])[0]


def image_summaries(session: Session, ids: Sequence[int]) -> list[ImageSummary]:
    """Return images as lists show them, in the order of the ids."""
    rows = session.execute(select_summaries().where(Image.id.in_(ids))).all()
    by_id = {summary.id: summary for summary in summaries_of(session, rows)}
    return [by_id[image_id] for image_id in ids]


def summaries_of(session: Session, rows: Sequence[Any]) -> list[ImageSummary]:
    """Return summaries of rows of ``Image``, ``Review`` and the camera's name, as ``select_summaries`` selects."""
    work = _work_of(session, [row.Image.id for row in rows])
    return [_summary(row.Image, row.Review, row.camera_name, work.get(row.Image.id)) for row in rows]


def _summary(image: Image, review: Review, camera: str, work: RunImage | None) -> ImageSummary:
    return ImageSummary(
        id=image.id,
        name=image.name,
        file_name=image.file_name,
        width=image.width,
        height=image.height,
        bits=image.bits,
        camera=CameraName(image.camera_id, camera),
        source=image.source,
        sequence=image.sequence,
        assignee=image.assignee,
        status=review.status,
        reason=review.reason,
        prelabel=work.status if work else "none",
        error=work.error if work else None,
        candidates=image.n_candidates,
        verdicts=verdict_counts(image.n_candidates, image.n_keep, image.n_reject, image.n_ambiguous),
        created_at=image.created_at,
        deleted_at=image.deleted_at,
    )


def _work_of(session: Session, ids: Sequence[int]) -> dict[int, RunImage]:
    latest = latest_work(RunImage.image_id.in_(ids))
    found = session.scalars(select(RunImage).join(latest, latest.c.id == RunImage.id))
    return {work.image_id: work for work in found}


def latest_work(which: ColumnElement[bool]) -> Subquery:
    """Return image_id and id of the newest work on each image; deleted runs and cancelled work don't count."""
    return (
        select(RunImage.image_id, func.max(RunImage.id).label("id"))
        .join(Run, Run.id == RunImage.run_id)
        .where(which, Run.deleted_at.is_(None), RunImage.status != "cancelled")
        .group_by(RunImage.image_id)
        .subquery()
    )
