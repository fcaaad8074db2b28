"""The work of calibrations as rows: claimed, kept alive, put back, stored, failed.

As with the work of runs, a claim is a row's id with its number of attempts: a result is stored only while the row still
runs at that attempt.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from sqlalchemy import ColumnElement, Select, or_, select, update
from sqlalchemy.orm import Session

from app.calibration.work_order import CalibrationFound
from app.db.models import Calibration, Camera, Dataset
from app.errors import ClearLinesError
from app.services.calibration_summaries import summary_of
from app.services.events import record_event
from app.services.run_queue import UNFINISHED


@dataclass(frozen=True)
class CalibrationClaim:
    """A calibration that a dispatcher works on.

    Attributes:
        attempts: How often the work has been begun, this time included.
        camera_name: For messages.
        family: The lens model; the best one where it is ``None``.
    """

    calibration_id: int
    attempts: int
    camera_id: int
    camera_name: str
    width: int
    height: int
    source: str
    family: str | None


def claim_calibration(session: Session, now: datetime) -> CalibrationClaim | None:
    """Take the calibration that waits longest; it counts as running from here on."""
    calibration_id = session.scalar(_workable(Calibration.status == "queued").order_by(Calibration.id).limit(1))
    if calibration_id is None:
        return None
    row = session.get_one(Calibration, calibration_id, with_for_update=True, populate_existing=True)
    if row.status != "queued":
        return None
    camera = session.get_one(Camera, row.camera_id)
    row.status = "running"
    row.attempts += 1
    row.heartbeat_at = now
    row.started_at = row.started_at or now
    row.error = None
    row.progress = {"stage": "reading the lines", "done": 0, "total": 1}
    return CalibrationClaim(
        row.id, row.attempts, camera.id, camera.name, camera.width, camera.height, row.source, row.family
    )


def has_calibration_work(session: Session) -> bool:
    """Whether any calibration waits, or is worked on."""
    return session.scalar(_workable(Calibration.status.in_(UNFINISHED)).limit(1)) is not None


def has_waiting_calibration(session: Session) -> bool:
    """Whether any calibration waits to be claimed."""
    return session.scalar(_workable(Calibration.status == "queued").limit(1)) is not None


def holds(session: Session, claim: CalibrationClaim) -> bool:
    """Whether a claim still holds: it wasn't cancelled, purged or taken back."""
    return session.scalar(select(Calibration.id).where(*_of_claim(claim))) is not None


def beat_calibration(
    session: Session, claim: CalibrationClaim, progress: Mapping[str, Any] | None, now: datetime
) -> None:
    """Say that this work is alive, and how far it is where that is known."""
    values: dict[str, Any] = {"heartbeat_at": now}
    if progress is not None:
        values["progress"] = dict(progress)
    session.execute(
        update(Calibration).where(*_of_claim(claim)).values(**values).execution_options(synchronize_session=False)
    )


def charge_calibration(session: Session, claim: CalibrationClaim, now: datetime) -> CalibrationClaim | None:
    """Count a new attempt of work that killed its worker; ``None`` when nobody wants it any more."""
    row = _claimed_row(session, claim)
    if row is None:
        return None
    row.attempts += 1
    row.heartbeat_at = now
    return CalibrationClaim(**{**vars(claim), "attempts": row.attempts})


def put_calibration_back(session: Session, claim: CalibrationClaim) -> None:
    """Queue a calibration again that was stopped on purpose; the attempt isn't counted."""
    row = _claimed_row(session, claim)
    if row is not None:
        row.status = "queued"
        row.attempts -= 1
        row.heartbeat_at = None
        row.progress = None


def release_lost_calibrations(
    session: Session, max_attempts: int, now: datetime, *, silent_since: datetime | None = None
) -> int:
    """Queue the work again that a dispatcher left behind when it died.

    Args:
        session: A writing session.
        max_attempts: What was lost so often fails instead: it may be what kills the server.
        now: When.
        silent_since: Only work without a heartbeat since then; all of it when left out.

    Returns:
        How many calibrations were taken back.
    """
    query = select(Calibration).where(Calibration.status == "running")
    if silent_since is not None:
        query = query.where(or_(Calibration.heartbeat_at.is_(None), Calibration.heartbeat_at < silent_since))
    rows = session.scalars(query.with_for_update(skip_locked=True)).all()
    for row in rows:
        row.heartbeat_at = row.progress = None
        if row.attempts < max_attempts:
            row.status = "queued"
        else:
            row.status, row.error, row.finished_at = "failed", lost_calibration_error(row.attempts), now
    return len(rows)


def store_calibration(session: Session, claim: CalibrationClaim, found: CalibrationFound, now: datetime) -> bool:
    """Store a result; False, with nothing stored, when the claim doesn't hold any more."""
    row = _claimed_row(session, claim)
    if row is None:
        return False
    row.parameters, row.result, row.lines, row.advice = found.parameters, found.result, found.lines, found.advice
    row.summary = summary = summary_of(found.result)
    row.n_images, row.n_segments = len(found.parameters["images"]), found.parameters["segments"]
    row.status, row.progress, row.error = "done", None, None
    row.heartbeat_at = row.finished_at = now
    details = {
        "calibration": row.id,
        "camera": claim.camera_name,
        "accepted": summary["accepted"],
        "lines": row.n_segments,
    }
    dataset_id = session.get_one(Camera, row.camera_id).dataset_id
    record_event(session, "camera.calibrated", now, dataset_id=dataset_id, person=row.person, details=details)
    return True


def fail_calibration(session: Session, claim: CalibrationClaim, error: dict[str, Any], now: datetime) -> bool:
    """Store why there is no result; False when the claim doesn't hold any more."""
    row = _claimed_row(session, claim)
    if row is None:
        return False
    row.status, row.error, row.progress = "failed", error, None
    row.heartbeat_at = row.finished_at = now
    return True


def lost_calibration_error(attempts: int) -> dict[str, Any]:
    """Return the reason of a calibration whose work ended with the process that did it."""
    times = "time" if attempts == 1 else "times"
    return ClearLinesError(
        f"the process that worked on it was killed, {attempts} {times}",
        hint="most often memory ran out: give the server more, or fewer workers",
    ).as_dict() | {"code": "worker-died"}


def _claimed_row(session: Session, claim: CalibrationClaim) -> Calibration | None:
    """Return the claim's row, locked; ``None`` if the claim doesn't hold any more."""
    return session.scalars(select(Calibration).where(*_of_claim(claim)).with_for_update()).one_or_none()


def _of_claim(claim: CalibrationClaim) -> tuple[ColumnElement[bool], ...]:
    return (
        Calibration.id == claim.calibration_id,
        Calibration.status == "running",
        Calibration.attempts == claim.attempts,
    )


def _workable(*conditions: ColumnElement[bool]) -> Select[int]:
    """Select the ids of calibrations that are neither deleted nor of a deleted dataset."""
    return (
        select(Calibration.id)
        .join(Camera, Camera.id == Calibration.camera_id)
        .join(Dataset, Dataset.id == Camera.dataset_id)
        .where(Calibration.deleted_at.is_(None), Dataset.deleted_at.is_(None), *conditions)
    )
