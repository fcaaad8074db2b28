"""Blobs on the local disk.

A blob is written to a temporary file in the same file system, brought to the disk, then renamed: a name that exists is
a whole blob, whatever was killed on the way.
"""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import BinaryIO

from app.errors import NotFound, Unavailable
from app.storage.keys import Content, is_fan, is_name, key_of
from app.storage.receiving import received
from app.storage.store import StoredBlob, Usage


class LocalBlobs:
    """Blobs under a folder, fanned out as ``ab/cd/abcd...``; a `BlobStore`.

    Args:
        root: The folder; made if missing.
    """

    def __init__(self, root: Path) -> None:
        self.root = root
        self._incoming = root / "incoming"
        self._incoming.mkdir(parents=True, exist_ok=True)

    @property
    def address(self) -> str:
        """The folder."""
        return str(self.root)

    def put(self, content: Content, *, limit: int | None = None) -> str:
        """Store content, as `BlobStore.put` says."""
        with received(content, self._incoming, limit=limit, durable=True) as came:
            path = self.local_path(came.sha256)
            if not path.exists():
                came.path.chmod(0o644)
                path.parent.mkdir(parents=True, exist_ok=True)
                came.path.replace(path)
                _sync_folder(path.parent)
            return came.sha256

    def local_path(self, sha256: str) -> Path:
        """Return where a blob lies, or would lie."""
        return self.root / key_of(sha256)

    def exists(self, sha256: str) -> bool:
        """Whether there is such a blob."""
        return self.local_path(sha256).is_file()

    def open(self, sha256: str) -> BinaryIO:
        """Open a blob for reading, as `BlobStore.open` says."""
        try:
            return self.local_path(sha256).open("rb")
        except FileNotFoundError as error:
            raise NotFound("there is no such blob", where=sha256) from error

    def read(self, sha256: str) -> bytes:
        """Return a blob's content."""
        with self.open(sha256) as stream:
            return stream.read()

    def size(self, sha256: str) -> int:
        """Return a blob's length in bytes."""
        try:
            return self.local_path(sha256).stat().st_size
        except FileNotFoundError as error:
            raise NotFound("there is no such blob", where=sha256) from error

    def delete(self, sha256: str) -> bool:
        """Remove a blob if it is there; return whether it was. A reader that has it open keeps it."""
        try:
            self.local_path(sha256).unlink()
        except FileNotFoundError:
            return False
        return True

    def delete_all(self, names: Sequence[str]) -> int:
        """Remove blobs and return how many were there."""
        return sum(self.delete(sha256) for sha256 in names)

    def iterate(self) -> Iterator[StoredBlob]:
        """Yield all blobs in the order of their names."""
        for fan in _folders(self.root):
            for second in _folders(fan):
                for path in sorted(second.iterdir()):
                    try:
                        status = path.stat()
                    except FileNotFoundError:
                        continue
                    if is_name(path.name) and path == self.local_path(path.name):
                        yield StoredBlob(path.name, status.st_size, status.st_mtime)

    def discard_incoming(self, *, before: float) -> int:
        """Remove what writers that were killed left behind, and return how many files that were."""
        stale = [path for path in self._incoming.iterdir() if path.stat().st_mtime < before]
        for path in stale:
            path.unlink(missing_ok=True)
        return len(stale)

    def check(self) -> None:
        """Write and read a few bytes, as `BlobStore.check` says."""
        try:
            with tempfile.TemporaryFile(dir=self._incoming) as file:
                file.write(b"check")
                file.seek(0)
                file.read()
        except OSError as error:
            raise Unavailable(
                "the folder of the uploaded files can't be written to",
                where=self.address,
                hint=f"look at its owner and at the room on its disk: {error.strerror}",
            ) from error

    def usage(self) -> Usage:
        """Return how full the disk is."""
        disk = shutil.disk_usage(self.root)
        return Usage(disk.used, disk.free)

    def close(self) -> None:
        """Nothing is held open."""


def _folders(parent: Path) -> list[Path]:
    return sorted(path for path in parent.iterdir() if is_fan(path.name) and path.is_dir())


def _sync_folder(folder: Path) -> None:
    """Bring a folder's new entry to the disk; without it a power cut may lose the name of a file that is there."""
    if os.name != "posix":
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
