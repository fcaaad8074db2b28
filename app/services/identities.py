"""Accounts of those whom a provider has identified. An email alone never leads to an account: a subject does."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from datetime import datetime

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import Identity, User
from app.errors import Conflict, Forbidden, InvalidInput, NotFound, NotInvited
from app.openid.identified import Identified
from app.services.account_names import checked_account_name, require_free_name
from app.services.accounts import add_account, checked_email, get_account
from app.services.entering import Entrance
from app.services.events import Actor, record_account_event
from app.services.invitations import look_at, take
from app.services.people import PERSON_LENGTH
from app.services.web_sessions import NewSession, start_session

NAMELESS = "newcomer"
MOST_NUMBERS = 1000


def enter_identified(
    entrance: Entrance,
    found: Identified,
    *,
    role: str | None,
    invitation: str | None = None,
    reserved: Collection[str] = (),
) -> tuple[User, NewSession]:
    """Sign in whom a provider has identified, and make an account where there is none.

    Args:
        entrance: What everybody who comes in passes.
        found: Who it is.
        role: Of those who come for the first time, without an invitation; ``None`` lets none of them in.
        invitation: Secret of the one that they follow.
        reserved: Names that nobody may choose.

    Raises:
        Forbidden: When they have no account and may not make one, or theirs is disabled.
        NotFound: When the invitation isn't good (any more).
        Conflict: When the invitation's name was taken meanwhile.
    """
    now = entrance.now
    with entrance.database.write() as session:
        user = user_of(session, found)
        if user is None:
            user = _newcomer(session, entrance, found, role=role, invitation=invitation, reserved=reserved)
            _link(session, user, found, now)
        if user.disabled_at is not None:
            raise Forbidden("the account is disabled", hint="ask an admin")
        return user, start_session(session, user, now, entrance.rules, entrance.browser)


def link_identified(session: Session, user_id: int, found: Identified, now: datetime, actor: Actor) -> User:
    """Let whom a provider has identified sign in to an account that they are signed in to.

    Args:
        session: A writing session.
        user_id: The account.
        found: Who it is.
        now: When.
        actor: Who asks; the account's name is theirs.

    Raises:
        Conflict: When another account is theirs, or the account is somebody else's there.
        Forbidden: When the account is disabled.
    """
    user = get_account(session, user_id, lock=True)
    if user.disabled_at is not None:
        raise Forbidden("the account is disabled", hint="ask an admin")
    known = user_of(session, found)
    if known is not None and known.id != user.id:
        raise Conflict("whom the provider names has another account here", hint="sign out, and in with the provider")
    if known is None:
        _link(session, user, found, now)
        record_account_event(session, "user.linked", now, Actor(user.name, actor.address), issuer=found.issuer)
    return user


def user_of(session: Session, found: Identified) -> User | None:
    """Return whose account it is; ``None`` where there is none."""
    return session.scalars(
        select(User)
        .join(Identity, Identity.user_id == User.id)
        .where(Identity.issuer == found.issuer, Identity.subject == found.subject)
    ).one_or_none()


def list_identities(session: Session, user_id: int) -> Sequence[Identity]:
    """Return by whom somebody is identified, the first that was linked before the others."""
    return session.scalars(select(Identity).where(Identity.user_id == user_id).order_by(Identity.id)).all()


def unlink_identity(session: Session, user_id: int, identity_id: int, now: datetime, actor: Actor) -> None:
    """Forget a provider's word for somebody, who signs in without it from then on; their sessions go on.

    Args:
        session: A writing session.
        user_id: Whose it must be.
        identity_id: Which.
        now: When.
        actor: Who asks.

    Raises:
        NotFound: When they have no such one, or not any more.
        Conflict: When they have neither a password nor another one: nobody could sign in to the account any more.
    """
    user = get_account(session, user_id, lock=True)
    linked = list_identities(session, user_id)
    identity = next((each for each in linked if each.id == identity_id), None)
    if identity is None:
        raise NotFound(f"no provider is linked as {identity_id}", hint="it may be unlinked already")
    if user.password_hash is None and len(linked) == 1:
        raise Conflict("it is the only way to sign in to this account", hint="choose a password first")
    session.delete(identity)
    session.flush()
    record_account_event(session, "user.unlinked", now, Actor(user.name, actor.address), issuer=identity.issuer)


def _link(session: Session, user: User, found: Identified, now: datetime) -> None:
    session.add(Identity(user_id=user.id, issuer=found.issuer, subject=found.subject, created_at=now))
    session.flush()


def _newcomer(
    session: Session,
    entrance: Entrance,
    found: Identified,
    *,
    role: str | None,
    invitation: str | None,
    reserved: Collection[str],
) -> User:
    now, address = entrance.now, entrance.browser.address
    if invitation is None:
        if role is None:
            raise NotInvited("nobody here knows you yet", hint="ask for an invitation, and sign in by its link")
        name = free_name(session, found.name, reserved)
        return _made(session, found, name, role, now, Actor(name, address))
    view = look_at(session, invitation, now)
    if view.kind != "join":
        raise InvalidInput("this link chooses a password", hint="open it, and choose one")
    name = view.name or free_name(session, found.name, reserved)
    row = take(session, invitation, now, by=name, address=address)
    user = _made(session, found, name, row.role or "reader", now, Actor(name, address))
    user.created_by = row.created_by
    row.user_id = user.id
    return user


def _made(session: Session, found: Identified, name: str, role: str, now: datetime, actor: Actor) -> User:
    try:
        email = checked_email(found.email)
    except InvalidInput:
        email = None
    return add_account(session, name, role, now, actor, email=email)


def free_name(session: Session, wanted: str | None, reserved: Collection[str]) -> str:
    """Return a name that nobody has: the one that is wanted, with a number where it is taken.

    Raises:
        Conflict: When all of these are taken too.
    """
    try:
        base = checked_account_name((wanted or "")[: PERSON_LENGTH - 5])
    except InvalidInput:
        base = NAMELESS
    for number in range(1, MOST_NUMBERS):
        name = base if number == 1 else f"{base} {number}"
        try:
            require_free_name(session, name, chosen=True, reserved=reserved)
        except Conflict:
            continue
        return name
    raise Conflict(f"the name {base} is taken", where="name", hint="ask for an invitation with another one")
