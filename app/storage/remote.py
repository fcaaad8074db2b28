"""Blobs at any address that fsspec knows, such as the buckets of an S3-compatible server."""

from __future__ import annotations

import hashlib
import io
from collections.abc import Callable, Collection, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO, cast

from app.errors import ClearLinesError, NotFound, Unavailable
from app.storage.addresses import close_connections
from app.storage.caching import ReadCache
from app.storage.keys import Content, is_fan, is_name, key_of
from app.storage.listing import modified_of, name_of
from app.storage.receiving import received, require_within
from app.storage.refusals import missing_root, told
from app.storage.store import StoredBlob, Usage
from app.storage.streaming import BLOCK, remote_stream
from app.storage.uploading import has_folders, upload

if TYPE_CHECKING:
    from fsspec import AbstractFileSystem

AT_ONCE = 16  # requests
CHECK = b"ClearLines can write and read here.\n"
CHECK_SECONDS = 5.0


class RemoteBlobs:
    """Blobs below a path of a file system, fanned out as ``ab/cd/abcd...``; a `BlobStore`.

    Args:
        files: The file system; its connections are closed with the store.
        root: The path, which begins with the bucket where there are buckets.
        address: The same for people.
        spool: Folder of this machine where streams wait until their hash is known; made if missing.
        hidden: What no message may show.
        cache: Where to keep what was read.
    """

    def __init__(
        self,
        files: AbstractFileSystem,
        root: str,
        *,
        address: str,
        spool: Path,
        hidden: Collection[str] = (),
        cache: ReadCache | None = None,
    ) -> None:
        self._files = files
        self._root = root
        self._incoming = f"{root}/incoming"
        self._address = address
        self._spool = spool
        self._cache = cache
        self._told = partial(told, address, hidden)
        self._has_folders = has_folders(files)
        # only a network's file system has no time-out of its own to be given here
        self._in_time: dict[str, Any] = {"timeout": CHECK_SECONDS} if files.async_impl else {}
        spool.mkdir(parents=True, exist_ok=True)

    @property
    def address(self) -> str:
        """The address without user, password and query."""
        return self._address

    def put(self, content: Content, *, limit: int | None = None) -> str:
        """Store content, as `BlobStore.put` says; uploaded only when it isn't there yet."""
        if isinstance(content, bytes):  # no need of the disk
            require_within(len(content), limit)
            sha256 = hashlib.sha256(content).hexdigest()
            self._upload(sha256, len(content), lambda path: self._files.pipe_file(path, content))
            return sha256
        with received(content, self._spool, limit=limit, durable=False) as came:
            self._upload(came.sha256, came.size, lambda path: self._files.put_file(str(came.path), path))
            return came.sha256

    def _upload(self, sha256: str, size: int, send: Callable[[str], None]) -> None:
        path = self._path(sha256)
        with suppress(FileNotFoundError):
            if self._info(path)["size"] == size:
                return
        try:
            with self._told():
                upload(self._files, path, send, incoming=self._incoming)
        except FileNotFoundError:
            raise missing_root(self._address) from None

    def exists(self, sha256: str) -> bool:
        """Whether there is such a blob."""
        try:
            self._info(self._path(sha256))
        except FileNotFoundError:
            self._require_root()
            return False
        return True

    def open(self, sha256: str) -> BinaryIO:
        """Open a blob for reading, as `BlobStore.open` says."""
        path = self._path(sha256)
        if self._cache is not None and (copy := self._cache.get(sha256)) is not None:
            return io.BytesIO(copy)
        try:
            with self._told():
                file = self._files.open(path, "rb", block_size=BLOCK)
        except FileNotFoundError:
            raise self._no_such_blob(sha256) from None
        return remote_stream(cast("BinaryIO", file), self._told)

    def read(self, sha256: str) -> bytes:
        """Return a blob's content, which is checked against its hash."""
        path = self._path(sha256)
        if self._cache is not None and (copy := self._cache.get(sha256)) is not None:
            return copy
        try:
            with self._told():
                content = cast("bytes", self._files.cat_file(path))
        except FileNotFoundError:
            raise self._no_such_blob(sha256) from None
        if hashlib.sha256(content).hexdigest() != sha256:
            raise Unavailable("the store sent other bytes than it was given", where=f"{self._address}: {sha256}")
        if self._cache is not None:
            self._cache.add(sha256, content)
        return content

    def size(self, sha256: str) -> int:
        """Return a blob's length in bytes."""
        try:
            return int(self._info(self._path(sha256))["size"])
        except FileNotFoundError:
            raise self._no_such_blob(sha256) from None

    def local_path(self, sha256: str) -> None:
        """There is no file of this machine."""
        self._path(sha256)

    def delete(self, sha256: str) -> bool:
        """Remove a blob if it is there; return whether it was."""
        return self.exists(sha256) and self._remove(sha256)

    def delete_all(self, names: Sequence[str]) -> int:
        """Remove blobs, several at a time; a bucket doesn't tell which were there, and all are counted."""
        if not self._files.async_impl:
            return sum(self.delete(sha256) for sha256 in names)
        # one by one: the request for many isn't known to every server, and s3fs keeps its errors to itself
        with ThreadPoolExecutor(AT_ONCE, thread_name_prefix="blobs") as pool:
            return sum(pool.map(self._remove, names))

    def _remove(self, sha256: str) -> bool:
        path = self._path(sha256)
        self._forget(sha256)
        try:
            with self._told():
                self._files.rm_file(path)
        except FileNotFoundError:
            self._require_root()
            return False
        return True

    def iterate(self) -> Iterator[StoredBlob]:
        """Yield all blobs in the order of their names; what two digits begin is listed at a time."""
        for fan in self._list(self._root):
            if not is_fan(name_of(fan)):
                continue
            found: dict[str, dict[str, Any]] = {}
            with self._told(), suppress(FileNotFoundError):
                found = cast("dict[str, dict[str, Any]]", self._files.find(fan, detail=True))
            for path in sorted(found, key=name_of):
                if is_name(name_of(path)) and path.endswith(key_of(name_of(path))):
                    yield StoredBlob(name_of(path), int(found[path]["size"]), modified_of(found[path]))

    def discard_incoming(self, *, before: float) -> int:
        """Remove what writers that were killed left behind, here and there, and return how many files that were."""
        stale = [path for path in self._spool.iterdir() if path.stat().st_mtime < before]
        for path in stale:
            path.unlink(missing_ok=True)
        gone = len(stale)
        if self._has_folders:
            for path in self._list(self._incoming):
                with self._told(), suppress(FileNotFoundError):
                    written = modified_of(self._files.info(path))
                    if written is not None and written < before:
                        self._files.rm_file(path)
                        gone += 1
        return gone

    def check(self) -> None:
        """Write and read a few bytes, as `BlobStore.check` says."""
        path = f"{self._root}/check"
        try:
            with self._told():
                if self._has_folders:
                    self._files.makedirs(self._root, exist_ok=True)
                self._files.pipe_file(path, CHECK, **self._in_time)
                if self._files.cat_file(path, **self._in_time) != CHECK:
                    raise Unavailable("the store of the uploaded files gives back other bytes", where=self._address)
        except FileNotFoundError:
            raise missing_root(self._address) from None

    def usage(self) -> Usage:
        """Nobody tells how full a bucket is."""
        return Usage()

    def close(self) -> None:
        """Give back connections."""
        close_connections(self._files)

    def _forget(self, sha256: str) -> None:
        if self._cache is not None:
            self._cache.forget(sha256)

    def _path(self, sha256: str) -> str:
        return f"{self._root}/{key_of(sha256)}"

    def _info(self, path: str) -> dict[str, Any]:
        with self._told():
            return self._files.info(path)

    def _list(self, path: str) -> list[str]:
        try:
            with self._told():
                return sorted(self._files.ls(path, detail=False))
        except FileNotFoundError:
            self._require_root()
            return []

    def _no_such_blob(self, sha256: str) -> ClearLinesError:
        self._require_root()
        return NotFound("there is no such blob", where=sha256)

    def _require_root(self) -> None:
        """Tell a bucket that is gone from an empty one; folders are made when they are needed."""
        if self._has_folders:
            return
        try:
            self._info(self._root.partition("/")[0])
        except FileNotFoundError:
            raise missing_root(self._address) from None
