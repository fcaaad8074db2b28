"""Blobs on the local disk, each stored under the SHA-256 of its content.

A blob is written to a temporary file in the same file system, brought to the disk, then renamed: a name that exists is
a whole blob, whatever was killed on the way. Equal content is stored once.
"""

from __future__ import annotations

import hashlib
import os
import re
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import BinaryIO

from app.errors import InvalidInput, NotFound, TooLarge

CHUNK = 2**20


class BlobStore:
    """Blobs under a folder, fanned out as ``ab/cd/abcd...``.

    Safe to use from several threads and processes at once.

    Args:
        root: The folder; made if missing.
    """

    def __init__(self, root: Path) -> None:
        self.root = root
        self._incoming = root / "incoming"
        self._incoming.mkdir(parents=True, exist_ok=True)

    def put(self, content: bytes | BinaryIO | Iterable[bytes], *, limit: int | None = None) -> str:
        """Store content and return its SHA-256 in hexadecimal; content that is there already is left as it is.

        Args:
            content: Bytes, a stream of them, or pieces.
            limit: Bytes to accept.

        Raises:
            TooLarge: Over the limit; nothing is stored then.
        """
        digest = hashlib.sha256()
        size = 0
        handle, name = tempfile.mkstemp(dir=self._incoming)
        temporary = Path(name)
        try:
            with os.fdopen(handle, "wb") as target:
                for piece in _pieces(content):
                    size += len(piece)
                    if limit is not None and size > limit:
                        raise TooLarge("the content is too long", expected=f"at most {limit:,} bytes")
                    digest.update(piece)
                    target.write(piece)
                target.flush()
                os.fsync(target.fileno())
            sha256 = digest.hexdigest()
            path = self.path(sha256)
            if not path.exists():
                temporary.chmod(0o644)
                path.parent.mkdir(parents=True, exist_ok=True)
                temporary.replace(path)
                _sync_folder(path.parent)
            return sha256
        finally:
            temporary.unlink(missing_ok=True)

    def path(self, sha256: str) -> Path:
        """Return where a blob lies, or would lie.

        Raises:
            InvalidInput: If it isn't 64 hexadecimal digits in lower case.
        """
        if not re.fullmatch(r"[0-9a-f]{64}", sha256):
            raise InvalidInput("this is no SHA-256", where=sha256[:80], expected="64 hexadecimal digits in lower case")
        return self.root / sha256[:2] / sha256[2:4] / sha256

    def exists(self, sha256: str) -> bool:
        """Whether there is such a blob."""
        return self.path(sha256).is_file()

    def open(self, sha256: str) -> BinaryIO:
        """Open a blob for reading.

        Raises:
            NotFound: If there is none.
        """
        try:
            return self.path(sha256).open("rb")
        except FileNotFoundError as error:
            raise NotFound("there is no such blob", where=sha256) from error

    def read(self, sha256: str) -> bytes:
        """Return a blob's content; errors as `open`."""
        with self.open(sha256) as stream:
            return stream.read()

    def size(self, sha256: str) -> int:
        """Return a blob's length in bytes; errors as `open`."""
        try:
            return self.path(sha256).stat().st_size
        except FileNotFoundError as error:
            raise NotFound("there is no such blob", where=sha256) from error

    def delete(self, sha256: str) -> bool:
        """Remove a blob if it is there; return whether it was. A reader that has it open keeps it."""
        try:
            self.path(sha256).unlink()
        except FileNotFoundError:
            return False
        return True

    def discard_incoming(self, *, before: float) -> int:
        """Remove what writers that were killed left behind, and return how many files that were.

        Args:
            before: Time in seconds since the epoch; younger files may belong to writers still at work.
        """
        stale = [path for path in self._incoming.iterdir() if path.stat().st_mtime < before]
        for path in stale:
            path.unlink(missing_ok=True)
        return len(stale)


def _pieces(content: bytes | BinaryIO | Iterable[bytes]) -> Iterable[bytes]:
    if isinstance(content, bytes):
        return [content]
    read = getattr(content, "read", None)
    return content if read is None else iter(lambda: read(CHUNK), b"")


def _sync_folder(folder: Path) -> None:
    """Bring a folder's new entry to the disk; without it a power cut may lose the name of a file that is there."""
    if os.name != "posix":
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
