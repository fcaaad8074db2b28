"""How far runs are: counts, what they changed, the time left, each camera's lens, each image's outcome."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from datetime import datetime, timedelta
from typing import Any

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import Camera, CameraEstimate, Dataset, Image, Run, RunImage, RunTally
from app.services.paging import Order, Page, checked_limit, page_of
from app.services.run_briefs import WorkCounts, run_briefs
from app.services.run_queue import UNFINISHED
from app.services.runs import get_run
from app.services.tallies import states_of_runs, summed

PACE_IMAGES = 30
"""Images that the pace is taken from, the latest ones: their size may differ from the first ones'."""

BY_IMAGE_NAME = Order("image-name", Image.name, RunImage.id)


@dataclass(frozen=True)
class RunChanges:
    """What a run changed for decisions made before it, over all its images."""

    carried: int = 0
    kept_unmatched: int = 0
    already_there: int = 0
    retired: int = 0
    discarded: int = 0
    reopened: int = 0


@dataclass(frozen=True)
class CameraResult:
    """A camera's joint distortion as the run estimated it."""

    id: int
    name: str
    distortion: dict[str, Any]


@dataclass(frozen=True)
class RunSummary:
    """A run and how far it is.

    Attributes:
        counts: Images by state.
        total: Images in all.
        candidates: What it stored, over all images.
        seconds_left: From the pace of the latest images; ``None`` before the first one and once it is over.
        cameras: Of a joint run, once its images are done.
        restorable_until: Of a deleted run, when it goes for good.
    """

    id: int
    parameters: dict[str, Any]
    code_version: str
    status: str
    error: dict[str, Any] | None
    created_at: datetime
    started_at: datetime | None
    finished_at: datetime | None
    deleted_at: datetime | None
    restorable_until: datetime | None
    counts: WorkCounts
    total: int
    candidates: int
    changes: RunChanges
    seconds_left: float | None
    cameras: tuple[CameraResult, ...]


@dataclass(frozen=True)
class ImageName:
    """Which image."""

    id: int
    name: str


@dataclass(frozen=True)
class RunImageState:
    """The work of a run on one image.

    Attributes:
        error: Why it failed; on a finished image, why its candidates have no straightness.
        milliseconds: Time of the detection.
        changes: What it changed, by name, as in ``RunChanges``, with the number of ``candidates``.
        distortion: The lens from this image alone, where the run asked for that.
    """

    image: ImageName
    status: str
    attempts: int
    error: dict[str, Any] | None
    milliseconds: float | None
    changes: dict[str, Any] | None
    distortion: dict[str, Any] | None


def run_summary(session: Session, run_id: int, now: datetime, *, grace: timedelta) -> RunSummary:
    """Return a run, deleted ones too, and how far it is.

    Raises:
        NotFound: When there is none.
    """
    return _summaries(session, [get_run(session, run_id, deleted=True)], now, grace)[0]


def list_runs(
    session: Session, dataset: Dataset, now: datetime, *, grace: timedelta, deleted: bool = False
) -> list[RunSummary]:
    """Return a dataset's runs, newest first; or those that are deleted and can still be restored."""
    wanted = Run.deleted_at.is_not(None) if deleted else Run.deleted_at.is_(None)
    query = select(Run).where(Run.dataset_id == dataset.id, wanted).order_by(Run.id.desc())
    return _summaries(session, session.scalars(query).all(), now, grace)


