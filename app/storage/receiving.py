"""Content on its way in: written to a temporary file while it is hashed and measured."""

from __future__ import annotations

import hashlib
import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from app.errors import TooLarge
from app.storage.keys import Content, pieces_of


@dataclass(frozen=True)
class Received:
    """Content that was received whole.

    Attributes:
        path: The temporary file.
        sha256: Of the content.
        size: Bytes.
    """

    path: Path
    sha256: str
    size: int


@contextmanager
def received(content: Content, folder: Path, *, limit: int | None, durable: bool) -> Iterator[Received]:
    """Give content as a file in a folder; what is still there in the end is removed.

    Args:
        content: Bytes, a stream of them, or pieces.
        folder: Where to write it.
        limit: Bytes to accept.
        durable: Whether it is to be on the disk, and not just on its way there.

    Raises:
        TooLarge: Over the limit.
    """
    digest = hashlib.sha256()
    size = 0
    handle, name = tempfile.mkstemp(dir=folder)
    temporary = Path(name)
    try:
        with os.fdopen(handle, "wb") as target:
            for piece in pieces_of(content):
                size += len(piece)
                require_within(size, limit)
                digest.update(piece)
                target.write(piece)
            target.flush()
            if durable:
                os.fsync(target.fileno())
        yield Received(temporary, digest.hexdigest(), size)
    finally:
        temporary.unlink(missing_ok=True)


def require_within(size: int, limit: int | None) -> None:
    """Raise `TooLarge` for more bytes than are accepted."""
    if limit is not None and size > limit:
        raise TooLarge("the content is too long", expected=f"at most {limit:,} bytes")
