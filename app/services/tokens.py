"""Tokens: made with a name and a role, shown once, kept as a hash, good until they expire or are revoked."""

from __future__ import annotations

import hashlib
import secrets
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import cast

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import Token
from app.errors import Conflict, InvalidInput, NotFound, Unauthenticated
from app.services.access import ROLES, Role, Viewer
from app.services.events import record_event
from app.services.given import checked_name

PREFIX = "cl_"
"""Tells a token of ClearLines from other secrets, to people and to scanners that look for leaked ones."""

RANDOM_BYTES = 32
USE_RECORDED_EVERY = timedelta(minutes=10)


@dataclass(frozen=True)
class NewToken:
    """A token at the one moment when it is known.

    Attributes:
        text: What its holder sends; only its hash is kept.
    """

    text: str
    name: str
    role: str
    expires_at: datetime | None


def create_token(
    session: Session, name: str, role: str, now: datetime, *, lifetime: timedelta | None = None, person: str | None
) -> NewToken:
    """Make a token.

    Args:
        session: A writing session.
        name: What its holder does is stored under it; no other living token has it.
        role: One of ``ROLES``.
        now: When.
        lifetime: How long it is good; without end when left out.
        person: Who makes it.

    Raises:
        InvalidInput: When the name, role or lifetime can't be.
        Conflict: When a living token has the name.
    """
    name = checked_name(name)
    if role not in ROLES:
        raise InvalidInput(f"there is no role {role!r:.60}", where="role", expected=", ".join(ROLES))
    if lifetime is not None and lifetime <= timedelta(0):
        raise InvalidInput("the token would be over at once", where="lifetime", expected="more than nothing")
    if session.scalar(select(Token.id).where(Token.name == name, Token.revoked_at.is_(None))) is not None:
        raise Conflict(f"a token named {name} exists already", where="name", hint="revoke that one, or take a new name")
    text = PREFIX + secrets.token_urlsafe(RANDOM_BYTES)
    expires_at = None if lifetime is None else now + lifetime
    session.add(Token(name=name, role=role, sha256=hash_of(text), created_at=now, expires_at=expires_at))
    session.flush()
    record_event(session, "token.created", now, person=person, details={"name": name, "role": role})
    return NewToken(text, name, role, expires_at)


def list_tokens(session: Session) -> Sequence[Token]:
    """Return all tokens, revoked ones too, by name."""
    return session.scalars(select(Token).order_by(Token.name, Token.id)).all()


def revoke_token(session: Session, name: str, now: datetime, *, person: str | None) -> Token:
    """End a token; what was done under its name stays.

    Raises:
        NotFound: When no living token has the name.
    """
    token = session.scalars(select(Token).where(Token.name == name, Token.revoked_at.is_(None))).one_or_none()
    if token is None:
        raise NotFound(f"there is no token named {name}", hint="clearlines token list shows them")
    token.revoked_at = now
    session.flush()
    record_event(session, "token.revoked", now, person=person, details={"name": name})
    return token


def token_of(session: Session, text: str, now: datetime) -> Token:
    """Return the token that a request carries.

    Raises:
        Unauthenticated: When it is unknown, revoked or expired; which of these it is, isn't told.
    """
    token = session.scalars(select(Token).where(Token.sha256 == hash_of(text))).one_or_none()
    if token is None or token.revoked_at is not None or (token.expires_at is not None and token.expires_at <= now):
        raise Unauthenticated(
            "the token is not good (any more)",
            where="Authorization",
            expected="a token that clearlines token create has printed",
            hint="sign in again, or ask for a new token",
        )
    return token


def viewer_of(token: Token) -> Viewer:
    """Return who asks with a token."""
    return Viewer(token.name, cast("Role", token.role))  # the column's constraint lets no other word in


def is_use_due(token: Token, now: datetime) -> bool:
    """Whether the time of the last use is so long ago that a new one is worth a write."""
    return token.last_used_at is None or now - token.last_used_at >= USE_RECORDED_EVERY


def record_use(session: Session, token_id: int, now: datetime) -> None:
    """Store when a token was last used."""
    token = session.get(Token, token_id)
    if token is not None:
        token.last_used_at = now


def hash_of(text: str) -> str:
    """Return the SHA-256 that a token is known by; it has 256 random bits, so it needs no salt and no slow hash."""
    return hashlib.sha256(text.encode("utf-8", "surrogateescape")).hexdigest()