def run_images(
    session: Session, run_id: int, *, status: str | None = None, limit: int = 100, cursor: str | None = None
) -> Page[RunImageState]:
    """Return the work of a run image by image, by name.

    Args:
        session: Any session.
        run_id: The run.
        status: Only work in this state.
        limit: Images of a page.
        cursor: Of the page before.

    Raises:
        NotFound: When there is no such run.
        InvalidInput: On a limit or cursor that can't be.
    """
    run = get_run(session, run_id, deleted=True)
    limit = checked_limit(limit)
    query = (
        select(RunImage, Image.id, Image.name)
        .join(Image, Image.id == RunImage.image_id)
        # the dataset's index gives its images in the order of their names; without it all of the run's would be sorted
        .where(RunImage.run_id == run.id, Image.dataset_id == run.dataset_id)
        .where(*([RunImage.status == status] if status else []))
    )
    states = states_of_runs(session, [run.id])[run.id]
    total = states.get(status, 0) if status else sum(states.values())
    if cursor:
        query = query.where(BY_IMAGE_NAME.after(cursor))
    rows = session.execute(query.order_by(*BY_IMAGE_NAME.clauses()).limit(limit + 1)).all()
    page = page_of(rows, limit, BY_IMAGE_NAME, lambda row: (row.name, row[0].id), total)
    return page.map(lambda row: _state(row[0], ImageName(row.id, row.name)))


def _state(row: RunImage, image: ImageName) -> RunImageState:
    return RunImageState(image, row.status, row.attempts, row.error, row.milliseconds, row.changes, row.distortion)


def _summaries(session: Session, runs: Sequence[Run], now: datetime, grace: timedelta) -> list[RunSummary]:
    ids = [run.id for run in runs]
    briefs = run_briefs(session, ids)
    changes = _changes(session, ids)
    cameras = _cameras(session, ids)
    return [
        RunSummary(
            id=run.id,
            parameters=run.parameters,
            code_version=run.code_version,
            status=run.status,
            error=run.error,
            created_at=run.created_at,
            started_at=run.started_at,
            finished_at=run.finished_at,
            deleted_at=run.deleted_at,
            restorable_until=None if run.deleted_at is None else run.deleted_at + grace,
            counts=briefs[run.id].counts,
            total=briefs[run.id].total,
            candidates=changes.get(run.id, (0, RunChanges()))[0],
            changes=changes.get(run.id, (0, RunChanges()))[1],
            seconds_left=_seconds_left(session, run, briefs[run.id].counts, now),
            cameras=tuple(cameras.get(run.id, ())),
        )
        for run in runs
    ]


def _changes(session: Session, run_ids: Sequence[int]) -> dict[int, tuple[int, RunChanges]]:
    names = ("candidates", *(field.name for field in fields(RunChanges)))
    rows = session.execute(
        select(RunTally.run_id, *(summed(getattr(RunTally, name)) for name in names))
        .where(RunTally.run_id.in_(run_ids))
        .group_by(RunTally.run_id)
    ).all()
    return {row[0]: (int(row[1]), RunChanges(*(int(value) for value in row[2:]))) for row in rows}


def _cameras(session: Session, run_ids: Sequence[int]) -> dict[int, list[CameraResult]]:
    rows = session.execute(
        select(CameraEstimate.run_id, Camera.id, Camera.name, CameraEstimate.distortion)
        .join(Camera, Camera.id == CameraEstimate.camera_id)
        .where(CameraEstimate.run_id.in_(run_ids))
        .order_by(CameraEstimate.run_id, Camera.name)
    )
    cameras: dict[int, list[CameraResult]] = {}
    for run_id, camera_id, name, distortion in rows:
        cameras.setdefault(run_id, []).append(CameraResult(camera_id, name, distortion))
    return cameras


def _seconds_left(session: Session, run: Run, counts: WorkCounts, now: datetime) -> float | None:
    left = counts.queued + counts.running
    if run.status not in UNFINISHED or run.started_at is None or not left:
        return None
    # finished work keeps the time it finished at as its last heartbeat
    finished = session.scalars(
        select(RunImage.heartbeat_at)
        .where(RunImage.run_id == run.id, RunImage.status.in_(["done", "failed"]), RunImage.heartbeat_at.is_not(None))
        .order_by(RunImage.heartbeat_at.desc())
        .limit(PACE_IMAGES + 1)
    ).all()
    times = [moment for moment in finished if moment is not None]
    if not times:
        return None
    since, images = (times[-1], len(times) - 1) if len(times) > PACE_IMAGES else (run.started_at, len(times))
    return max((times[0] - since).total_seconds() / images * left - (now - times[0]).total_seconds(), 0.0)
