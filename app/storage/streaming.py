"""A remote blob as a stream."""

from __future__ import annotations

import io
from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import BinaryIO, cast

BLOCK = 4 * 2**20  # bytes of one request


class _Told(io.RawIOBase):
    """A file of a file system, whose errors are turned into ours."""

    def __init__(self, file: BinaryIO, told: Callable[[], AbstractContextManager[None]]) -> None:
        self._file = file
        self._told = told

    def readable(self) -> bool:
        return True

    def seekable(self) -> bool:
        return True

    def seek(self, offset: int, whence: int = io.SEEK_SET, /) -> int:
        with self._told():
            return self._file.seek(offset, whence)

    def readinto(self, buffer: memoryview, /) -> int:  # type: ignore[override]
        with self._told():
            data = self._file.read(len(buffer))
        buffer[: len(data)] = data
        return len(data)

    def close(self) -> None:
        if not self.closed:
            self._file.close()
        super().close()


def remote_stream(file: BinaryIO, told: Callable[[], AbstractContextManager[None]]) -> BinaryIO:
    """Return a stream of the file's bytes.

    Args:
        file: Opened for reading; closed with the stream.
        told: Gives a context that turns the file system's errors into ours.
    """
    return cast("BinaryIO", io.BufferedReader(_Told(file, told), buffer_size=2**20))
