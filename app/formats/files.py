"""Read a file that somebody gave; where it can't be read, say which and why."""

from __future__ import annotations

from pathlib import Path

from app.errors import InvalidFile, TooLarge


def read_file(path: Path, *, limit: int | None = None, where: str | None = None) -> bytes:
    """Return a file's bytes.

    Args:
        path: The file.
        limit: Bytes to accept; checked before any is read.
        where: Its name, for messages; the path when left out.

    Raises:
        InvalidFile: If it is gone, or may not be read.
        TooLarge: If it has more bytes than accepted.
    """
    where = where or str(path)
    try:
        size = path.stat().st_size
        if limit is not None and size > limit:
            raise TooLarge(f"the file has {size:,} bytes", where=where, expected=f"at most {limit:,}")
        return path.read_bytes()
    except OSError as error:
        raise InvalidFile(f"the file can't be read: {error.strerror or error}", where=where) from error
