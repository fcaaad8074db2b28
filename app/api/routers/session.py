"""Who asks: signing in with a token, and out."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response, status

from app.api.deps import Now, ServerDep, ViewerDep
from app.api.gate import anonymous_viewer, forget_token, remember_token
from app.api.problems import answers
from app.api.schemas.session import Abilities, Me, TokenGiven
from app.services.access import Viewer, can_label, can_maintain, can_see_hidden, can_submit
from app.services.tokens import token_of, viewer_of

router = APIRouter(tags=["session"])


@router.get("/me", responses=answers(401))
def read_me(viewer: ViewerDep) -> Me:
    """Return who asks, and what they may do."""
    return _me(viewer)


@router.post("/session", responses=answers(401))
def sign_in(server: ServerDep, now: Now, request: Request, response: Response, given: TokenGiven) -> Me:
    """Keep a token in a cookie, for browsers; programs send `Authorization: Bearer cl_...` with each request."""
    with server.database.read() as session:
        token = token_of(session, given.token, now)
    seconds = None if token.expires_at is None else int((token.expires_at - now).total_seconds())
    remember_token(response, given.token, secure=request.url.scheme == "https", seconds=seconds)
    return _me(viewer_of(token))


@router.delete("/session", status_code=status.HTTP_200_OK)
def sign_out(server: ServerDep, response: Response) -> Me:
    """Drop the cookie; the token itself stays good until it expires or is revoked."""
    forget_token(response)
    return _me(anonymous_viewer(server.settings))


def _me(viewer: Viewer) -> Me:
    can = Abilities(
        submit=can_submit(viewer),
        label=can_label(viewer),
        maintain=can_maintain(viewer),
        see_hidden=can_see_hidden(viewer),
    )
    return Me(name=viewer.name, role=viewer.role, anonymous=viewer.anonymous, can=can)
