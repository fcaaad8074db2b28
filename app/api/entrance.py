"""Signing a browser in: what every way into an account has in common, and the answer that it ends with."""

from __future__ import annotations

from contextlib import suppress
from datetime import datetime
from typing import Annotated

from fastapi import Depends, Request, Response
from starlette.datastructures import Headers

from app.api.cookies import SESSION_COOKIE, cookie_of, is_secure, remember
from app.api.deps import Server, get_browser, get_now, get_server
from app.api.me import me_of
from app.api.schemas.session import Me
from app.db.models import User
from app.errors import Conflict, NotFound, Unauthenticated
from app.services.entering import Entrance
from app.services.events import Actor
from app.services.web_sessions import NewSession, end_session, session_of, session_rules, session_viewer


def get_entrance(request: Request) -> Entrance:
    """Return what everybody who comes in passes.

    Raises:
        Conflict: In local mode, where nobody signs in.
    """
    server = get_server(request)
    if server.settings.anonymous == "admin":
        raise Conflict(
            "nobody signs in in local mode: whoever asks is the owner",
            hint="to require accounts set CLEARLINES_PUBLIC_URL, or CLEARLINES_ANONYMOUS_ROLE=reader",
        )
    return Entrance(
        server.database,
        server.passwords,
        session_rules(server.settings),
        get_browser(request),
        get_now(server),
    )


EntranceDep = Annotated[Entrance, Depends(get_entrance)]


def let_in(request: Request, response: Response, user: User, made: NewSession) -> Me:
    """Give a browser the secret of its new session, end the one that it had, and say who it is now."""
    server, now = get_server(request), made.row.created_at
    end_browser_session(server, request.headers, now, get_browser(request).address)
    seconds = int((made.row.expires_at - now).total_seconds())
    secure = is_secure(server.settings, request)
    remember(response, SESSION_COOKIE, made.text, secure=secure, seconds=seconds)
    return me_of(server.settings, session_viewer(made.row, user), user)


def end_browser_session(server: Server, headers: Headers, now: datetime, address: str | None) -> None:
    """End the session whose secret a browser sends along, if it is still good."""
    secret = cookie_of(headers, SESSION_COOKIE)
    if not secret:
        return
    with suppress(Unauthenticated, NotFound), server.database.write() as session:
        row, user = session_of(session, secret, now, session_rules(server.settings))
        end_session(session, user.id, row.id, now, Actor(user.name, address), "session.ended")
