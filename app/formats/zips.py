"""Open a zip and read its members, bounded: what a hostile file could make Python's `zipfile` do, it can't do here."""

from __future__ import annotations

import io
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from typing import BinaryIO

from app.errors import InvalidFile, TooLarge

METHODS = frozenset({zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED})
ENTRY_BYTES = 46
ENCRYPTED = 0x1
BROKEN = (zipfile.BadZipFile, zlib.error, EOFError, OSError, ValueError, NotImplementedError, RuntimeError, KeyError)
"""What `zipfile` raises for a broken or unusual file."""


class _DirectoryGuard(io.RawIOBase):
    """A file that refuses one huge read: `zipfile` takes the whole directory at once, before it counts members."""

    def __init__(self, stream: BinaryIO, where: str) -> None:
        self.stream = stream
        self.where = where
        self.limit: int | None = None

    def read(self, size: int = -1, /) -> bytes:
        if self.limit is not None and size > self.limit:
            raise TooLarge(
                "the zip's directory is too long", where=self.where, expected=f"at most {self.limit:,} bytes"
            )
        return self.stream.read(size)

    def seek(self, offset: int, whence: int = io.SEEK_SET, /) -> int:
        return self.stream.seek(offset, whence)

    def tell(self) -> int:
        return self.stream.tell()

    def seekable(self) -> bool:
        return True

    def readable(self) -> bool:
        return True


@contextmanager
def open_zip(
    source: bytes | BinaryIO, *, where: str, members: int, name_bytes: int = 1_000
) -> Iterator[zipfile.ZipFile]:
    """Open a zip whose directory is within bounds.

    Args:
        source: The file's bytes, or a seekable stream of them; a stream is left open.
        where: Its name, for messages.
        members: How many members it may have.
        name_bytes: How long their names may be on average, extra fields included.

    Raises:
        InvalidFile: If it is no zip, or broken.
        TooLarge: If it has more members, or a longer directory than they need.
    """
    guard = _DirectoryGuard(io.BytesIO(source) if isinstance(source, bytes) else source, where)
    guard.limit = max(members * (ENTRY_BYTES + name_bytes), 2**16 + 22)
    try:
        archive = zipfile.ZipFile(guard)
    except BROKEN as error:
        raise InvalidFile("this is no zip, or it is broken", where=where, hint="was the upload cut off?") from error
    with archive:
        guard.limit = None
        if len(archive.infolist()) > members:
            raise TooLarge(
                f"the zip has {len(archive.infolist()):,} members", where=where, expected=f"at most {members:,}"
            )
        yield archive


def read_member(archive: zipfile.ZipFile, info: zipfile.ZipInfo, *, where: str, limit: int) -> bytes:
    """Unpack one member of at most ``limit`` bytes; never more than its directory entry says is unpacked.

    Raises:
        InvalidFile: If it is encrypted, packed in another way than deflate, broken, or not as long as promised.
        TooLarge: If it is promised to be longer.
    """
    if info.flag_bits & ENCRYPTED:
        raise InvalidFile("the member is encrypted", where=where, hint="pack it without a password")
    if info.compress_type not in METHODS:
        raise InvalidFile(
            f"the member is packed by method {info.compress_type}", where=where, expected="stored or deflated"
        )
    if info.file_size > limit:
        raise TooLarge(f"the member unpacks to {info.file_size:,} bytes", where=where, expected=f"at most {limit:,}")
    try:
        with archive.open(info) as member:
            data = member.read(info.file_size + 1)
    except BROKEN as error:
        raise InvalidFile("the member is broken", where=where, hint="was the upload cut off?") from error
    if len(data) != info.file_size:
        raise InvalidFile(f"the member has {len(data):,} bytes, its entry says {info.file_size:,}", where=where)
    return data
