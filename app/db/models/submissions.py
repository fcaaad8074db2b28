"""Methods, what they submitted, and the scores of it."""

from __future__ import annotations

from datetime import datetime
from typing import Any

from sqlalchemy import Float, ForeignKey, Index, LargeBinary, String, Text, UniqueConstraint
from sqlalchemy.orm import Mapped, mapped_column, relationship

from app.db.models.base import NEVER_REUSED, Base, one_of
from app.db.models.splits import SplitVersion

METHOD_KINDS = ("method", "baseline", "ceiling")
SUBMISSION_STATES = ("received", "validating", "queued", "scoring", "scored", "invalid", "failed", "withdrawn")
FINAL_STATES = ("scored", "invalid", "failed", "withdrawn")
SUBMISSION_VISIBILITIES = ("public", "private")
SCORE_STATES = ("queued", "running", "done", "failed")


class Method(Base):
    """What an author calls a detector; an anonymous one doesn't show its owner's name."""

    __tablename__ = "methods"
    __table_args__ = (UniqueConstraint("slug"), one_of("kind", METHOD_KINDS), NEVER_REUSED)

    id: Mapped[int] = mapped_column(primary_key=True)
    slug: Mapped[str] = mapped_column(String(120))
    name: Mapped[str] = mapped_column(String(200))
    description: Mapped[str | None] = mapped_column(Text)
    code_url: Mapped[str | None] = mapped_column(String(2000))
    paper_url: Mapped[str | None] = mapped_column(String(2000))
    owner: Mapped[str | None] = mapped_column(String(200), index=True)
    anonymous: Mapped[bool] = mapped_column(default=False)
    kind: Mapped[str] = mapped_column(String(20), default="method")
    created_at: Mapped[datetime]


class Submission(Base):
    """One upload of a method for one split version."""

    __tablename__ = "submissions"
    __table_args__ = (
        one_of("status", SUBMISSION_STATES),
        one_of("visibility", SUBMISSION_VISIBILITIES),
        Index("ix_submissions_version_status", "split_version_id", "status"),
        Index("ix_submissions_person_created", "person", "created_at"),
        NEVER_REUSED,
    )

    id: Mapped[int] = mapped_column(primary_key=True)
    split_version_id: Mapped[int] = mapped_column(ForeignKey("split_versions.id", ondelete="CASCADE"))
    method_id: Mapped[int] = mapped_column(ForeignKey("methods.id", ondelete="CASCADE"), index=True)
    label: Mapped[str | None] = mapped_column(String(200))  # the author's word for this version of the method
    person: Mapped[str | None] = mapped_column(String(200))
    status: Mapped[str] = mapped_column(String(20), default="received", index=True)
    visibility: Mapped[str] = mapped_column(String(20), default="public")
    upload_sha256: Mapped[str | None] = mapped_column(ForeignKey("blobs.sha256"), index=True)
    upload_name: Mapped[str | None] = mapped_column(String(500))
    segments_sha256: Mapped[str | None] = mapped_column(ForeignKey("blobs.sha256"), index=True)  # an npz set
    submission_hash: Mapped[str | None] = mapped_column(String(64))
    n_images: Mapped[int] = mapped_column(default=0)
    n_segments: Mapped[int] = mapped_column(default=0)
    n_points: Mapped[int] = mapped_column(default=0)
    has_scores: Mapped[bool] = mapped_column(default=False)
    missing: Mapped[list[str] | None]
    attempts: Mapped[int] = mapped_column(default=0)
    heartbeat_at: Mapped[datetime | None]
    error: Mapped[dict[str, Any] | None]
    log: Mapped[list[dict[str, Any]] | None]  # [{"at": ..., "text": ...}]
    webhook_url: Mapped[str | None] = mapped_column(String(2000))
    created_at: Mapped[datetime]
    queued_at: Mapped[datetime | None]
    scored_at: Mapped[datetime | None]
    withdrawn_at: Mapped[datetime | None]

    split_version: Mapped[SplitVersion] = relationship()
    method: Mapped[Method] = relationship()
    scores: Mapped[list[Score]] = relationship(back_populates="submission", cascade="all, delete-orphan")


class Score(Base):
    """The numbers of a submission under one version of a protocol and one version of the truth; old ones stay."""

    __tablename__ = "scores"
    __table_args__ = (
        UniqueConstraint(
            "submission_id",
            "split_version_id",
            "protocol",
            "protocol_version",
            name="uq_scores_submission_version_protocol",
        ),
        one_of("status", SCORE_STATES),
        Index("ix_scores_version_protocol", "split_version_id", "protocol"),
        NEVER_REUSED,
    )

    id: Mapped[int] = mapped_column(primary_key=True)
    submission_id: Mapped[int] = mapped_column(ForeignKey("submissions.id", ondelete="CASCADE"))
    split_version_id: Mapped[int] = mapped_column(ForeignKey("split_versions.id", ondelete="CASCADE"))
    protocol: Mapped[str] = mapped_column(String(40))
    protocol_version: Mapped[str] = mapped_column(String(20))
    scorer_version: Mapped[str] = mapped_column(String(60))
    truth_hash: Mapped[str] = mapped_column(String(64))
    submission_hash: Mapped[str] = mapped_column(String(64))
    status: Mapped[str] = mapped_column(String(20), default="queued", index=True)
    f1: Mapped[float | None] = mapped_column(Float)
    f1_low: Mapped[float | None] = mapped_column(Float)
    f1_high: Mapped[float | None] = mapped_column(Float)
    totals: Mapped[dict[str, Any] | None]
    milliseconds: Mapped[float | None] = mapped_column(Float)
    created_at: Mapped[datetime]
    done_at: Mapped[datetime | None]

    submission: Mapped[Submission] = relationship(back_populates="scores")
    images: Mapped[list[ImageScore]] = relationship(cascade="all, delete-orphan")


class ImageScore(Base):
    """The numbers of one image under a score; ``record`` is the npz of ``app.evaluation``'s per-image record."""

    __tablename__ = "image_scores"
    __table_args__ = (UniqueConstraint("score_id", "split_image_id"),)

    id: Mapped[int] = mapped_column(primary_key=True)
    score_id: Mapped[int] = mapped_column(ForeignKey("scores.id", ondelete="CASCADE"))
    split_image_id: Mapped[int] = mapped_column(ForeignKey("split_images.id", ondelete="CASCADE"), index=True)
    f1: Mapped[float | None] = mapped_column(Float)
    precision: Mapped[float | None] = mapped_column(Float)
    recall: Mapped[float | None] = mapped_column(Float)
    tp: Mapped[int]
    fp: Mapped[int]
    fn: Mapped[int]
    metrics: Mapped[dict[str, Any] | None]
    record: Mapped[bytes | None] = mapped_column(LargeBinary, deferred=True)
