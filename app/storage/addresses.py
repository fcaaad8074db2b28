"""File systems of fsspec for the addresses that blobs may lie at."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import unquote, urlsplit

from app.errors import InvalidInput
from app.storage.refusals import reason_of, shown_address

if TYPE_CHECKING:
    from fsspec import AbstractFileSystem

EXTRAS = {"s3": "s3", "s3a": "s3"}
"""Our own extra that brings what a protocol needs."""

ALWAYS = {
    "skip_instance_cache": True,  # connections are ours to close
    "use_listings_cache": False,  # others write too
}

S3_TRIES = 3
"""Of a request whose answer broke off or didn't come, each with the tries of its connection."""

S3_CONNECTION = {
    "connect_timeout": 5,
    "read_timeout": 10,
    "retries": {"mode": "standard", "max_attempts": 2},
    "max_pool_connections": 50,
    "request_checksum_calculation": "when_required",
    "response_checksum_validation": "when_required",
}
"""Seconds and tries, so that a store that hangs holds a request up for about a minute at most.

Checksums beyond those of the signature are left out: many S3-compatible servers refuse them, and names are hashes.
"""


def local_folder(url: str) -> Path | None:
    """Return the folder that an address names, if it is one of this machine: ``/srv/blobs`` or ``file:///srv/blobs``.

    Raises:
        InvalidInput: When it names another machine, or no kind of address at all.
    """
    if "::" in url:
        return None
    if "://" not in url:
        return Path(url).expanduser().absolute()
    parts = urlsplit(url)
    if parts.scheme and parts.scheme not in ("file", "local"):
        return None
    if not parts.scheme or parts.netloc or not parts.path.startswith("/"):
        raise InvalidInput("this is no address of a folder", where=shown_address(url), expected="file:///FOLDER")
    return Path(unquote(parts.path))


def file_system(url: str, options: Mapping[str, Any], hidden: Collection[str] = ()) -> tuple[AbstractFileSystem, str]:
    """Return the file system of an address, and the path in it; nothing is asked of it yet.

    Args:
        url: The address.
        options: Of the file system.
        hidden: What no message may show.

    Raises:
        InvalidInput: When the address or the options mean nothing, or what they need isn't installed.
    """
    # it takes long to import, and who has a folder doesn't wait for it
    from fsspec.core import url_to_fs

    address, protocol = shown_address(url), urlsplit(url).scheme
    if protocol in EXTRAS:
        given = options.get("config_kwargs", {})
        options = {**options, "config_kwargs": {**S3_CONNECTION, **given}}
    try:
        files, root = url_to_fs(url, **{**options, **ALWAYS})
    except ImportError as error:
        hint = f"pip install 'clearlines[{EXTRAS[protocol]}]'" if protocol in EXTRAS else str(error)
        raise InvalidInput(f"what {protocol}:// needs isn't installed", where=address, hint=hint) from error
    except Exception as error:  # each file system has its own
        raise InvalidInput(
            f"this is no address that blobs can lie at ({reason_of(error, hidden)})",
            where=address,
            expected="s3://BUCKET/PREFIX, or another address of fsspec",
            hint="look at CLEARLINES_BLOB_URL and CLEARLINES_BLOB_OPTIONS",
        ) from None
    if protocol in EXTRAS:
        files.retries = S3_TRIES
    root = root.rstrip("/")
    if not root.strip("/"):
        raise InvalidInput("the address names no bucket or folder", where=address, expected="s3://BUCKET/PREFIX")
    return files, root


def close_connections(files: AbstractFileSystem) -> None:
    """Close a file system's connections to S3; others hold none, or close them when they are forgotten."""
    # s3fs has no public way to; left to itself it closes them too late, or not at all
    creator = getattr(files, "_s3creator", None)
    if creator is not None:
        from fsspec.asyn import FSTimeoutError, sync

        with suppress(FSTimeoutError):  # they go with the process then
            sync(files.loop, creator.__aexit__, None, None, None, timeout=5)  # type: ignore[attr-defined]
