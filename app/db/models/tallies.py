"""Counts that lists and overviews show, kept beside what they count so that nobody has to count it over and over.

Triggers write them in the transaction of each change, as rows of differences: adding a row waits for nobody, where one
row of totals would have everyone who decides on a dataset's images wait for everyone else. A total is the sum of its
rows; `app.services.tallies` merges them from time to time. They can be made anew from what they count at any time.
"""

from __future__ import annotations

from sqlalchemy import ForeignKey, Index, String, text
from sqlalchemy.orm import Mapped, mapped_column

from app.db.models.base import Base

LOOSE = text("NOT merged")


class ImageTally(Base):
    """Images of a dataset that are alike in all that they are chosen by, and the sums of their counts.

    No foreign keys: the last difference of a dataset that is purged comes after it is gone.
    """

    __tablename__ = "image_tallies"
    __table_args__ = (
        Index("ix_image_tallies_dataset_id", "dataset_id"),
        Index("ix_image_tallies_loose", "dataset_id", sqlite_where=LOOSE, postgresql_where=LOOSE),
    )

    id: Mapped[int] = mapped_column(primary_key=True)
    dataset_id: Mapped[int]
    camera_id: Mapped[int]
    source: Mapped[str | None] = mapped_column(String(300))
    sequence: Mapped[str | None] = mapped_column(String(300))
    assignee: Mapped[str | None] = mapped_column(String(200))
    review_status: Mapped[str] = mapped_column(String(20))
    prelabel: Mapped[str] = mapped_column(String(20))
    deleted: Mapped[bool]
    images: Mapped[int]
    prelabelled: Mapped[int]  # that a run has finished, or that came with labels
    labelled: Mapped[int]  # with a segment that is kept
    candidates: Mapped[int]
    keep: Mapped[int]
    reject: Mapped[int]
    ambiguous: Mapped[int]
    merged: Mapped[bool]


class RunTally(Base):
    """Images of a run in one state, and the sums of what the run changed on them (see ``RunImage.changes``)."""

    __tablename__ = "run_tallies"
    __table_args__ = (
        Index("ix_run_tallies_run_id", "run_id"),
        Index("ix_run_tallies_loose", "run_id", sqlite_where=LOOSE, postgresql_where=LOOSE),
    )

    id: Mapped[int] = mapped_column(primary_key=True)
    run_id: Mapped[int]
    status: Mapped[str] = mapped_column(String(20))
    images: Mapped[int]
    candidates: Mapped[int]
    carried: Mapped[int]
    kept_unmatched: Mapped[int]
    already_there: Mapped[int]
    retired: Mapped[int]
    discarded: Mapped[int]
    reopened: Mapped[int]
    merged: Mapped[bool]


class ImagePerson(Base):
    """That a person decided on candidates of an image; see ``app.services.people.WORK``."""

    __tablename__ = "image_people"
    __table_args__ = (Index("ix_image_people_person_image_id", "person", "image_id"),)

    image_id: Mapped[int] = mapped_column(ForeignKey("images.id", ondelete="CASCADE"), primary_key=True)
    person: Mapped[str] = mapped_column(String(200), primary_key=True)
