"""Candidates, what people decided about them, and the audit of everything else that was done."""

from __future__ import annotations

from datetime import datetime
from typing import TYPE_CHECKING, Any

from sqlalchemy import Float, ForeignKey, Index, Integer, LargeBinary, String, Text, text
from sqlalchemy.orm import Mapped, mapped_column, relationship

from app.db.models.base import NEVER_REUSED, Base, one_of
from app.verdicts import VERDICTS

if TYPE_CHECKING:
    from app.db.models.datasets import Image

REVIEW_STATES = ("open", "done", "discarded")
ORIGINS = ("pipeline", "manual", "import")
DECISION_KINDS = ("judge", "undo", "redo", "carry", "import", "accept", "take_over")
RECALLS = ("complete", "nearly", "incomplete")


class Segment(Base):
    """A candidate, or a segment from an import or a hand.

    ``points`` is the float32 little-endian ``(n_points, 2)`` array: the same bytes in memory, column, wire and browser.
    """

    __tablename__ = "segments"
    __table_args__ = (
        one_of("origin", ORIGINS),
        Index("ix_segments_image_retired", "image_id", "retired_at"),
        Index("ix_segments_image_score", "image_id", "score"),  # images are chosen by the scores in them
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
    reason: Mapped[str | None] = mapped_column(String(40))  # why it was rejected
    suggestion: Mapped[float | None] = mapped_column(Float)  # the probability of keep that the person saw
    created_at: Mapped[datetime]


class SegmentState(Base):
    """The current verdict of a segment, written in the transaction of its decision."""

    __tablename__ = "segment_states"
    __table_args__ = (
        one_of("verdict", VERDICTS),
        Index(
            "ix_segment_states_reason_given",
            "reason",
            sqlite_where=text("reason IS NOT NULL"),
            postgresql_where=text("reason IS NOT NULL"),
        ),
    )

    segment_id: Mapped[int] = mapped_column(ForeignKey("segments.id", ondelete="CASCADE"), primary_key=True)
    verdict: Mapped[str] = mapped_column(String(20))
    reason: Mapped[str | None] = mapped_column(String(40))
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
    recall: Mapped[str | None] = mapped_column(String(20))  # how much of what is straight the labels hold
    updated_at: Mapped[datetime]

    image: Mapped[Image] = relationship(back_populates="review")


class Event(Base):
    """Append-only audit of what was imported, renamed, deleted, restored, started... and who signed in."""

    __tablename__ = "events"
    __table_args__ = (
        Index("ix_events_dataset_id_created_at_id", "dataset_id", "created_at", "id"),
        Index("ix_events_created_at_id", "created_at", "id"),
        Index("ix_events_person_id", "person", "id"),
        Index("ix_events_kind_id", "kind", "id"),
    )

    id: Mapped[int] = mapped_column(primary_key=True)
    dataset_id: Mapped[int | None] = mapped_column(ForeignKey("datasets.id", ondelete="SET NULL"))
    kind: Mapped[str] = mapped_column(String(60))
    person: Mapped[str | None] = mapped_column(String(200))
    address: Mapped[str | None] = mapped_column(String(100))  # where they asked from, on what concerns accounts
    details: Mapped[dict[str, Any]]
    created_at: Mapped[datetime]
