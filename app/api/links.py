"""Addresses of pages, to be given to somebody."""

from __future__ import annotations

from fastapi import Request

from app.api.deps import get_server
from app.api.schemas.accounts import LinkMade
from app.services.invitations import NewInvitation, invitation_address


def link_made(request: Request, made: NewInvitation) -> LinkMade:
    """Return the link of an invitation, as its maker is shown it this once."""
    base = get_server(request).settings.public_url or str(request.base_url)
    address = invitation_address(base, made.text)
    return LinkMade(id=made.id, secret=made.text, address=address, expires_at=made.expires_at)
