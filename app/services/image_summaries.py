"""Images at a glance, with their review, camera and newest work: any number of them in one query, or two."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from sqlalchemy import Row, Select, func, select
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


def select_summaries(image: type[Image] = Image) -> Select[*tuple[Any, ...]]:
    """Select what summaries are made of, for all images of all datasets, or of a subquery that is aliased."""
    # columns alone: making whole objects of 200 rows takes longer than everything else that a list does
    return (
        select(
            image.id,
            image.name,
            image.file_name,
            image.width,
            image.height,
            image.bits,
            image.camera_id,
            Camera.name.label("camera"),
            image.source,
            image.sequence,
            image.assignee,
            image.review_status,
            Review.reason,
            image.prelabel,
            image.n_candidates,
            image.n_keep,
            image.n_reject,
            image.n_ambiguous,
            image.created_at,
            image.deleted_at,
        )
        .join(Review, Review.image_id == image.id)
        .join(Camera, Camera.id == image.camera_id)
    )


def image_summary(session: Session, image: Image) -> ImageSummary:
    """Return one image as lists show it."""
    return image_summaries(session, [image.id])[0]


def image_summaries(session: Session, ids: Sequence[int]) -> list[ImageSummary]:
    """Return images as lists show them, in the order of the ids."""
    found = {summary.id: summary for summary in summaries_of(session, select_summaries().where(Image.id.in_(ids)))}
    return [found[image_id] for image_id in ids]


def summaries_of(session: Session, chosen: Select[*tuple[Any, ...]]) -> list[ImageSummary]:
    """Return the images that a query of ``select_summaries`` is narrowed to, in its order."""
    rows = session.execute(chosen).all()
    errors = _errors_of(session, [row.id for row in rows if row.prelabel == "failed"])
    return [_summary(row, errors.get(row.id)) for row in rows]


def _summary(row: Row[*tuple[Any, ...]], error: dict[str, Any] | None) -> ImageSummary:
    return ImageSummary(
        id=row.id,
        name=row.name,
        file_name=row.file_name,
        width=row.width,
        height=row.height,
        bits=row.bits,
        camera=CameraName(row.camera_id, row.camera),
        source=row.source,
        sequence=row.sequence,
        assignee=row.assignee,
        status=row.review_status,
        reason=row.reason,
        prelabel=row.prelabel,
        error=error,
        candidates=row.n_candidates,
        verdicts=verdict_counts(row.n_candidates, row.n_keep, row.n_reject, row.n_ambiguous),
        created_at=row.created_at,
        deleted_at=row.deleted_at,
    )


def _errors_of(session: Session, failed: Sequence[int]) -> dict[int, dict[str, Any] | None]:
    """Return why the newest work on images failed; deleted runs and cancelled work don't count."""
    if not failed:
        return {}
    newest = (
        select(func.max(RunImage.id))
        .join(Run, Run.id == RunImage.run_id)
        .where(RunImage.image_id.in_(failed), Run.deleted_at.is_(None), RunImage.status != "cancelled")
        .group_by(RunImage.image_id)
    )
    rows = session.execute(select(RunImage.image_id, RunImage.error).where(RunImage.id.in_(newest)))
    return {row.image_id: row.error for row in rows}
