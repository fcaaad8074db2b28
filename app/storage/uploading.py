"""How what is uploaded to a file system appears whole under its name, or not at all."""

from __future__ import annotations

import secrets
from collections.abc import Callable
from contextlib import suppress
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fsspec import AbstractFileSystem

OBJECT_STORES = frozenset({"s3", "s3a", "gs", "gcs", "az", "abfs", "abfss", "oss", "oci"})
"""Protocols of stores without folders, where an upload that breaks off leaves nothing that can be seen."""


def has_folders(files: AbstractFileSystem) -> bool:
    """Whether it keeps files in folders, where a file can be seen while it grows."""
    protocols = (files.protocol,) if isinstance(files.protocol, str) else files.protocol
    return OBJECT_STORES.isdisjoint(protocols)


def upload(files: AbstractFileSystem, path: str, send: Callable[[str], None], *, incoming: str) -> None:
    """Send content to a path.

    Args:
        files: The file system.
        path: Where to.
        send: Sends it to the path that it is given.
        incoming: Folder of the same file system where it grows, where there are folders.
    """
    if not has_folders(files):
        send(path)
        return
    temporary = f"{incoming}/{secrets.token_hex(16)}"
    for place in (temporary, path):
        files.makedirs(place.rpartition("/")[0], exist_ok=True)
    try:
        send(temporary)
        files.mv(temporary, path)
    except BaseException:
        with suppress(Exception):
            files.rm_file(temporary)
        raise
