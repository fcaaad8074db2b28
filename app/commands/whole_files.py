"""Files that appear whole or not at all."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any
from uuid import uuid4


def write_whole(path: Path, data: bytes) -> None:
    """Write a file under a temporary name beside its place, then move it there; folders are made.

    Whoever looks sees the old file or the new one, never a part; after a failure nothing is left behind. A link stays
    one: what it leads to is written. What is there and is no file, as ``/dev/stdout`` or a pipe, is written into.

    Raises:
        OSError: If the folder can't be made or written to.
    """
    if path.exists() and not path.is_file():
        path.write_bytes(data)
        return
    place = path.resolve()
    place.parent.mkdir(parents=True, exist_ok=True)
    temporary = place.with_name(f".{uuid4().hex}.tmp")
    try:
        temporary.write_bytes(data)
        temporary.replace(place)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def json_bytes(content: Any) -> bytes:
    """Return JSON for people and programs: UTF-8, indented, strict (no NaN)."""
    return (json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False) + "\n").encode()
