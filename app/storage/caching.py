"""Blobs of a remote store that were read of late, kept on the local disk."""

from __future__ import annotations

import hashlib
import os
import tempfile
import threading
from pathlib import Path

from app.storage.keys import key_of


class ReadCache:
    """A folder of copies whose sizes add up to little more than a bound; what wasn't read longest goes first.

    Safe for several threads and processes. A copy is checked against its hash each time that it is read, so one that a
    crash cut short is as good as none; and whatever goes wrong with the folder, reading goes on without it.

    Args:
        folder: The folder; made if missing.
        most_bytes: The bound.
    """

    def __init__(self, folder: Path, most_bytes: int) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        self._folder = folder
        self._most = most_bytes
        self._lock = threading.Lock()
        self._added = most_bytes  # what an earlier process left may be too much: the first to be added looks

    def get(self, sha256: str) -> bytes | None:
        """Return a blob's content, if there is a good copy."""
        path = self._path(sha256)
        try:
            content = path.read_bytes()
            if hashlib.sha256(content).hexdigest() != sha256:
                path.unlink(missing_ok=True)
                return None
            os.utime(path)  # read now
        except OSError:
            return None
        return content

    def add(self, sha256: str, content: bytes) -> None:
        """Keep a copy; of what takes up much of the room none is kept."""
        if len(content) > self._most // 8:
            return
        try:
            handle, name = tempfile.mkstemp(dir=self._folder)
            temporary = Path(name)
            try:
                with os.fdopen(handle, "wb") as target:
                    target.write(content)
                temporary.replace(self._path(sha256))
            finally:
                temporary.unlink(missing_ok=True)
            with self._lock:
                self._added += len(content)
                full = self._added > self._most // 16
                self._added = 0 if full else self._added
            if full:
                self._trim()
        except OSError:  # a full disk, say
            return

    def forget(self, sha256: str) -> None:
        """Remove the copy of a blob that was deleted."""
        self._path(sha256).unlink(missing_ok=True)

    def _path(self, sha256: str) -> Path:
        return self._folder / Path(key_of(sha256)).name

    def _trim(self) -> None:
        found: list[tuple[float, int, Path]] = []
        for entry in os.scandir(self._folder):
            try:
                status = entry.stat()
            except FileNotFoundError:  # another process trims too
                continue
            found.append((status.st_mtime, status.st_size, Path(entry.path)))
        total = sum(size for _, size, _ in found)
        for _, size, path in sorted(found):
            if total <= self._most:
                return
            path.unlink(missing_ok=True)
            total -= size
