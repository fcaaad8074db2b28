"""What a request carries to say who asks, and whose it is."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from typing import Literal

from sqlalchemy.orm import Session
from starlette.datastructures import Headers

from app.api.cookies import SESSION_COOKIE, TOKEN_COOKIE, cookie_of
from app.db.models import Token, WebSession
from app.services import tokens, web_sessions
from app.services.access import Viewer
from app.services.web_sessions import SessionRules


@dataclass(frozen=True)
class Credential:
    """A secret.

    Attributes:
        kind: Whether it is a token or a browser's session.
        text: The secret itself.
        in_cookie: Whether a browser sends it by itself, with whatever request a page makes.
    """

    kind: Literal["token", "session"]
    text: str
    in_cookie: bool


@dataclass(frozen=True)
class Known:
    """Whose a secret is.

    Attributes:
        viewer: Who asks.
        row: Where the secret's hash is.
    """

    viewer: Viewer
    row: Token | WebSession


def credential_of(headers: Headers) -> Credential | None:
    """Return what a request carries: the header counts before cookies."""
    scheme, _, token = headers.get("authorization", "").partition(" ")
    if scheme.lower() == "bearer" and token.strip():
        return Credential("token", token.strip(), in_cookie=False)
    if secret := cookie_of(headers, SESSION_COOKIE):
        return Credential("session", secret, in_cookie=True)
    if secret := cookie_of(headers, TOKEN_COOKIE):
        return Credential("token", secret, in_cookie=True)
    return None


def identify(session: Session, credential: Credential, now: datetime, rules: SessionRules) -> Known:
    """Return whose a secret is.

    Raises:
        Unauthenticated: When it isn't good (any more).
    """
    if credential.kind == "session":
        row, holder = web_sessions.session_of(session, credential.text, now, rules)
        return Known(web_sessions.session_viewer(row, holder), row)
    token, user = tokens.token_of(session, credential.text, now)
    return Known(tokens.token_viewer(token, user), token)


def is_use_due(known: Known, now: datetime, rules: SessionRules) -> bool:
    """Whether the time of the last use is so long ago that a new one is worth a write."""
    if isinstance(known.row, WebSession):
        return web_sessions.is_use_due(known.row, now, rules)
    return tokens.is_use_due(known.row, now)


def record_use(session: Session, known: Known, now: datetime) -> None:
    """Store when a secret was last used."""
    if isinstance(known.row, WebSession):
        web_sessions.record_use(session, known.row, now)
    else:
        tokens.record_use(session, known.row, now)
