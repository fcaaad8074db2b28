"""Calibrations: a camera's lens from its reviewed lines, with the work that makes it."""

from __future__ import annotations

from datetime import datetime
from typing import Any

from sqlalchemy import ForeignKey, Index, LargeBinary, String, text
from sqlalchemy.orm import Mapped, mapped_column

from app.db.models.base import NEVER_REUSED, Base, one_of
from app.db.models.runs import WORK_STATES

CALIBRATION_SOURCES = ("labels", "candidates")
UNFINISHED = text("status IN ('queued', 'running')")


class Calibration(Base):
    """One estimate of a camera's lens from lines of its images; later decisions don't change it.

    At most one of a camera is at work, which an index sees to.
    """

    __tablename__ = "calibrations"
    __table_args__ = (
        one_of("source", CALIBRATION_SOURCES),
        one_of("status", WORK_STATES),
        Index("ix_calibrations_camera_id_id", "camera_id", "id"),
        Index(
            "uq_calibrations_camera_unfinished",
            "camera_id",
            unique=True,
            sqlite_where=UNFINISHED,
            postgresql_where=UNFINISHED,
        ),
        NEVER_REUSED,
    )

    id: Mapped[int] = mapped_column(primary_key=True)
    camera_id: Mapped[int] = mapped_column(ForeignKey("cameras.id", ondelete="CASCADE"))
    person: Mapped[str | None] = mapped_column(String(200))
    source: Mapped[str] = mapped_column(String(20))
    family: Mapped[str | None] = mapped_column(String(20))  # the lens model asked for; the best one where it is null
    status: Mapped[str] = mapped_column(String(20), default="queued", index=True)
    attempts: Mapped[int] = mapped_column(default=0)
    heartbeat_at: Mapped[datetime | None]
    progress: Mapped[dict[str, Any] | None]  # {"stage", "done", "total"}
    # what was read and what there was: images and segments, and the camera's newest decision then
    parameters: Mapped[dict[str, Any]]
    summary: Mapped[dict[str, Any] | None]  # what lists show of the result
    result: Mapped[dict[str, Any] | None] = mapped_column(deferred=True)
    advice: Mapped[dict[str, Any] | None] = mapped_column(deferred=True)
    lines: Mapped[bytes | None] = mapped_column(LargeBinary, deferred=True)  # npz of services/calibration_lines.py
    error: Mapped[dict[str, Any] | None]
    code_version: Mapped[str] = mapped_column(String(60))
    n_images: Mapped[int] = mapped_column(default=0)
    n_segments: Mapped[int] = mapped_column(default=0)
    created_at: Mapped[datetime]
    started_at: Mapped[datetime | None]
    finished_at: Mapped[datetime | None]
    deleted_at: Mapped[datetime | None]
