"""Runs of the pipeline, their work on each image, and the lenses they estimated."""

from __future__ import annotations

from datetime import datetime
from typing import Any

from sqlalchemy import Float, ForeignKey, Index, LargeBinary, String, UniqueConstraint, text
from sqlalchemy.orm import Mapped, mapped_column

from app.db.models.base import NEVER_REUSED, Base, one_of

WORK_STATES = ("queued", "running", "done", "failed", "cancelled")
TO_JUDGE = text("status = 'done' AND camera_estimate_id IS NULL AND error IS NULL")


class Run(Base):
    """One run of the pipeline over images, with its parameters and code version."""

    __tablename__ = "runs"
    __table_args__ = (one_of("status", WORK_STATES), NEVER_REUSED)

    id: Mapped[int] = mapped_column(primary_key=True)
    dataset_id: Mapped[int] = mapped_column(ForeignKey("datasets.id", ondelete="CASCADE"), index=True)
    parameters: Mapped[dict[str, Any]]
    code_version: Mapped[str] = mapped_column(String(60))
    status: Mapped[str] = mapped_column(String(20), default="queued", index=True)
    error: Mapped[dict[str, Any] | None]
    created_at: Mapped[datetime]
    started_at: Mapped[datetime | None]
    finished_at: Mapped[datetime | None]
    deleted_at: Mapped[datetime | None]


class RunImage(Base):
    """The work of a run on one image: the only truth about what is done and what isn't."""

    __tablename__ = "run_images"
    __table_args__ = (
        UniqueConstraint("run_id", "image_id"),
        one_of("status", WORK_STATES),
        Index("ix_run_images_status_run_id_id", "status", "run_id", "id"),
        Index("ix_run_images_run_id_heartbeat_at", "run_id", "heartbeat_at"),
        Index("ix_run_images_to_judge", "run_id", "id", sqlite_where=TO_JUDGE, postgresql_where=TO_JUDGE),
        NEVER_REUSED,
    )

    id: Mapped[int] = mapped_column(primary_key=True)
    run_id: Mapped[int] = mapped_column(ForeignKey("runs.id", ondelete="CASCADE"))
    image_id: Mapped[int] = mapped_column(ForeignKey("images.id", ondelete="CASCADE"), index=True)
    status: Mapped[str] = mapped_column(String(20), default="queued")
    attempts: Mapped[int] = mapped_column(default=0)
    heartbeat_at: Mapped[datetime | None]
    error: Mapped[dict[str, Any] | None]
    milliseconds: Mapped[float | None] = mapped_column(Float)
    # what the run changed for the decisions made before; see app/services/carrying.py
    changes: Mapped[dict[str, Any] | None]
    distortion: Mapped[dict[str, Any] | None]  # the lens from this image alone, where the run asked for that
    # the joint estimate that the straightness of this image's candidates was judged under
    camera_estimate_id: Mapped[int | None] = mapped_column(
        ForeignKey("camera_estimates.id", ondelete="SET NULL"), index=True
    )
    # shorter segments that only the lens estimate reads; npz bytes
    lens_segments: Mapped[bytes | None] = mapped_column(LargeBinary, deferred=True)


class CameraEstimate(Base):
    """A camera's distortion as one run estimated it."""

    __tablename__ = "camera_estimates"
    __table_args__ = (UniqueConstraint("run_id", "camera_id"),)

    id: Mapped[int] = mapped_column(primary_key=True)
    run_id: Mapped[int] = mapped_column(ForeignKey("runs.id", ondelete="CASCADE"))
    camera_id: Mapped[int] = mapped_column(ForeignKey("cameras.id", ondelete="CASCADE"), index=True)
    distortion: Mapped[dict[str, Any]]
    accepted: Mapped[bool]
    created_at: Mapped[datetime]
