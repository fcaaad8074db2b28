"""Read a tar.gz safely, in one pass: what a hostile file could make `tarfile` or gzip do, it can't do here."""

from __future__ import annotations

import gzip
import io
import re
import tarfile
import zlib
from collections.abc import Iterator
from typing import BinaryIO

from app.errors import ClearLinesError, InvalidFile, TooLarge
from app.formats.archives import NESTED, SYSTEM_FILES
from app.formats.limits import ARCHIVE_LIMITS, ArchiveLimits
from app.formats.naming import composed, has_control_characters

GZIP_MAGIC = b"\x1f\x8b"
BLOCK = 512
HEADER_BYTES = 2**13
"""Longest header with a long name in it; an extended header may promise any size."""
SMALL = 2**20
BROKEN = (tarfile.TarError, EOFError, OSError, zlib.error, ValueError, OverflowError, UnicodeError, RecursionError)
"""What `tarfile` and gzip raise for a broken or unusual file."""

Entry = tuple[str, bytes | ClearLinesError | str]
"""Path with the file's bytes, why it is refused, or why it is left out."""


class _Bounded(io.RawIOBase):
    """Unpacked bytes with two bounds: on their number, and on one read while a header is expected."""

    def __init__(self, packed: BinaryIO, size: int, where: str, limits: ArchiveLimits) -> None:
        self._stream = gzip.GzipFile(fileobj=packed)
        self._where = where
        self._most = int(min(limits.total_bytes + limits.members * 4 * BLOCK, SMALL + limits.ratio * size))
        self.read_limit = HEADER_BYTES
        self.last = b""

    def read(self, size: int = -1, /) -> bytes:
        if not 0 <= size <= self.read_limit:
            raise TooLarge(
                "a header in the tar is too long", where=self._where, expected=f"at most {self.read_limit:,}"
            )
        self.last = self._stream.read(size)
        self._check()
        return self.last

    def seek(self, offset: int, whence: int = io.SEEK_SET, /) -> int:
        if whence != io.SEEK_SET or not self.tell() <= offset:
            raise tarfile.ReadError("the tar leads backwards")
        while self.tell() < offset:
            if not self._stream.read(min(offset - self.tell(), SMALL)):
                raise EOFError
            self._check()
        return offset

    def tell(self) -> int:
        return self._stream.tell()

    def readable(self) -> bool:
        return True

    def seekable(self) -> bool:
        return True

    def drain(self) -> None:
        """Read on to the end, where gzip compares its checksum."""
        while self._stream.read(SMALL):
            self._check()

    def _check(self) -> None:
        if self.tell() > self._most:
            raise TooLarge("the tar unpacks to too much", where=self._where, expected=f"at most {self._most:,} bytes")


def read_tar(
    stream: BinaryIO, *, size: int, where: str = "archive", limits: ArchiveLimits = ARCHIVE_LIMITS
) -> Iterator[Entry]:
    """Unpack a tar.gz file by file, each held in memory alone.

    Args:
        stream: The packed bytes, from the first.
        size: Their number.
        where: Name of the archive, for messages.
        limits: How much it may hold.

    Yields:
        Path and content; or an error, for an entry that makes the archive hostile (a link or other special file, a
        path that leaves the root, a name that isn't UTF-8 or comes twice); or words, for one that is left out.

    Raises:
        InvalidFile: If it is no tar.gz, broken or cut off.
        TooLarge: Over a limit.
    """
    bounded = _Bounded(stream, size, where, limits)
    taken: dict[str, str] = {}
    total = 0
    try:
        # always read as a plain tar: what it is packed with was decided above
        with tarfile.open(fileobj=bounded, mode="r:", encoding="utf-8", errors="surrogateescape") as archive:
            number = 0
            while (info := archive.next()) is not None:
                number += 1
                if number > limits.members:
                    raise TooLarge("the tar has too many members", where=where, expected=f"at most {limits.members:,}")
                entry = _entry(archive, info, bounded, taken, where, limits)
                total += len(entry[1]) if isinstance(entry[1], bytes) else 0
                if total > limits.total_bytes:
                    raise TooLarge("the tar unpacks to too much", where=where, expected=f"{limits.total_bytes:,} bytes")
                yield entry
            if bounded.last.strip(b"\0") or len(bounded.last) != BLOCK:
                raise tarfile.ReadError("no end mark")
        bounded.drain()
    except BROKEN as error:
        raise InvalidFile(
            "this is no tar.gz, or it is broken", where=where, hint="was the upload cut off? was it packed with gzip?"
        ) from error


def _entry(
    archive: tarfile.TarFile,
    info: tarfile.TarInfo,
    bounded: _Bounded,
    taken: dict[str, str],
    where: str,
    limits: ArchiveLimits,
) -> Entry:
    path = composed(info.name)
    shown = path.encode("utf-8", "backslashreplace").decode()
    while path.startswith("./"):  # as `tar -C folder .` writes them
        path = path[2:]
    reason = _reason_to_refuse(info, path, limits)
    if reason:
        return shown, InvalidFile(reason, where=f"{where}: {shown}")
    why = _reason_to_ignore(info, path)
    if why:
        return shown, why
    if path.casefold() in taken:
        return shown, InvalidFile(f"the same name as {taken[path.casefold()]}, but for case at most", where=where)
    taken[path.casefold()] = path
    if info.size > limits.member_bytes:
        raise TooLarge(
            f"it unpacks to {info.size:,} bytes", where=f"{where}: {path}", expected=f"at most {limits.member_bytes:,}"
        )
    bounded.read_limit = max(limits.member_bytes, HEADER_BYTES)
    member = archive.extractfile(info)
    content = b"" if member is None else member.read()
    bounded.read_limit = HEADER_BYTES
    if len(content) != info.size:
        raise EOFError
    return path, content


def _reason_to_refuse(info: tarfile.TarInfo, path: str, limits: ArchiveLimits) -> str:
    parts = path.rstrip("/").split("/")
    checks = {
        "it is a link": info.issym() or info.islnk(),
        "it is no ordinary file": not (info.isreg() or info.isdir() or info.issym() or info.islnk()) or info.issparse(),
        "its name is not UTF-8": any("\udc80" <= character <= "\udcff" for character in path),
        "it has control characters in its name": has_control_characters(path),
        "it has a backslash in its name": "\\" in path,
        "its path is absolute": path.startswith("/") or bool(re.match(r"[A-Za-z]:", path)),
        "its path leaves the archive's root": ".." in parts or (parts != ["."] and "." in parts),
        "its path has an empty part": "//" in path,
        "its name is too long": len(path) > limits.name_bytes,
    }
    return next((reason for reason, holds in checks.items() if holds), "")


def _reason_to_ignore(info: tarfile.TarInfo, path: str) -> str:
    name = path.rpartition("/")[2]
    if info.isdir():
        return "a folder"
    if "__MACOSX" in path.split("/") or name.lower() in SYSTEM_FILES or name.startswith("._"):
        return "written by the operating system"
    if any(name.lower().endswith(suffix) for suffix in NESTED):
        return "an archive inside the archive"
    return ""
