"""Take away a blob that nothing names any more at once, instead of waiting for the purge."""

from __future__ import annotations

from sqlalchemy import delete, exists, select
from sqlalchemy.orm import Session

from app.db.models import Blob, Image, SplitImage, SplitVersion, Submission
from app.services.blob_keeping import blobs_may_go
from app.storage import BlobStore

NAMED_BY = (
    Image.sha256,
    SplitImage.image_sha256,
    SplitVersion.truth_sha256,
    Submission.upload_sha256,
    Submission.segments_sha256,
)
"""Columns that name a blob."""


def discard_blob(session: Session, blobs: BlobStore, sha256: str | None) -> bool:
    """Remove a blob, row and file, that no row names; return whether it is gone. While a backup copies blobs it stays.

    Args:
        session: A writing session in which the row that named it was removed, or changed.
        blobs: The store.
        sha256: The blob; nothing happens without one.
    """
    if sha256 is None:
        return False
    session.flush()
    if not blobs_may_go(session):
        return False
    # whoever stores the same content now waits here, and then finds the file gone and is told to send it again
    session.execute(select(Blob.sha256).where(Blob.sha256 == sha256).with_for_update())
    if any(session.scalar(select(exists().where(column == sha256))) for column in NAMED_BY):
        return False
    session.execute(delete(Blob).where(Blob.sha256 == sha256))
    return blobs.delete(sha256)
