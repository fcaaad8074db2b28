"""Downloads from a store that isn't this machine's: whole and right, or cut off."""

from __future__ import annotations

import random
from pathlib import Path

import pytest
from fastapi.responses import StreamingResponse
from fsspec.implementations.memory import MemoryFileSystem

from app.api.stored_files import PIECE, stored_file_answer
from app.errors import Unavailable
from app.storage import BlobStore, open_blobs_at
from tests.event_loop import run


@pytest.fixture
def blobs(tmp_path: Path) -> BlobStore:
    return open_blobs_at("memory://stored-files", folder=tmp_path)


def received(blobs: BlobStore, sha256: str, into: list[bytes]) -> None:
    """Take in what is sent of a blob."""
    answer = stored_file_answer(blobs, sha256, "one.png", {})
    assert isinstance(answer, StreamingResponse)

    async def take() -> None:
        async for piece in answer.body_iterator:
            assert isinstance(piece, bytes)
            into.append(piece)

    run(take())


@pytest.mark.parametrize("size", [0, 1, PIECE, PIECE + 1, 3 * PIECE])
def test_what_was_stored_is_sent(blobs: BlobStore, size: int) -> None:
    content = random.Random(size).randbytes(size)
    pieces: list[bytes] = []
    received(blobs, blobs.put(content), pieces)
    assert b"".join(pieces) == content


@pytest.mark.parametrize("size", [10, 2 * PIECE])
def test_other_bytes_are_never_sent_whole(blobs: BlobStore, size: int) -> None:
    sha256 = blobs.put(bytes(size))
    (path,) = (path for path in MemoryFileSystem().find("/stored-files") if path.endswith(sha256))
    MemoryFileSystem().pipe_file(path, bytes(size - 1) + b"x")
    pieces: list[bytes] = []
    with pytest.raises(Unavailable, match="other bytes"):
        received(blobs, sha256, pieces)
    assert len(b"".join(pieces)) < size
