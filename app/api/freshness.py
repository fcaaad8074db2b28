"""Whether a client holds the current content already, so that only ``304 Not Modified`` is sent."""

from __future__ import annotations

import re
from typing import Annotated

from fastapi import Header, Response

REVALIDATED = "private, no-cache"  # ids begin at 1 in every database, so an address alone says nothing of the content

IfNoneMatch = Annotated[str | None, Header()]


def fresh_headers(tag: str) -> dict[str, str]:
    """Return the headers of content that is kept, and asked after each time."""
    return {"ETag": f'"{tag}"', "Cache-Control": REVALIDATED}


def is_held(if_none_match: str | None, tag: str) -> bool:
    """Whether ``If-None-Match`` names the content's tag: any, one, or one of a list, weak ones too (RFC 9110, 13.1.2).

    Args:
        if_none_match: The request's header.
        tag: Of the content, without quotes.
    """
    if if_none_match is None:
        return False
    return if_none_match.strip() == "*" or tag in re.findall(r'"([^"]*)"', if_none_match)


def not_modified(tag: str) -> Response:
    """Return the answer to a client that holds the content."""
    return Response(status_code=304, headers=fresh_headers(tag))
