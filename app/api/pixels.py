"""Answers that are pictures: the file as it was uploaded, a form that browsers show, a thumbnail."""

from __future__ import annotations

from enum import IntEnum

from fastapi import Response

from app.api.deps import Server
from app.api.freshness import fresh_headers, is_held, not_modified
from app.api.stored_files import stored_file_answer
from app.errors import NotFound
from app.images import for_browser, shown_as_stored, thumbnail
from app.services.image_views import ViewedImage, render_view

PIXELS = {200: {"content": {"image/*": {"schema": {"type": "string", "format": "binary"}}}}}


class ThumbnailSize(IntEnum):
    """Longer side of a thumbnail, px."""

    SMALL = 160
    MEDIUM = 320
    LARGE = 640


def original_answer(server: Server, sha256: str, file_name: str, if_none_match: str | None) -> Response:
    """Return the file as it was uploaded.

    Raises:
        NotFound: When it is gone.
    """
    if is_held(if_none_match, sha256):
        return not_modified(sha256)
    try:
        return stored_file_answer(server.blobs, sha256, file_name.rpartition("/")[2], fresh_headers(sha256))
    except NotFound as error:
        raise NotFound("the image's file is gone", where=file_name) from error


def display_answer(server: Server, sha256: str, if_none_match: str | None) -> Response:
    """Return the image in a form that a browser shows, pixels as stored."""
    tag = f"{sha256}-display"
    if is_held(if_none_match, tag):
        return not_modified(tag)
    most = server.settings.max_image_pixels
    content = server.blobs.read(sha256)
    media_type = shown_as_stored(content, max_pixels=most)
    if media_type is None:
        with server.decoding.place():
            content, media_type = for_browser(content, max_pixels=most)
    return Response(content, media_type=media_type, headers=fresh_headers(tag))


def view_answer(server: Server, viewed: ViewedImage, if_none_match: str | None) -> Response:
    """Return another view of an image than its pixels as stored."""
    if is_held(if_none_match, viewed.tag):
        return not_modified(viewed.tag)
    with server.decoding.place():
        content = server.blobs.read(viewed.sha256)
        seen, media_type = render_view(viewed, content, max_pixels=server.settings.max_image_pixels)
    return Response(seen, media_type=media_type, headers=fresh_headers(viewed.tag))


def thumbnail_answer(server: Server, sha256: str, size: ThumbnailSize, if_none_match: str | None) -> Response:
    """Return a small picture whose longer side is ``size`` px."""
    tag = f"{sha256}-{size.value}"
    if is_held(if_none_match, tag):
        return not_modified(tag)
    with server.decoding.place():
        data = server.blobs.read(sha256)
        content, media_type = thumbnail(data, size.value, max_pixels=server.settings.max_image_pixels)
    return Response(content, media_type=media_type, headers=fresh_headers(tag))
