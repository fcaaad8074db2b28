"""Read an uploaded zip safely, one member at a time.

A zip with anything hostile in it is refused whole, with every reason at once. What is merely useless is left out and
named: folders, the files that macOS and Windows add, archives inside the archive.
"""

from __future__ import annotations

import re
import stat
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import BinaryIO

from app.errors import InvalidFile, TooLarge
from app.formats.limits import ARCHIVE_LIMITS, ArchiveLimits
from app.formats.naming import composed, has_control_characters
from app.formats.zips import ENCRYPTED, METHODS, open_zip, read_member

UTF8_NAME = 0x800
SMALL = 2**20
SYSTEM_FILES = frozenset({".ds_store", "thumbs.db", "desktop.ini"})
NESTED = frozenset({".zip", ".tar", ".gz", ".tgz", ".bz2", ".xz", ".zst", ".7z", ".rar"})


@dataclass(frozen=True)
class ArchiveMember:
    """A file in an archive: its path under the root, with forward slashes, and its unpacked size in bytes."""

    path: str
    size: int


class Archive:
    """An archive that has passed every check; use it inside `open_archive`.

    Attributes:
        members: The files that can be read, in the archive's order.
        ignored: Path and reason of each entry left out.
    """

    def __init__(
        self,
        archive: zipfile.ZipFile,
        infos: dict[str, zipfile.ZipInfo],
        ignored: tuple[tuple[str, str], ...],
        where: str,
    ) -> None:
        self._archive = archive
        self._infos = infos
        self._where = where
        self.members = tuple(ArchiveMember(path, info.file_size) for path, info in infos.items())
        self.ignored = ignored

    def read(self, member: ArchiveMember) -> bytes:
        """Unpack one file.

        Raises:
            InvalidFile: If its bytes are broken.
        """
        info = self._infos[member.path]
        return read_member(self._archive, info, where=f"{self._where}: {member.path}", limit=info.file_size)


@contextmanager
def open_archive(
    source: bytes | BinaryIO, *, where: str = "archive", limits: ArchiveLimits = ARCHIVE_LIMITS
) -> Iterator[Archive]:
    """Open a zip and check every entry before the first is unpacked.

    Args:
        source: The zip's bytes, or a seekable stream of them.
        where: Its name, for messages.
        limits: How much it may hold.

    Raises:
        InvalidFile: On paths that leave the root, links, encryption, names that aren't UTF-8, names that are equal but
            for case; all of them are named. Also if it is no zip, broken, or holds no file.
        TooLarge: Over a limit.
    """
    with open_zip(source, where=where, members=limits.members, name_bytes=limits.name_bytes) as archive:
        yield _checked(archive, where, limits)


def _checked(archive: zipfile.ZipFile, where: str, limits: ArchiveLimits) -> Archive:
    infos: dict[str, zipfile.ZipInfo] = {}
    ignored: list[tuple[str, str]] = []
    problems: list[str] = []
    taken: dict[str, str] = {}
    total = 0
    for info in archive.infolist():
        path = _path(info)
        reason = _reason_to_refuse(info, path, limits)
        if path is None or reason:
            problems.append(f"{path or info.orig_filename!r:.200}: {reason or 'its name is not UTF-8'}")
            continue
        why = _reason_to_ignore(path)
        if why:
            ignored.append((path, why))
            continue
        key = path.casefold()
        if key in taken:
            problems.append(f"{path}: the same name as {taken[key]}, but for case at most")
            continue
        taken[key] = path
        infos[path] = info
        total += info.file_size
        _check_size(info, f"{where}: {path}", limits)
    if problems:
        shown = "; ".join(problems[:20]) + (f"; and {len(problems) - 20} more" if len(problems) > 20 else "")
        raise InvalidFile(f"the zip can't be used: {shown}", where=where, details={"problems": problems[:1000]})
    if total > limits.total_bytes:
        raise TooLarge(f"it unpacks to {total:,} bytes", where=where, expected=f"at most {limits.total_bytes:,}")
    if not infos:
        raise InvalidFile("the zip holds no file that could be read", where=where, details={"ignored": ignored[:1000]})
    return Archive(archive, infos, tuple(ignored), where)


def _path(info: zipfile.ZipInfo) -> str | None:
    """Return the path, or ``None`` if it isn't UTF-8: without the flag zipfile has read it as code page 437."""
    name = info.orig_filename
    if not name.isascii() and not info.flag_bits & UTF8_NAME:
        try:
            name = name.encode("cp437").decode("utf-8")
        except UnicodeError:
            return None
    return composed(name)


def _reason_to_refuse(info: zipfile.ZipInfo, path: str | None, limits: ArchiveLimits) -> str:
    if path is None:
        return ""
    mode = info.external_attr >> 16
    kind = stat.S_IFMT(mode)
    checks = {
        "it has a backslash in its name": "\\" in path,
        "it has control characters in its name": has_control_characters(path),
        "its path is absolute": path.startswith("/") or bool(re.match(r"[A-Za-z]:", path)),
        "its path leaves the archive's root": any(part in ("..", ".") for part in path.split("/")),
        "its path has an empty part": "//" in path or not path,
        "its name is too long": len(path.encode()) > limits.name_bytes
        or any(len(part.encode()) > 255 for part in path.split("/")),
        "it is a link": kind == stat.S_IFLNK,
        "it is no ordinary file": kind not in (0, stat.S_IFREG, stat.S_IFDIR, stat.S_IFLNK),
        "it is encrypted": bool(info.flag_bits & ENCRYPTED),
        f"it is packed by method {info.compress_type}": info.compress_type not in METHODS,
    }
    return next((reason for reason, holds in checks.items() if holds), "")


def _reason_to_ignore(path: str) -> str:
    name = PurePosixPath(path)
    if path.endswith("/"):
        return "a folder"
    if "__MACOSX" in name.parts or name.name.lower() in SYSTEM_FILES or name.name.startswith("._"):
        return "written by the operating system"
    if name.suffix.lower() in NESTED:
        return "an archive inside the archive"
    return ""


def _check_size(info: zipfile.ZipInfo, where: str, limits: ArchiveLimits) -> None:
    if info.file_size > limits.member_bytes:
        raise TooLarge(
            f"it unpacks to {info.file_size:,} bytes", where=where, expected=f"at most {limits.member_bytes:,}"
        )
    if info.file_size > SMALL and info.file_size > limits.ratio * max(info.compress_size, 1):
        raise TooLarge(
            f"it unpacks to {info.file_size / max(info.compress_size, 1):.0f} times its size",
            where=where,
            expected=f"at most {limits.ratio:g} times",
        )
