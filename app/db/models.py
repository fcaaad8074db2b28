"""All tables on one page.

Integer keys inside, slugs and sha256 outside. Rows that can be deleted carry ``deleted_at``: they are hidden at once
and purged after the grace period, until when the deletion can be undone. Times are UTC.
"""

from __future__ import annotations

from datetime import UTC, datetime
from typing import Any, ClassVar

from sqlalchemy import (
    JSON,
    CheckConstraint,
    DateTime,
    Dialect,
    Float,
    ForeignKey,
    Index,
    Integer,
    LargeBinary,
    MetaData,
    String,
    Text,
    TypeDecorator,
    UniqueConstraint,
    text,
)
from sqlalchemy.orm import DeclarativeBase, Mapped, mapped_column, relationship

VERDICTS = ("keep", "reject", "ambiguous", "undecided")
WORK_STATES = ("queued", "running", "done", "failed", "cancelled")
REVIEW_STATES = ("open", "done", "discarded")
ORIGINS = ("pipeline", "manual", "import")
DECISION_KINDS = ("judge", "undo", "redo", "carry", "import")

# Names sort by code point on both databases, as Python's sorted() does.
Name = String(500).with_variant(String(500, collation="C"), "postgresql")

# An id is never used again: browsers keep what they fetched under it.
NEVER_REUSED = {"sqlite_autoincrement": True}


class UtcDateTime(TypeDecorator[datetime]):
    """A time zone aware UTC time, also on SQLite, which stores none."""

    impl = DateTime(timezone=True)
    cache_ok = True

    def process_bind_param(self, value: datetime | None, dialect: Dialect) -> datetime | None:
        """Refuse naive times; store UTC."""
        del dialect
        if value is not None and value.tzinfo is None:
            raise ValueError("a time without a zone")
        return None if value is None else value.astimezone(UTC)

    def process_result_value(self, value: datetime | None, dialect: Dialect) -> datetime | None:
        """Return the time with its zone."""
        del dialect
        return None if value is None else value.replace(tzinfo=UTC) if value.tzinfo is None else value.astimezone(UTC)


class Base(DeclarativeBase):
    """Base of all tables; constraint names are fixed so that migrations can name them."""

    metadata = MetaData(
        naming_convention={
            "ix": "ix_%(table_name)s_%(column_0_N_name)s",
            "uq": "uq_%(table_name)s_%(column_0_N_name)s",
            "ck": "ck_%(table_name)s_%(constraint_name)s",
            "fk": "fk_%(table_name)s_%(column_0_name)s_%(referred_table_name)s",
            "pk": "pk_%(table_name)s",
        }
    )
    type_annotation_map: ClassVar[dict[Any, Any]] = {
        datetime: UtcDateTime(),
        dict[str, Any]: JSON(none_as_null=True),
        list[str]: JSON(none_as_null=True),
        bytes: LargeBinary(),
    }


def one_of(column: str, values: tuple[str, ...]) -> CheckConstraint:
    """Return a constraint that a column holds one of the values."""
    return CheckConstraint(f"{column} IN ({', '.join(repr(value) for value in values)})", name=column)


def alive_unique(name: str, *columns: str) -> Index:
    """Return a unique index over the rows that aren't deleted."""
    alive = text("deleted_at IS NULL")
    return Index(name, *columns, unique=True, sqlite_where=alive, postgresql_where=alive)


class Installation(Base):
    """The one row that tells this database from every other, so that a browser doesn't take one for another."""

    __tablename__ = "installations"

    instance: Mapped[str] = mapped_column(String(36), primary_key=True)


class Dataset(Base):
    """A named set of images."""

    __tablename__ = "datasets"
    __table_args__ = (
        UniqueConstraint("slug"),
        alive_unique("uq_datasets_name_alive", "name"),
        NEVER_REUSED,
    )

    id: Mapped[int] = mapped_column(primary_key=True)
    slug: Mapped[str] = mapped_column(String(120))
    name: Mapped[str] = mapped_column(String(200))
    created_at: Mapped[datetime]
    deleted_at: Mapped[datetime | None]


