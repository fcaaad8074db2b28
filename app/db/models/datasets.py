"""Datasets, their cameras and images, and the bytes that were uploaded."""

from __future__ import annotations

from datetime import datetime
from typing import TYPE_CHECKING, Any

from sqlalchemy import Float, ForeignKey, Index, String, Text, UniqueConstraint, text
from sqlalchemy.orm import Mapped, mapped_column, relationship

from app.db.models.base import NEVER_REUSED, Base, Name, alive_unique

if TYPE_CHECKING:
    from app.db.models.labelling import Review


ALIVE, DELETED = text("deleted_at IS NULL"), text("deleted_at IS NOT NULL")
FILTERS = ("review_status", "prelabel", "source", "sequence", "camera_id", "assignee")


def _alive_index(name: str, *then: str) -> Index:
    columns = ("dataset_id", name, *then, "id")
    return Index(f"ix_images_alive_{name}", *columns, sqlite_where=ALIVE, postgresql_where=ALIVE)


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
    description: Mapped[str | None] = mapped_column(Text)
    licence: Mapped[str | None] = mapped_column(Text)
    citation: Mapped[str | None] = mapped_column(Text)
    guidelines: Mapped[str | None] = mapped_column(Text)
    rules: Mapped[dict[str, Any] | None]  # {"second_share": share of images reviewed twice, "ask_recall": bool}
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
        # each filter of the lists in the order of names, and each order; those that decisions change aren't among them
        *(_alive_index(name, "name") for name in FILTERS),
        *(_alive_index(name) for name in ("created_at", "n_candidates", "lowest_score", "highest_score")),
        Index("ix_images_deleted", "dataset_id", "deleted_at", sqlite_where=DELETED, postgresql_where=DELETED),
        Index("ix_images_dataset_id_name_id", "dataset_id", "name", "id"),  # deleted ones too, which runs still show
        Index("ix_images_sha256_dataset_id", "sha256", "dataset_id"),
        NEVER_REUSED,
    )

    id: Mapped[int] = mapped_column(primary_key=True)
    dataset_id: Mapped[int] = mapped_column(ForeignKey("datasets.id", ondelete="CASCADE"))
    name: Mapped[str] = mapped_column(Name)  # the path under the root without extension: KITTI/000000
    file_name: Mapped[str] = mapped_column(String(500))
    sha256: Mapped[str] = mapped_column(ForeignKey("blobs.sha256"))
    width: Mapped[int]
    height: Mapped[int]
    bits: Mapped[int]
    camera_id: Mapped[int] = mapped_column(ForeignKey("cameras.id"), index=True)
    source: Mapped[str | None] = mapped_column(String(300))
    sequence: Mapped[str | None] = mapped_column(String(300))
    assignee: Mapped[str | None] = mapped_column(String(200))  # who is to review it
    revision: Mapped[int] = mapped_column(default=0)  # rises when the set of candidates changes
    # counts of the current segments, written by app.services.candidates.refresh_counts in the same transaction
    n_candidates: Mapped[int] = mapped_column(default=0)
    n_keep: Mapped[int] = mapped_column(default=0)
    n_reject: Mapped[int] = mapped_column(default=0)
    n_ambiguous: Mapped[int] = mapped_column(default=0)
    # of the scores of the current segments; written there too
    lowest_score: Mapped[float | None] = mapped_column(Float)
    highest_score: Mapped[float | None] = mapped_column(Float)
    # copies for lists, written by triggers alone: its review's status, and the state of the newest work on it
    review_status: Mapped[str] = mapped_column(String(20), server_default="open")
    prelabel: Mapped[str] = mapped_column(String(20), server_default="none")
    current_run_image_id: Mapped[int | None] = mapped_column(
        ForeignKey("run_images.id", use_alter=True, ondelete="SET NULL"), index=True
    )
    created_at: Mapped[datetime]
    deleted_at: Mapped[datetime | None]

    camera: Mapped[Camera] = relationship()
    review: Mapped[Review] = relationship(back_populates="image", cascade="all, delete-orphan")
