"""Blobs, each stored under the SHA-256 of its content: in a local folder, or at any address that fsspec knows."""

from app.storage.local import LocalBlobs
from app.storage.opening import open_blobs, open_blobs_at
from app.storage.remote import RemoteBlobs
from app.storage.store import BlobStore, StoredBlob, Usage

__all__ = ["BlobStore", "LocalBlobs", "RemoteBlobs", "StoredBlob", "Usage", "open_blobs", "open_blobs_at"]
