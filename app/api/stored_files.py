"""Answers that are a blob as it is stored, from whatever store it lies in."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping
from typing import BinaryIO
from urllib.parse import quote

from fastapi import Response
from fastapi.responses import FileResponse, StreamingResponse

from app.errors import Unavailable
from app.storage import BlobStore

PIECE = 2**20
MEDIA_TYPE = "application/octet-stream"


def stored_file_answer(blobs: BlobStore, sha256: str, file_name: str, headers: Mapping[str, str]) -> Response:
    """Return a blob to be saved as a file; parts of it can be asked for where it is a file of this machine.

    Args:
        blobs: The store.
        sha256: The blob.
        file_name: What to save it as.
        headers: To send along.

    Raises:
        NotFound: When there is no such blob; else the answer would break off after it has begun.
        Unavailable: When the store can't be reached; while the answer is sent, when it isn't what was stored.
    """
    size = blobs.size(sha256)
    path = blobs.local_path(sha256)
    if path is not None:
        return FileResponse(path, filename=file_name, media_type=MEDIA_TYPE, headers=headers)
    return StreamingResponse(
        _pieces(blobs.open(sha256), sha256),
        media_type=MEDIA_TYPE,
        headers={**headers, "Content-Length": str(size), "Content-Disposition": _saved_as(file_name)},
    )


def _saved_as(file_name: str) -> str:
    """Return ``Content-Disposition`` as for files of this machine (RFC 6266)."""
    escaped = quote(file_name)
    return f'attachment; filename="{file_name}"' if escaped == file_name else f"attachment; filename*=utf-8''{escaped}"


def _pieces(stream: BinaryIO, sha256: str) -> Iterator[bytes]:
    """Give the content in pieces; the last one only when all is known to be right, so that nobody takes less for it."""
    digest = hashlib.sha256()
    held = b""
    with stream:
        while piece := stream.read(PIECE):
            digest.update(piece)
            if held:
                yield held
            held = piece
    if digest.hexdigest() != sha256:
        raise Unavailable("the store sent other bytes than it was given", where=sha256)
    yield held
