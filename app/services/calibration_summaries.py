"""Calibrations as lists and the camera's page show them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from datetime import datetime, timedelta
from typing import Any

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.db.models import Calibration, Camera
from app.services.calibrations import get_calibration
from app.services.paging import Order, Page, checked_limit, page_of

NEWEST_FIRST = Order("calibrations", Calibration.created_at, Calibration.id, descending=True)


@dataclass(frozen=True)
class CalibrationBrief:
    """A calibration without its maps.

    Attributes:
        family: The lens model that was asked for; ``None`` for the best one.
        progress: ``{"stage", "done", "total"}`` while it is at work.
        parameters: What was read: ``images`` and ``segments`` used, ``images_available``, ``segments_available``.
        summary: What `summary_of` tells of its result; ``None`` before it is done.
        restorable_until: Of a deleted one, when it goes for good.
    """

    id: int
    camera_id: int
    person: str | None
    source: str
    family: str | None
    status: str
    attempts: int
    progress: dict[str, Any] | None
    parameters: dict[str, Any]
    summary: dict[str, Any] | None
    error: dict[str, Any] | None
    code_version: str
    n_images: int
    n_segments: int
    created_at: datetime
    started_at: datetime | None
    finished_at: datetime | None
    deleted_at: datetime | None
    restorable_until: datetime | None


@dataclass(frozen=True)
class CalibrationWhole(CalibrationBrief):
    """A calibration with its result, ``Calibration.as_dict`` of ``app.calibration``; ``None`` before it is done."""

    result: dict[str, Any] | None


def calibration_brief(row: Calibration, *, grace: timedelta) -> CalibrationBrief:
    """Return a calibration without its maps.

    Args:
        row: The row.
        grace: How long what was deleted can be restored.
    """
    return CalibrationBrief(**_fields(row, grace))


def calibration_whole(session: Session, calibration_id: int, *, grace: timedelta) -> CalibrationWhole:
    """Return a calibration, deleted ones too, with its result.

    Raises:
        NotFound: When there is none.
    """
    row = get_calibration(session, calibration_id, deleted=True)
    return CalibrationWhole(**_fields(row, grace), result=row.result)


def list_calibrations(
    session: Session,
    camera: Camera,
    *,
    grace: timedelta,
    deleted: bool = False,
    limit: int = 100,
    cursor: str | None = None,
) -> Page[CalibrationBrief]:
    """Return a camera's calibrations, newest first; or those that are deleted and can still be restored.

    Raises:
        InvalidInput: On a limit or cursor that can't be.
    """
    limit = checked_limit(limit)
    wanted = Calibration.deleted_at.is_not(None) if deleted else Calibration.deleted_at.is_(None)
    query = select(Calibration).where(Calibration.camera_id == camera.id, wanted)
    total = session.scalar(select(func.count()).select_from(query.subquery())) or 0
    if cursor:
        query = query.where(NEWEST_FIRST.after(cursor))
    rows = session.scalars(query.order_by(*NEWEST_FIRST.clauses()).limit(limit + 1)).all()
    page = page_of(rows, limit, NEWEST_FIRST, lambda row: (row.created_at, row.id), total)
    return page.map(lambda row: calibration_brief(row, grace=grace))


def newest_with(session: Session, camera_id: int, states: Sequence[str]) -> Calibration | None:
    """Return a camera's newest calibration in one of the states."""
    query = select(Calibration).where(
        Calibration.camera_id == camera_id, Calibration.status.in_(states), Calibration.deleted_at.is_(None)
    )
    return session.scalars(query.order_by(Calibration.id.desc()).limit(1)).one_or_none()


def summary_of(result: Mapping[str, Any]) -> dict[str, Any]:
    """Return what lists show of a result (``Calibration.as_dict``)."""
    uncertainty = result["uncertainty"]
    return {
        "accepted": result["accepted"],
        "family": result["lens"]["family"],
        "released": list(result["released"]),
        "reasons": list(result["reasons"]),
        "warnings": [warning["code"] for warning in result["warnings"]],
        **{name: uncertainty[name] for name in ("pred", "bound95", "correction")},
        "noise": result["noise"],
        "inliers": result["counts"]["inliers"],
    }


def _fields(row: Calibration, grace: timedelta) -> dict[str, Any]:
    own = {field.name for field in fields(CalibrationBrief)} - {"parameters", "restorable_until"}
    read = {name: value for name, value in row.parameters.items() if name not in ("images", "newest_decision")}
    until = None if row.deleted_at is None else row.deleted_at + grace
    return {**{name: getattr(row, name) for name in own}, "parameters": read, "restorable_until": until}
