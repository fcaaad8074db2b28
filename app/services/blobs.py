"""Bytes that rows refer to: into the store first, then their row, which protects them from the purge."""

from __future__ import annotations

from datetime import datetime

from sqlalchemy.dialects import postgresql, sqlite
from sqlalchemy.orm import Session

from app.db.models import Blob
from app.errors import Unavailable
from app.storage import BlobStore


def keep_bytes(session: Session, blobs: BlobStore, data: bytes, media_type: str, now: datetime) -> str:
    """Store bytes with their row and return their sha256; content that is there already is stored once.

    Raises:
        Unavailable: When a purge took the same content away at this very moment.
    """
    sha256 = blobs.put(data)
    add_blob_row(session, sha256, len(data), media_type, now)
    if not blobs.exists(sha256):
        raise Unavailable("the content was purged while it was stored", hint="try again")
    return sha256


def add_blob_row(session: Session, sha256: str, size: int, media_type: str, now: datetime) -> None:
    """Add the row of bytes that were stored; one that is there already stays as it is."""
    insert = postgresql.insert if session.get_bind().dialect.name == "postgresql" else sqlite.insert
    values = {"sha256": sha256, "size": size, "media_type": media_type, "created_at": now}
    session.execute(insert(Blob).values(values).on_conflict_do_nothing())
