"""Splits: frozen copies of labels that submissions are scored against.

Nothing here depends on the rows it was made from: a dataset or image that is gone takes no truth along.
"""

from __future__ import annotations

from datetime import datetime
from typing import Any

from sqlalchemy import Float, ForeignKey, Index, LargeBinary, String, Text, UniqueConstraint
from sqlalchemy.orm import Mapped, mapped_column, relationship

from app.db.models.base import NEVER_REUSED, Base, Name, one_of

SPLIT_VISIBILITIES = ("open", "hidden")


class Split(Base):
    """A named part of a dataset that detectors are compared on; its truth lies in its versions."""

    __tablename__ = "splits"
    __table_args__ = (UniqueConstraint("slug"), one_of("visibility", SPLIT_VISIBILITIES), NEVER_REUSED)

    id: Mapped[int] = mapped_column(primary_key=True)
    dataset_id: Mapped[int | None] = mapped_column(ForeignKey("datasets.id", ondelete="SET NULL"), index=True)
    slug: Mapped[str] = mapped_column(String(120))
    name: Mapped[str] = mapped_column(String(200))
    description: Mapped[str | None] = mapped_column(Text)
    min_length: Mapped[float] = mapped_column(Float)  # px of arc length; shorter labels are ignored
    visibility: Mapped[str] = mapped_column(String(20))
    closes_at: Mapped[datetime | None]
    daily_limit: Mapped[int]  # submissions per person and day
    created_at: Mapped[datetime]
    created_by: Mapped[str | None] = mapped_column(String(200))
    deleted_at: Mapped[datetime | None]

    versions: Mapped[list[SplitVersion]] = relationship(back_populates="split", order_by="SplitVersion.number")


class SplitVersion(Base):
    """One frozen truth; never changed. The blob is an npz set with the verdicts ``keep`` and ``ambiguous``."""

    __tablename__ = "split_versions"
    __table_args__ = (UniqueConstraint("split_id", "number"), NEVER_REUSED)

    id: Mapped[int] = mapped_column(primary_key=True)
    split_id: Mapped[int] = mapped_column(ForeignKey("splits.id", ondelete="CASCADE"))
    number: Mapped[int]
    truth_sha256: Mapped[str] = mapped_column(ForeignKey("blobs.sha256"), index=True)
    truth_hash: Mapped[str] = mapped_column(String(64))  # of names, labels and minimum length; app.services.freezing
    n_images: Mapped[int]
    n_labels: Mapped[int]
    n_ambiguous: Mapped[int]
    created_at: Mapped[datetime]
    created_by: Mapped[str | None] = mapped_column(String(200))

    split: Mapped[Split] = relationship(back_populates="versions")


class SplitImage(Base):
    """One image of a frozen truth, in the truth's order, with what scoring needs of it."""

    __tablename__ = "split_images"
    __table_args__ = (
        UniqueConstraint("version_id", "name"),
        Index("ix_split_images_version_ordinal", "version_id", "ordinal"),
        NEVER_REUSED,
    )

    id: Mapped[int] = mapped_column(primary_key=True)
    version_id: Mapped[int] = mapped_column(ForeignKey("split_versions.id", ondelete="CASCADE"))
    ordinal: Mapped[int]
    image_id: Mapped[int | None] = mapped_column(ForeignKey("images.id", ondelete="SET NULL"), index=True)
    name: Mapped[str] = mapped_column(Name)
    image_sha256: Mapped[str] = mapped_column(ForeignKey("blobs.sha256"), index=True)
    width: Mapped[int]
    height: Mapped[int]
    source: Mapped[str | None] = mapped_column(String(300))
    sequence: Mapped[str | None] = mapped_column(String(300))
    camera: Mapped[str | None] = mapped_column(String(300))
    reference: Mapped[dict[str, Any] | None]  # the camera's, as it was then
    n_labels: Mapped[int]
    rejected: Mapped[bytes | None] = mapped_column(LargeBinary, deferred=True)  # candidates rejected with a reason, npz
