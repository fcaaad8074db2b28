"""What the file systems of fsspec tell of a file, each in its own words."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import UTC, datetime
from typing import Any

MODIFIED = ("LastModified", "mtime", "modified", "last_modified", "updated", "created")


def name_of(path: str) -> str:
    """Return the last part of a path."""
    return path.rstrip("/").rpartition("/")[2]


def modified_of(entry: Mapping[str, Any]) -> float | None:
    """Return when a file was written, seconds since the epoch, if its entry tells."""
    for key in MODIFIED:
        told = entry.get(key)
        if isinstance(told, str):
            try:
                told = datetime.fromisoformat(told)
            except ValueError:
                continue
        if isinstance(told, datetime):
            return (told if told.tzinfo else told.replace(tzinfo=UTC)).timestamp()
        if isinstance(told, int | float):
            return float(told)
    return None
