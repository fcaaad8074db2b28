"""Links with a secret that work once: to make an account (``join``), or to choose its password (``reset``)."""

from __future__ import annotations

import secrets
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Literal, cast

from sqlalchemy import ColumnElement, and_, select, update
from sqlalchemy.orm import Session

from app.db.models import Invitation, User
from app.errors import Conflict, InvalidInput, NotFound
from app.services.access import Role, checked_role
from app.services.account_names import checked_account_name, require_free_name
from app.services.accounts import get_account
from app.services.events import Actor, record_account_event
from app.services.link_revoking import revoke_links_to
from app.services.tokens import RANDOM_BYTES, hash_of

MOST_LISTED = 500
LONGEST = timedelta(days=366)


@dataclass(frozen=True)
class NewInvitation:
    """An invitation at the one moment when its secret is known.

    Attributes:
        text: What the link ends with; only its hash is kept.
    """

    text: str
    id: int
    expires_at: datetime


@dataclass(frozen=True)
class InvitationView:
    """What an invitation tells its holder.

    Attributes:
        kind: ``join`` or ``reset``.
        role: That the account will have, or has.
        name: That it will have, or has; ``None`` where the holder chooses it.
        expires_at: Until when it is good.
    """

    kind: Literal["join", "reset"]
    role: Role
    name: str | None
    expires_at: datetime


def invite(
    session: Session, role: str, now: datetime, actor: Actor, *, lifetime: timedelta, name: str | None = None
) -> NewInvitation:
    """Make a link that makes an account.

    Args:
        session: A writing session.
        role: That the account will have.
        now: When.
        actor: Who invites.
        lifetime: How long the link is good.
        name: That the account will have; its holder chooses one when left out.

    Raises:
        InvalidInput: When role, name or lifetime can't be.
        Conflict: When the name is or was somebody's.
    """
    role = checked_role(role)
    if name is not None:
        name = checked_account_name(name)
        require_free_name(session, name, chosen=False)
    made = _add(session, Invitation(kind="join", role=role, name=name), now, actor, lifetime)
    told = {} if name is None else {"name": name}
    record_account_event(session, "invitation.created", now, actor, invitation=made.id, kind="join", role=role, **told)
    return made


def offer_reset(session: Session, user_id: int, now: datetime, actor: Actor, *, lifetime: timedelta) -> NewInvitation:
    """Make a link that lets the holder of an account choose a password; earlier such links end.

    Raises:
        NotFound: When there is no such account.
        Conflict: When it is disabled.
    """
    user = get_account(session, user_id, lock=True)
    if user.disabled_at is not None:
        raise Conflict(f"the account of {user.name} is disabled", hint="enable it first")
    revoke_links_to(session, user.id, now)
    made = _add(session, Invitation(kind="reset", name=user.name, user_id=user.id), now, actor, lifetime)
    record_account_event(session, "invitation.created", now, actor, invitation=made.id, kind="reset", name=user.name)
    return made


def list_invitations(session: Session) -> Sequence[Invitation]:
    """Return the latest invitations and links, those that are over too, the latest first."""
    return session.scalars(select(Invitation).order_by(Invitation.id.desc()).limit(MOST_LISTED)).all()


def revoke_invitation(session: Session, invitation_id: int, now: datetime, actor: Actor) -> None:
    """End an invitation or link that nobody has used.

    Raises:
        NotFound: When there is none of that id, or it is over.
    """
    ended = update(Invitation).where(Invitation.id == invitation_id, _is_good(now)).values(revoked_at=now)
    if session.scalars(ended.returning(Invitation.id)).one_or_none() is None:
        raise NotFound(f"there is no invitation {invitation_id}", hint="it may be used, expired or revoked already")
    record_account_event(session, "invitation.revoked", now, actor, invitation=invitation_id)


def look_at(session: Session, text: str, now: datetime) -> InvitationView:
    """Return what an invitation is for.

    Raises:
        NotFound: When it is unknown, expired, used or revoked; which of these, isn't told.
    """
    row = session.scalars(select(Invitation).where(Invitation.sha256 == hash_of(text), _is_good(now))).one_or_none()
    if row is None:
        raise no_such_invitation()
    if row.kind == "join":
        return InvitationView("join", cast("Role", row.role), row.name, row.expires_at)
    user = None if row.user_id is None else session.get(User, row.user_id)
    if user is None or user.disabled_at is not None:
        raise no_such_invitation()
    return InvitationView("reset", cast("Role", user.role), user.name, row.expires_at)


def name_on(view: InvitationView, given: str | None) -> str:
    """Return the name of the account that an invitation leads to.

    Args:
        view: What the invitation says.
        given: What its holder chose; ``None`` where they had no choice.

    Raises:
        InvalidInput: When a name is lacking, can't be one, or isn't the invitation's.
    """
    if view.name is None:
        if given is None:
            raise InvalidInput("the account needs a name", where="name")
        return checked_account_name(given)
    if given is not None and checked_account_name(given) != view.name:
        raise InvalidInput(f"the invitation is for {view.name}", where="name", expected=view.name)
    return view.name


def take(session: Session, text: str, now: datetime, *, by: str, address: str | None) -> Invitation:
    """Use an invitation up; of several who do so at the same moment one succeeds.

    Args:
        session: A writing session.
        text: Its secret.
        now: When.
        by: Name of the account that it leads to.
        address: Where they ask from.

    Raises:
        NotFound: When it is unknown, expired, used or revoked; which of these, isn't told.
    """
    used = update(Invitation).where(Invitation.sha256 == hash_of(text), _is_good(now)).values(used_at=now)
    row = session.scalars(used.returning(Invitation), execution_options={"populate_existing": True}).one_or_none()
    if row is None:
        raise no_such_invitation()
    actor = Actor(by, address)
    record_account_event(session, "invitation.used", now, actor, invitation=row.id, kind=row.kind)
    return row


def invitation_address(base: str, text: str) -> str:
    """Return the address of the page where an invitation is used.

    Args:
        base: Of the server, ``https://lines.example.org``.
        text: The invitation's secret: a fragment, which no browser sends and so no log tells.
    """
    return f"{base.rstrip('/')}/invitation#{text}"


def no_such_invitation() -> NotFound:
    """Return the error of an invitation that isn't good, for whatever reason."""
    return NotFound(
        "this link is not good (any more)",
        expected="one that is new, and that nobody has used",
        hint="ask whoever sent it for another one",
    )


def _add(session: Session, row: Invitation, now: datetime, actor: Actor, lifetime: timedelta) -> NewInvitation:
    if not timedelta(0) < lifetime <= LONGEST:
        raise InvalidInput("no invitation is good for so long", where="days", expected=f"up to {LONGEST.days} days")
    text = secrets.token_urlsafe(RANDOM_BYTES)
    row.sha256 = hash_of(text)
    row.created_by = actor.person
    row.created_at = now
    row.expires_at = now + lifetime
    session.add(row)
    session.flush()
    return NewInvitation(text, row.id, row.expires_at)


def _is_good(now: datetime) -> ColumnElement[bool]:
    return and_(Invitation.used_at.is_(None), Invitation.revoked_at.is_(None), Invitation.expires_at > now)
