"""Browsers that are signed in: a secret in a cookie, kept as a hash, good until it expires, is idle or is ended."""

from __future__ import annotations

import secrets
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import cast

from sqlalchemy import ColumnElement, and_, delete, select, update
from sqlalchemy.orm import Session

from app.db.models import User, WebSession
from app.errors import NotFound, Unauthenticated
from app.services.access import Role, Viewer
from app.services.events import Actor, record_account_event
from app.services.tokens import RANDOM_BYTES, hash_of
from app.settings import Settings

ADDRESS_LENGTH = 100
AGENT_LENGTH = 300
KEPT_AFTERWARDS = timedelta(days=30)
"""How long the row of a session that is over stays, for whoever looks into something."""


@dataclass(frozen=True)
class SessionRules:
    """How long a session is good.

    Attributes:
        lifetime: At most.
        idle: Without being used.
    """

    lifetime: timedelta
    idle: timedelta

    @property
    def recorded_every(self) -> timedelta:
        """How old the stored time of the last use may get."""
        return min(timedelta(minutes=10), self.idle / 10)


@dataclass(frozen=True)
class Browser:
    """Where somebody signs in from.

    Attributes:
        address: Of the network.
        agent: What the browser says it is.
    """

    address: str | None = None
    agent: str | None = None


@dataclass(frozen=True)
class NewSession:
    """A session at the one moment when its secret is known.

    Attributes:
        text: What the browser sends; only its hash is kept.
    """

    text: str
    row: WebSession


def session_rules(settings: Settings) -> SessionRules:
    """Return the rules that a server's settings make."""
    return SessionRules(timedelta(days=settings.session_days), timedelta(days=settings.session_idle_days))


def start_session(session: Session, user: User, now: datetime, rules: SessionRules, browser: Browser) -> NewSession:
    """Sign somebody in, with a new secret each time.

    Args:
        session: A writing session.
        user: Who has shown that it is them.
        now: When.
        rules: How long it is good.
        browser: Where they are.
    """
    text = secrets.token_urlsafe(RANDOM_BYTES)
    session.execute(
        delete(WebSession).where(WebSession.user_id == user.id, WebSession.expires_at < now - KEPT_AFTERWARDS)
    )
    row = WebSession(
        user_id=user.id,
        sha256=hash_of(text),
        created_at=now,
        expires_at=now + rules.lifetime,
        last_used_at=now,
        address=_printable(browser.address, ADDRESS_LENGTH),
        agent=_printable(browser.agent, AGENT_LENGTH),
    )
    session.add(row)
    user.last_seen_at = now
    session.flush()
    record_account_event(session, "session.started", now, Actor(user.name, browser.address))
    return NewSession(text, row)


def session_of(session: Session, text: str, now: datetime, rules: SessionRules) -> tuple[WebSession, User]:
    """Return the session that a browser's cookie names, and whose it is.

    Raises:
        Unauthenticated: When it is unknown, expired, idle for too long or ended; which of these it is, isn't told.
    """
    found = session.execute(
        select(WebSession, User)
        .join(User, User.id == WebSession.user_id)
        .where(WebSession.sha256 == hash_of(text), _is_alive(now, rules), User.disabled_at.is_(None))
    ).one_or_none()
    if found is None:
        raise Unauthenticated("you are signed out", where="Cookie", hint="sign in again")
    return found[0], found[1]


def session_viewer(row: WebSession, user: User) -> Viewer:
    """Return who asks through a session."""
    role = cast("Role", user.role)  # the column's constraint lets no other word in
    return Viewer(user.name, role, user_id=user.id, web_session_id=row.id)


def is_use_due(row: WebSession, now: datetime, rules: SessionRules) -> bool:
    """Whether the time of the last use is so long ago that a new one is worth a write."""
    return now - row.last_used_at >= rules.recorded_every


def record_use(session: Session, row: WebSession, now: datetime) -> None:
    """Store when a session, and its account, were last used."""
    # the account's row first, as whoever disables it: two that hold one each would wait for each other
    session.execute(update(User).where(User.id == row.user_id).values(last_seen_at=now))
    session.execute(update(WebSession).where(WebSession.id == row.id).values(last_used_at=now))


def was_signed_in_from(session: Session, name_key: str, address: str) -> bool:
    """Whether the account of a name was signed in to from an address, as far as the rows go back."""
    if not name_key.isprintable():  # no database takes all of these characters, and no name has any
        return False
    query = select(WebSession.id).join(User, User.id == WebSession.user_id)
    return session.scalar(query.where(User.name_key == name_key, WebSession.address == address).limit(1)) is not None


def list_sessions(session: Session, user_id: int, now: datetime, rules: SessionRules) -> Sequence[WebSession]:
    """Return where somebody is signed in, the latest first."""
    query = select(WebSession).where(WebSession.user_id == user_id, _is_alive(now, rules))
    return session.scalars(query.order_by(WebSession.id.desc())).all()


def end_session(session: Session, user_id: int, session_id: int, now: datetime, actor: Actor, kind: str) -> None:
    """End one of somebody's sessions.

    Args:
        session: A writing session.
        user_id: Whose it is.
        session_id: Which.
        now: When.
        actor: Who ends it.
        kind: For the audit: ``session.ended`` by signing out, ``session.revoked`` from elsewhere.

    Raises:
        NotFound: When they have none of that id that isn't over.
    """
    if not _end(session, now, WebSession.user_id == user_id, WebSession.id == session_id):
        raise NotFound(f"there is no session {session_id}", hint="it may have ended already")
    record_account_event(session, kind, now, actor, session=session_id)


def end_sessions(session: Session, user_id: int, now: datetime, *, but: int | None = None) -> int:
    """End all of somebody's sessions but one, and return how many that were; whoever calls tells the audit why."""
    return _end(session, now, WebSession.user_id == user_id, *([] if but is None else [WebSession.id != but]))


def _end(session: Session, now: datetime, *which: ColumnElement[bool]) -> int:
    ended = update(WebSession).where(*which, WebSession.revoked_at.is_(None), WebSession.expires_at > now)
    return len(session.scalars(ended.values(revoked_at=now).returning(WebSession.id)).all())


def _is_alive(now: datetime, rules: SessionRules) -> ColumnElement[bool]:
    return and_(
        WebSession.revoked_at.is_(None), WebSession.expires_at > now, WebSession.last_used_at > now - rules.idle
    )


def _printable(text: str | None, length: int) -> str | None:
    return None if text is None else "".join(c for c in text if c.isprintable())[:length] or None
