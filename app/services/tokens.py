"""Tokens: made with a name and a role, shown once, kept as a hash, good until they expire or are revoked.

Service tokens are made here, for programs that nobody's account stands for; people's own in `account_tokens`.
"""

from __future__ import annotations

import hashlib
import secrets
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import cast

from sqlalchemy import ColumnElement, and_, select, update
from sqlalchemy.orm import Session

from app.db.models import Token, User
from app.errors import Conflict, InvalidInput, NotFound, Unauthenticated
from app.services.access import Role, Viewer, checked_role, lesser_role
from app.services.account_names import require_no_account
from app.services.events import record_event
from app.services.given import checked_name
from app.services.link_revoking import revoke_links_by

PREFIX = "cl_"
"""Tells a token of ClearLines from other secrets, to people and to scanners that look for leaked ones."""

RANDOM_BYTES = 32
LONGEST = timedelta(days=36_500)
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
        name: What its holder does is stored under it; no other living token has it, and no account.
        role: One of ``ROLES``.
        now: When.
        lifetime: How long it is good; without end when left out.
        person: Who makes it.

    Raises:
        InvalidInput: When the name, role or lifetime can't be.
        Conflict: When a living token or any account has the name.
    """
    name = checked_name(name)
    role = checked_role(role)
    lifetime = checked_lifetime(lifetime)
    if session.scalar(select(Token.id).where(_is_living(name))) is not None:
        raise Conflict(f"a token named {name} exists already", where="name", hint="revoke that one, or take a new name")
    require_no_account(session, name)
    text = new_text()
    expires_at = None if lifetime is None else now + lifetime
    session.add(Token(name=name, role=role, sha256=hash_of(text), created_at=now, expires_at=expires_at))
    session.flush()
    record_event(session, "token.created", now, person=person, details={"name": name, "role": role})
    return NewToken(text, name, role, expires_at)


def list_tokens(session: Session) -> Sequence[Token]:
    """Return all tokens, people's own and revoked ones too, by name."""
    return session.scalars(select(Token).order_by(Token.name, Token.id)).all()


def revoke_token(session: Session, name: str, now: datetime, *, person: str | None) -> Token:
    """End a service token, and the links that it made; what else was done under its name stays.

    Raises:
        NotFound: When no living token has the name.
    """
    token = session.scalars(select(Token).where(_is_living(name))).one_or_none()
    if token is None:
        raise NotFound(f"there is no token named {name}", hint="clearlines token list shows them")
    token.revoked_at = now
    session.flush()
    revoke_links_by(session, token.name, now)
    record_event(session, "token.revoked", now, person=person, details={"name": name})
    return token


def token_of(session: Session, text: str, now: datetime) -> tuple[Token, User | None]:
    """Return the token that a request carries, and whose account it is for; a service's is for none.

    Raises:
        Unauthenticated: When it is unknown, revoked or expired, or the account disabled; which of these, isn't told.
    """
    found = session.execute(
        select(Token, User).outerjoin(User, User.id == Token.user_id).where(Token.sha256 == hash_of(text))
    ).one_or_none()
    if found is None or not _is_good(found[0], found[1], now):
        raise Unauthenticated(
            "the token is not good (any more)",
            where="Authorization",
            expected="a token of your account, or one that clearlines token create has printed",
            hint="sign in again, or ask for a new token",
        )
    return found[0], found[1]


def token_viewer(token: Token, user: User | None) -> Viewer:
    """Return who asks with a token: of an account's it is the account, with the lesser of both roles."""
    # the columns' constraints let no other words in
    if user is None:
        return Viewer(token.name, cast("Role", token.role))
    return Viewer(user.name, lesser_role(token.role, user.role), user_id=user.id)


def is_use_due(token: Token, now: datetime) -> bool:
    """Whether the time of the last use is so long ago that a new one is worth a write."""
    return token.last_used_at is None or now - token.last_used_at >= USE_RECORDED_EVERY


def record_use(session: Session, token: Token, now: datetime) -> None:
    """Store when a token, and the account that it is for, were last used."""
    if token.user_id is not None:  # its row first, as whoever disables it
        session.execute(update(User).where(User.id == token.user_id).values(last_seen_at=now))
    session.execute(update(Token).where(Token.id == token.id).values(last_used_at=now))


def new_text() -> str:
    """Return a new token."""
    return PREFIX + secrets.token_urlsafe(RANDOM_BYTES)


def checked_lifetime(lifetime: timedelta | None) -> timedelta | None:
    """Return how long a token is to be good.

    Raises:
        InvalidInput: When it would be over at once, or never within the calendar.
    """
    if lifetime is not None and not timedelta(0) < lifetime <= LONGEST:
        raise InvalidInput("no token can be good for so long", where="lifetime", expected=f"up to {LONGEST.days} days")
    return lifetime


def hash_of(text: str) -> str:
    """Return the SHA-256 that a token is known by; it has 256 random bits, so it needs no salt and no slow hash."""
    return hashlib.sha256(text.encode("utf-8", "surrogateescape")).hexdigest()


def _is_living(name: str) -> ColumnElement[bool]:
    return and_(Token.name == name, Token.revoked_at.is_(None), Token.user_id.is_(None))


def _is_good(token: Token, user: User | None, now: datetime) -> bool:
    over = token.expires_at is not None and token.expires_at <= now
    return not over and token.revoked_at is None and (user is None or user.disabled_at is None)
