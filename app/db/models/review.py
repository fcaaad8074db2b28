"""Several people on the same images: who works on what, second opinions, edits by hand, and learnt suggestions."""

from __future__ import annotations

from datetime import datetime
from typing import Any

from sqlalchemy import ForeignKey, Index, Integer, LargeBinary, String
from sqlalchemy.orm import Mapped, mapped_column

from app.db.models.base import NEVER_REUSED, Base, one_of
from app.verdicts import VERDICTS

EDIT_KINDS = ("trace", "cut", "join", "extend", "trim")
SECOND_REVIEW_STATES = ("open", "done")
SECOND_DECISION_KINDS = ("judge", "undo", "redo", "accept")


class Lease(Base):
    """A page that has an image open; at most one of an image's pages holds it and may decide."""

    __tablename__ = "leases"

    image_id: Mapped[int] = mapped_column(ForeignKey("images.id", ondelete="CASCADE"), primary_key=True)
    client_id: Mapped[str] = mapped_column(String(36), primary_key=True)
    person: Mapped[str | None] = mapped_column(String(200))
    holds: Mapped[bool]
    since: Mapped[datetime]
    expires_at: Mapped[datetime] = mapped_column(index=True)


class Edit(Base):
    """Segments replaced by others that a hand made: a group of decisions that also changes what is current.

    ``client_id`` is the group that its decisions carry.
    """

    __tablename__ = "edits"
    __table_args__ = (one_of("kind", EDIT_KINDS), NEVER_REUSED)

    id: Mapped[int] = mapped_column(primary_key=True)
    image_id: Mapped[int] = mapped_column(ForeignKey("images.id", ondelete="CASCADE"), index=True)
    person: Mapped[str | None] = mapped_column(String(200))
    kind: Mapped[str] = mapped_column(String(20))
    client_id: Mapped[str] = mapped_column(String(36), unique=True)
    replaced: Mapped[list[int]]
    added: Mapped[list[int]]
    created_at: Mapped[datetime]
    undone_at: Mapped[datetime | None]


class SecondReview(Base):
    """A second person's review of an image, made without seeing the first."""

    __tablename__ = "second_reviews"
    __table_args__ = (one_of("status", SECOND_REVIEW_STATES), NEVER_REUSED)

    id: Mapped[int] = mapped_column(primary_key=True)
    image_id: Mapped[int] = mapped_column(ForeignKey("images.id", ondelete="CASCADE"), unique=True)
    person: Mapped[str | None] = mapped_column(String(200))
    status: Mapped[str] = mapped_column(String(20), default="open", index=True)
    first_decision_id: Mapped[int | None]  # the image's last decision when it began: later ones aren't of the first
    created_at: Mapped[datetime]
    done_at: Mapped[datetime | None]


class SecondDecision(Base):
    """One judgement of a second review; append-only. The latest of a segment counts."""

    __tablename__ = "second_decisions"
    __table_args__ = (
        one_of("verdict", VERDICTS),
        one_of("kind", SECOND_DECISION_KINDS),
        Index("ix_second_decisions_second_review_id_id", "second_review_id", "id"),
        NEVER_REUSED,
    )

    id: Mapped[int] = mapped_column(primary_key=True)
    second_review_id: Mapped[int] = mapped_column(ForeignKey("second_reviews.id", ondelete="CASCADE"))
    segment_id: Mapped[int] = mapped_column(ForeignKey("segments.id", ondelete="CASCADE"), index=True)
    person: Mapped[str | None] = mapped_column(String(200))
    verdict: Mapped[str] = mapped_column(String(20))
    previous: Mapped[str] = mapped_column(String(20))
    kind: Mapped[str] = mapped_column(String(20))
    client_id: Mapped[str] = mapped_column(String(36), unique=True)
    group_id: Mapped[str] = mapped_column(String(36))
    target_group_id: Mapped[str | None] = mapped_column(String(36))
    elapsed_ms: Mapped[int | None] = mapped_column(Integer)
    created_at: Mapped[datetime]


class Adjudication(Base):
    """What was decided where first and second review differ."""

    __tablename__ = "adjudications"
    __table_args__ = (one_of("verdict", VERDICTS),)

    second_review_id: Mapped[int] = mapped_column(ForeignKey("second_reviews.id", ondelete="CASCADE"), primary_key=True)
    segment_id: Mapped[int] = mapped_column(ForeignKey("segments.id", ondelete="CASCADE"), primary_key=True, index=True)
    first: Mapped[str] = mapped_column(String(20))
    second: Mapped[str] = mapped_column(String(20))
    verdict: Mapped[str] = mapped_column(String(20))
    decision_id: Mapped[int] = mapped_column(ForeignKey("decisions.id", ondelete="CASCADE"), index=True)
    person: Mapped[str | None] = mapped_column(String(200))
    created_at: Mapped[datetime]


class ImageFeatures(Base):
    """What the suggestions know of an image's candidates; made anew when its candidates or the features change."""

    __tablename__ = "image_features"

    image_id: Mapped[int] = mapped_column(ForeignKey("images.id", ondelete="CASCADE"), primary_key=True)
    revision: Mapped[int]
    version: Mapped[str] = mapped_column(String(60))
    content: Mapped[bytes] = mapped_column(LargeBinary, deferred=True)
    created_at: Mapped[datetime]


class SuggestionModel(Base):
    """What was learnt from a dataset's decisions; numbers only."""

    __tablename__ = "suggestion_models"
    __table_args__ = (NEVER_REUSED,)

    id: Mapped[int] = mapped_column(primary_key=True)
    dataset_id: Mapped[int] = mapped_column(ForeignKey("datasets.id", ondelete="CASCADE"), index=True)
    version: Mapped[str] = mapped_column(String(60))
    n_decisions: Mapped[int]
    n_images: Mapped[int]
    last_decision_id: Mapped[int]
    parameters: Mapped[dict[str, Any]] = mapped_column(deferred=True)
    report: Mapped[dict[str, Any]]
    created_at: Mapped[datetime]


class SuggestionTraining(Base):
    """What a dataset's next training waits for, and why its latest one failed; no row while neither is so."""

    __tablename__ = "suggestion_trainings"

    dataset_id: Mapped[int] = mapped_column(ForeignKey("datasets.id", ondelete="CASCADE"), primary_key=True)
    asked_at: Mapped[datetime | None]  # somebody wants it now, however few decisions are new
    error: Mapped[dict[str, Any] | None]
    failed_decision_id: Mapped[int | None]  # it isn't tried again before a decision after this one
