"""The store of blobs that the settings choose: a folder, or any address that fsspec knows."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Protocol
from urllib.parse import urlsplit

from app.storage.addresses import file_system, local_folder
from app.storage.caching import ReadCache
from app.storage.local import LocalBlobs
from app.storage.refusals import secrets_in, shown_address
from app.storage.remote import RemoteBlobs
from app.storage.store import BlobStore

CACHE_BYTES = 2**30


class BlobSettings(Protocol):
    """The settings that say where blobs lie."""

    @property
    def data_dir(self) -> Path:
        """Folder of this machine."""
        ...

    @property
    def blob_dir(self) -> Path:
        """Where blobs lie if no address is given."""
        ...

    @property
    def blob_url(self) -> str | None:
        """The address."""
        ...

    @property
    def blob_options(self) -> Mapping[str, Any]:
        """Options of its file system."""
        ...


def open_blobs(settings: BlobSettings) -> BlobStore:
    """Return the store of an installation; a remote one isn't asked for anything yet, which `BlobStore.check` does.

    Raises:
        InvalidInput: When ``blob_url`` or ``blob_options`` can't be used, or what they need isn't installed.
    """
    if settings.blob_url is None:
        return LocalBlobs(settings.blob_dir)
    return open_blobs_at(settings.blob_url, settings.blob_options, folder=settings.data_dir, cache_bytes=CACHE_BYTES)


def open_blobs_at(
    url: str, options: Mapping[str, Any] | None = None, *, folder: Path, cache_bytes: int = 0
) -> BlobStore:
    """Return the store at an address.

    Args:
        url: A folder, or an address of fsspec.
        options: Of the address's file system.
        folder: Of this machine, for what is on its way to a remote store and for copies of what was read.
        cache_bytes: How much of these may be kept; none if 0.

    Raises:
        InvalidInput: As `open_blobs`.
    """
    if (root := local_folder(url)) is not None:
        return LocalBlobs(root)
    given = options or {}
    hidden = secrets_in({**given, "password of the address": urlsplit(url).password})
    files, path = file_system(url, given, hidden)
    return RemoteBlobs(
        files,
        path,
        address=shown_address(url),
        spool=folder / "outgoing",
        hidden=hidden,
        cache=ReadCache(folder / "cache" / "blobs", cache_bytes) if cache_bytes else None,
    )
