"""Exports: a dataset's labels as a zip."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from typing import BinaryIO

from fastapi import APIRouter
from fastapi.responses import StreamingResponse

from app.api.deps import Reader, ServerDep
from app.api.problems import answers
from app.services.exporting import ExportChoice, write_export

router = APIRouter(tags=["exports"], responses=answers(404, 409))
PIECE = 2**20
ZIP = {200: {"content": {"application/zip": {"schema": {"type": "string", "format": "binary"}}}}}


@router.get("/datasets/{slug}/export", response_class=StreamingResponse, responses={**ZIP})
def export_dataset(
    server: ServerDep,
    session: Reader,
    slug: str,
    format: str = "clearlines",  # noqa: A002 - the word that users know
    images: bool = True,
    allow_not_done: bool = False,
) -> StreamingResponse:
    """Return the labels of a dataset as a zip, with or without its images.

    Kept segments are the labels. Discarded images are left out. Images that aren't done are refused by name (409,
    `details.images`) unless `allow_not_done` is set.
    """
    choice = ExportChoice(format=format, allow_not_done=allow_not_done, with_images=images)
    # written to disk first: an error on the way is an answer of its own, not a broken download
    archive = tempfile.TemporaryFile()  # noqa: SIM115 - closed when it is sent
    try:
        size = write_export(session, server.blobs, slug, archive, choice)
    except BaseException:
        archive.close()
        raise
    headers = {
        "Content-Disposition": f'attachment; filename="{slug}-{format}.zip"',
        "Content-Length": str(size),
    }
    return StreamingResponse(_pieces(archive), media_type="application/zip", headers=headers)


def _pieces(archive: BinaryIO) -> Iterator[bytes]:
    with archive:
        archive.seek(0)
        while piece := archive.read(PIECE):
            yield piece
