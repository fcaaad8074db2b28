"""Calibrations of a camera: start, cancel, delete and restore them."""

from __future__ import annotations

from datetime import datetime, timedelta
from typing import Any

from sqlalchemy import func, select
from sqlalchemy.orm import Session, undefer

from app.calibration.lens import FAMILY_NAMES
from app.db.models import CALIBRATION_SOURCES, Calibration, Camera, Dataset
from app.errors import Conflict, InvalidInput, NotFound
from app.services.calibration_scope import images_with_lines
from app.services.datasets import Deleted
from app.services.events import record_event
from app.services.run_queue import UNFINISHED
from app.vision.code_version import code_version

FEWEST_LINES = 3
"""With fewer lines nothing about a lens can be told, so nothing is begun."""


def start_calibration(
    session: Session,
    camera: Camera,
    source: str,
    family: str | None,
    now: datetime,
    *,
    person: str | None = None,
) -> Calibration:
    """Queue the estimate of a camera's lens from lines of its images; a dispatcher works it off.

    Args:
        session: A writing session.
        camera: The camera.
        source: ``labels``, what people kept, or ``candidates``, all that wasn't rejected, by how straight it is.
        family: The lens model; the one that fits best when left out.
        now: When.
        person: Who asks for it.

    Raises:
        InvalidInput: On an unknown source or model.
        Conflict: When one of the camera is at work, named in ``details.calibration``, or there are no lines.
        BrokenInstallation: When a part of ClearLines is missing.
    """
    if source not in CALIBRATION_SOURCES:
        raise InvalidInput(f"{source!r:.40} is no source", where="source", expected=", ".join(CALIBRATION_SOURCES))
    if family is not None and family not in FAMILY_NAMES:
        raise InvalidInput(f"unknown model {family!r:.40}", where="family", expected=", ".join(FAMILY_NAMES))
    session.refresh(camera, with_for_update=True)  # of two that start at once, the second sees the first one's
    _refuse_second(session, camera)
    lines = images_with_lines(camera, source).subquery()
    available = session.scalar(select(func.sum(lines.c.segments))) or 0
    if available < FEWEST_LINES:
        raise Conflict(
            f"{available} {'kept lines' if source == 'labels' else 'candidates'} are too few to tell a lens from",
            where=camera.name,
            expected=f"at least {FEWEST_LINES}",
            hint="keep straight lines of this camera's images"
            if source == "labels"
            else "pre-label this camera's images",
        )
    row = Calibration(
        camera_id=camera.id,
        person=person,
        source=source,
        family=family,
        status="queued",
        parameters={},
        code_version=code_version(),
        created_at=now,
    )
    session.add(row)
    session.flush()
    _record(session, "calibration.started", row, camera, now, person, source=source, family=family)
    return row


def get_calibration(
    session: Session, calibration_id: int, *, deleted: bool = False, lock: bool = False, whole: bool = False
) -> Calibration:
    """Return a calibration of a dataset that isn't deleted.

    Args:
        session: Any session.
        calibration_id: Its id.
        deleted: Whether to take a deleted one too.
        lock: Whether to hold its row; needs a writing session.
        whole: Whether to read its result, its advice and its lines at once.

    Raises:
        NotFound: When there is none.
    """
    query = (
        select(Calibration)
        .join(Camera, Camera.id == Calibration.camera_id)
        .join(Dataset, Dataset.id == Camera.dataset_id)
        .where(Calibration.id == calibration_id, Dataset.deleted_at.is_(None))
    )
    if whole:
        query = query.options(*map(undefer, (Calibration.result, Calibration.advice, Calibration.lines)))
    if lock:
        query = query.with_for_update(of=Calibration).execution_options(populate_existing=True)
    row = session.scalars(query).one_or_none()
    if row is None:
        raise NotFound(f"there is no calibration {calibration_id}")
    if row.deleted_at is not None and not deleted:
        details = {"calibration": calibration_id}
        raise NotFound(f"calibration {calibration_id} is deleted", hint="restore it first", details=details)
    return row


def finished_calibration(session: Session, calibration_id: int) -> Calibration:
    """Return a calibration with its result.

    Raises:
        NotFound: When there is none.
        Conflict: When it has no result, because it is at work, failed or was cancelled.
    """
    row = get_calibration(session, calibration_id, whole=True)
    if row.result is None:
        raise Conflict(
            f"calibration {calibration_id} has no result: it is {row.status}",
            hint="wait until it is done" if row.status in UNFINISHED else "start another one",
        )
    return row


def cancel_calibration(
    session: Session, calibration_id: int, now: datetime, *, person: str | None = None
) -> Calibration:
    """Stop a calibration; its worker is told within a second.

    Raises:
        NotFound: When there is none.
        Conflict: When it is over already.
    """
    row = get_calibration(session, calibration_id, lock=True)
    if row.status not in UNFINISHED:
        raise Conflict(f"the calibration is over already: {row.status}")
    _cancel(row, now)
    _record(session, "calibration.cancelled", row, camera_of(session, row), now, person)
    return row


def delete_calibration(
    session: Session, calibration_id: int, now: datetime, *, grace: timedelta, person: str | None = None
) -> Deleted:
    """Hide a calibration; until the grace period is over it can be restored. One at work is cancelled first."""
    row = get_calibration(session, calibration_id, lock=True)
    if row.status in UNFINISHED:
        _cancel(row, now)
    row.deleted_at = now
    _record(session, "calibration.deleted", row, camera_of(session, row), now, person)
    return Deleted(1, now, now + grace)


def restore_calibration(
    session: Session, calibration_id: int, now: datetime, *, person: str | None = None
) -> Calibration:
    """Bring a deleted calibration back.

    Raises:
        NotFound: When there is none any more.
        Conflict: When it isn't deleted.
    """
    row = get_calibration(session, calibration_id, deleted=True, lock=True)
    if row.deleted_at is None:
        raise Conflict(f"calibration {calibration_id} isn't deleted")
    row.deleted_at = None
    _record(session, "calibration.restored", row, camera_of(session, row), now, person)
    return row


def camera_of(session: Session, row: Calibration) -> Camera:
    """Return the camera of a calibration."""
    return session.get_one(Camera, row.camera_id)


def images_of_calibration(row: Calibration) -> list[int]:
    """Return the ids of the images that a calibration read, in its order; some may be gone by now."""
    return list(row.parameters.get("images", []))


def _refuse_second(session: Session, camera: Camera) -> None:
    at_work = select(Calibration.id).where(Calibration.camera_id == camera.id, Calibration.status.in_(UNFINISHED))
    known = session.scalar(at_work)
    if known is not None:
        raise Conflict(
            f"calibration {known} of this camera is at work",
            where=camera.name,
            hint="wait for it, or cancel it",
            details={"calibration": known},
        )


def _cancel(row: Calibration, now: datetime) -> None:
    row.status = "cancelled"
    row.finished_at = now
    row.progress = None


def _record(
    session: Session, kind: str, row: Calibration, camera: Camera, now: datetime, person: str | None, **details: Any
) -> None:
    facts = {"calibration": row.id, "camera": camera.name, **details}
    record_event(session, kind, now, dataset_id=camera.dataset_id, person=person, details=facts)
