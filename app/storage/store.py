"""What every store of blobs can do, wherever it keeps them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO, Protocol

from app.storage.keys import Content


@dataclass(frozen=True)
class StoredBlob:
    """A blob as a listing shows it.

    Attributes:
        sha256: Of its content.
        size: Bytes.
        modified: When it was stored, seconds since the epoch; unknown where the store doesn't tell.
    """

    sha256: str
    size: int
    modified: float | None


@dataclass(frozen=True)
class Usage:
    """How full the disk is that holds the blobs; bytes, None where nobody can tell."""

    used: int | None = None
    free: int | None = None


class BlobStore(Protocol):
    """Bytes under the SHA-256 of their content: a name that exists is a whole blob, and equal content is stored once.

    Safe to use from several threads and processes at once. Every method raises `Unavailable` when the store can't be
    reached or refuses, and `InvalidInput` for what is no SHA-256.
    """

    @property
    def address(self) -> str:
        """Where the blobs lie, to be shown to people; holds no secret."""
        ...

    def put(self, content: Content, *, limit: int | None = None) -> str:
        """Store content and return its SHA-256 in hexadecimal; content that is there already is left as it is.

        Args:
            content: Bytes, a stream of them, or pieces.
            limit: Bytes to accept.

        Raises:
            TooLarge: Over the limit; nothing is stored then.
        """
        ...

    def exists(self, sha256: str) -> bool:
        """Whether there is such a blob."""
        ...

    def open(self, sha256: str) -> BinaryIO:
        """Open a blob for reading.

        Raises:
            NotFound: If there is none.
        """
        ...

    def read(self, sha256: str) -> bytes:
        """Return a blob's content; errors as `open`."""
        ...

    def size(self, sha256: str) -> int:
        """Return a blob's length in bytes; errors as `open`."""
        ...

    def local_path(self, sha256: str) -> Path | None:
        """Return the file on this machine that a blob is, or would be; None when blobs lie elsewhere."""
        ...

    def delete(self, sha256: str) -> bool:
        """Remove a blob if it is there; return whether it was."""
        ...

    def delete_all(self, names: Sequence[str]) -> int:
        """Remove blobs and return how many names are gone.

        A store that doesn't tell counts those that weren't there too.
        """
        ...

    def iterate(self) -> Iterator[StoredBlob]:
        """Yield all blobs in the order of their names, with bounded memory.

        Those that come or go meanwhile may be missed.
        """
        ...

    def discard_incoming(self, *, before: float) -> int:
        """Remove what writers that were killed left behind, and return how many files that were.

        Args:
            before: Time in seconds since the epoch; younger files may belong to writers still at work.
        """
        ...

    def check(self) -> None:
        """Write and read a few bytes.

        Raises:
            Unavailable: When that fails; says why, and what can be done.
        """
        ...

    def usage(self) -> Usage:
        """Return how full the disk is, where it is one of this machine."""
        ...

    def close(self) -> None:
        """Give back connections; the store may be used again, and opens them anew then."""
        ...