class Camera(Base):
    """The images of a dataset that share one lens."""

    __tablename__ = "cameras"
    __table_args__ = (UniqueConstraint("dataset_id", "name"), NEVER_REUSED)

    id: Mapped[int] = mapped_column(primary_key=True)
    dataset_id: Mapped[int] = mapped_column(ForeignKey("datasets.id", ondelete="CASCADE"))
    name: Mapped[str] = mapped_column(String(300))
    width: Mapped[int]
    height: Mapped[int]
    reference: Mapped[dict[str, Any] | None]  # {"K": 3x3, "D": [k1, k2, p1, p2, k3]} in OpenCV's convention
    created_at: Mapped[datetime]


class Blob(Base):
    """Bytes of an uploaded file; the file itself lies in the blob store under its hash."""

    __tablename__ = "blobs"

    sha256: Mapped[str] = mapped_column(String(64), primary_key=True)
    size: Mapped[int]
    media_type: Mapped[str] = mapped_column(String(100))
    created_at: Mapped[datetime]


class Image(Base):
    """One image of a dataset, unique there by name and by content."""

    __tablename__ = "images"
    __table_args__ = (
        alive_unique("uq_images_dataset_name_alive", "dataset_id", "name"),
        alive_unique("uq_images_dataset_content_alive", "dataset_id", "sha256"),
        Index("ix_images_dataset_camera", "dataset_id", "camera_id"),
        NEVER_REUSED,
    )

    id: Mapped[int] = mapped_column(primary_key=True)
    dataset_id: Mapped[int] = mapped_column(ForeignKey("datasets.id", ondelete="CASCADE"))
    name: Mapped[str] = mapped_column(Name)  # the path under the root without extension: KITTI/000000
    file_name: Mapped[str] = mapped_column(String(500))
    sha256: Mapped[str] = mapped_column(ForeignKey("blobs.sha256"), index=True)
    width: Mapped[int]
    height: Mapped[int]
    bits: Mapped[int]
    camera_id: Mapped[int] = mapped_column(ForeignKey("cameras.id"), index=True)
    source: Mapped[str | None] = mapped_column(String(300))
    sequence: Mapped[str | None] = mapped_column(String(300))
    revision: Mapped[int] = mapped_column(default=0)  # rises when the set of candidates changes
    # counts of the current segments, written by app.services.candidates.refresh_counts in the same transaction
    n_candidates: Mapped[int] = mapped_column(default=0)
    n_keep: Mapped[int] = mapped_column(default=0)
    n_reject: Mapped[int] = mapped_column(default=0)
    n_ambiguous: Mapped[int] = mapped_column(default=0)
    current_run_image_id: Mapped[int | None] = mapped_column(
        ForeignKey("run_images.id", use_alter=True, ondelete="SET NULL"), index=True
    )
    created_at: Mapped[datetime]
    deleted_at: Mapped[datetime | None]

    camera: Mapped[Camera] = relationship()
    review: Mapped[Review] = relationship(back_populates="image", cascade="all, delete-orphan")


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
        Index("ix_run_images_status_run", "status", "run_id"),
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


