"""Who asks: signing in with a name and a password, or with a token, and out."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response, status

from app.api.cookies import SESSION_COOKIE, TOKEN_COOKIE, cookie_of, forget_secrets, is_secure, remember
from app.api.deps import BrowserDep, Now, ServerDep, ViewerDep
from app.api.entrance import end_browser_session, get_entrance, let_in
from app.api.gate import anonymous_viewer, require_own_page
from app.api.me import me_of
from app.api.problems import answers
from app.api.schemas.session import Me, PasswordGiven, TokenGiven
from app.api.throttle import client_address
from app.db.models import User
from app.services.account_names import typed_key
from app.services.entering import sign_in as enter
from app.services.tokens import token_of, token_viewer
from app.services.web_sessions import was_signed_in_from

router = APIRouter(tags=["session"])


@router.get("/me", responses=answers(401))
def read_me(server: ServerDep, viewer: ViewerDep) -> Me:
    """Return who asks, and what they may do."""
    if viewer.user_id is None:
        return me_of(server.settings, viewer, None)
    with server.database.read() as session:
        return me_of(server.settings, viewer, session.get(User, viewer.user_id))


@router.post("/session", responses=answers(401, 409, 429))
def sign_in(server: ServerDep, now: Now, request: Request, response: Response, given: PasswordGiven | TokenGiven) -> Me:
    """Sign a browser in, with a name and a password or with a token, and keep it signed in by a cookie.

    Programs send `Authorization: Bearer cl_...` with each request.
    """
    address = client_address(request.scope)
    if isinstance(given, PasswordGiven):
        entrance, key = get_entrance(request), typed_key(given.name)
        with server.database.read() as session:
            is_known = was_signed_in_from(session, key, address)
        with server.throttle.signing_in(key, address, is_known=is_known):
            user, made = enter(entrance, given.name, given.password.get_secret_value())
        return let_in(request, response, user, made)
    with server.throttle.signing_in(None, address), server.database.read() as session:
        token, holder = token_of(session, given.token, now)
    end_browser_session(server, request.headers, now, address)
    seconds = None if token.expires_at is None else int((token.expires_at - now).total_seconds())
    remember(response, TOKEN_COOKIE, given.token, secure=is_secure(server.settings, request), seconds=seconds)
    return me_of(server.settings, token_viewer(token, holder), holder)


@router.delete("/session", status_code=status.HTTP_200_OK)
def sign_out(server: ServerDep, now: Now, browser: BrowserDep, request: Request, response: Response) -> Me:
    """Drop the cookies, and end the browser's session. A token stays good until it expires or is revoked."""
    if cookie_of(request.headers, SESSION_COOKIE):
        require_own_page(request.headers)
        end_browser_session(server, request.headers, now, browser.address)
    forget_secrets(response)
    return me_of(server.settings, anonymous_viewer(server.settings), None)