class Segment(Base):
    """A candidate, or a segment from an import or a hand.

    ``points`` is the float32 little-endian ``(n_points, 2)`` array: the same bytes in memory, column, wire and browser.
    """

    __tablename__ = "segments"
    __table_args__ = (
        one_of("origin", ORIGINS),
        Index("ix_segments_image_retired", "image_id", "retired_at"),
        NEVER_REUSED,
    )

    id: Mapped[int] = mapped_column(primary_key=True)
    image_id: Mapped[int] = mapped_column(ForeignKey("images.id", ondelete="CASCADE"))
    run_image_id: Mapped[int | None] = mapped_column(ForeignKey("run_images.id", ondelete="SET NULL"), index=True)
    ordinal: Mapped[int]
    n_points: Mapped[int]
    points: Mapped[bytes] = mapped_column(LargeBinary, deferred=True)
    x0: Mapped[float] = mapped_column(Float)
    y0: Mapped[float] = mapped_column(Float)
    x1: Mapped[float] = mapped_column(Float)
    y1: Mapped[float] = mapped_column(Float)
    length: Mapped[float] = mapped_column(Float)
    residual: Mapped[float | None] = mapped_column(Float)
    score: Mapped[float | None] = mapped_column(Float)
    straightness: Mapped[float | None] = mapped_column(Float)
    origin: Mapped[str] = mapped_column(String(20))
    retired_at: Mapped[datetime | None]  # set when a later run replaced it
    # the later run's candidate that it matched: a verdict that comes late for this one goes there
    replaced_by_id: Mapped[int | None] = mapped_column(ForeignKey("segments.id", ondelete="SET NULL"), index=True)

    state: Mapped[SegmentState | None] = relationship(back_populates="segment", cascade="all, delete-orphan")


class Decision(Base):
    """One judgement of one segment; append-only. ``group_id`` joins what one key press did."""

    __tablename__ = "decisions"
    __table_args__ = (
        one_of("verdict", VERDICTS),
        one_of("kind", DECISION_KINDS),
        Index("ix_decisions_image_id_id", "image_id", "id"),
        NEVER_REUSED,
    )

    id: Mapped[int] = mapped_column(primary_key=True)
    image_id: Mapped[int] = mapped_column(ForeignKey("images.id", ondelete="CASCADE"))
    segment_id: Mapped[int] = mapped_column(ForeignKey("segments.id", ondelete="CASCADE"), index=True)
    person: Mapped[str | None] = mapped_column(String(200))
    verdict: Mapped[str] = mapped_column(String(20))
    previous: Mapped[str] = mapped_column(String(20))
    kind: Mapped[str] = mapped_column(String(20))
    client_id: Mapped[str] = mapped_column(String(36), unique=True)
    group_id: Mapped[str] = mapped_column(String(36))
    target_group_id: Mapped[str | None] = mapped_column(String(36))  # the group that an undo or redo is about
    elapsed_ms: Mapped[int | None] = mapped_column(Integer)
    created_at: Mapped[datetime]


class SegmentState(Base):
    """The current verdict of a segment, written in the transaction of its decision."""

    __tablename__ = "segment_states"
    __table_args__ = (one_of("verdict", VERDICTS),)

    segment_id: Mapped[int] = mapped_column(ForeignKey("segments.id", ondelete="CASCADE"), primary_key=True)
    verdict: Mapped[str] = mapped_column(String(20))
    decision_id: Mapped[int] = mapped_column(ForeignKey("decisions.id", ondelete="CASCADE"), index=True)

    segment: Mapped[Segment] = relationship(back_populates="state")


class Review(Base):
    """How far the people are with an image."""

    __tablename__ = "reviews"
    __table_args__ = (one_of("status", REVIEW_STATES),)

    image_id: Mapped[int] = mapped_column(ForeignKey("images.id", ondelete="CASCADE"), primary_key=True)
    status: Mapped[str] = mapped_column(String(20), default="open", index=True)
    reason: Mapped[str | None] = mapped_column(Text)
    person: Mapped[str | None] = mapped_column(String(200))
    updated_at: Mapped[datetime]

    image: Mapped[Image] = relationship(back_populates="review")


class Event(Base):
    """Append-only audit of what was imported, renamed, deleted, restored, started..."""

    __tablename__ = "events"

    id: Mapped[int] = mapped_column(primary_key=True)
    dataset_id: Mapped[int | None] = mapped_column(ForeignKey("datasets.id", ondelete="SET NULL"), index=True)
    kind: Mapped[str] = mapped_column(String(60))
    person: Mapped[str | None] = mapped_column(String(200))
    details: Mapped[dict[str, Any]]
    created_at: Mapped[datetime]
