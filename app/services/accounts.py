"""Accounts: who has one, what they may do, and whether they still may."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from datetime import datetime

from sqlalchemy import ColumnElement, and_, select, update
from sqlalchemy.orm import Session

from app.db.models import Token, User
from app.errors import Conflict, InvalidInput, NotFound
from app.services.access import checked_role
from app.services.account_names import checked_account_name, name_key, require_free_name, typed_key
from app.services.events import Actor, record_account_event
from app.services.link_revoking import revoke_links_by, revoke_links_to
from app.services.web_sessions import end_sessions

EMAIL_LENGTH = 320


def has_admin(session: Session) -> bool:
    """Whether anybody can look after the server: an admin whose account isn't disabled."""
    return session.scalar(select(User.id).where(_is_living_admin()).limit(1)) is not None


def add_account(
    session: Session,
    name: str,
    role: str,
    now: datetime,
    actor: Actor,
    *,
    email: str | None = None,
    password_hash: str | None = None,
    chosen: bool = False,
    reserved: Collection[str] = (),
) -> User:
    """Make an account.

    Args:
        session: A writing session.
        name: What its holder does is stored under it; it is never given again.
        role: One of ``ROLES``.
        now: When.
        actor: Who makes it.
        email: Where its holder can be reached; only they and admins see it.
        password_hash: From `Passwords.hash_of`; ``None`` where they sign in through a provider, or choose one later.
        chosen: Whether its holder chose the name, and nobody else has looked at it.
        reserved: Names that nobody may choose.

    Raises:
        InvalidInput: When name, role or email can't be.
        Conflict: When the name is or was somebody's.
    """
    name = checked_account_name(name)
    role = checked_role(role)
    require_free_name(session, name, chosen=chosen, reserved=reserved)
    user = User(
        name=name,
        name_key=name_key(name),
        email=checked_email(email),
        role=role,
        password_hash=password_hash,
        created_at=now,
        created_by=actor.person,
    )
    session.add(user)
    session.flush()
    record_account_event(session, "user.created", now, actor, name=name, role=role)
    return user


def list_accounts(session: Session) -> Sequence[User]:
    """Return all accounts, disabled ones too, by name."""
    return session.scalars(select(User).order_by(User.name_key)).all()


def get_account(session: Session, user_id: int, *, lock: bool = False) -> User:
    """Return an account.

    Args:
        session: Any session.
        user_id: Its id.
        lock: Whether to hold its row; needs a writing session.

    Raises:
        NotFound: When there is none.
    """
    user = session.get(User, user_id, with_for_update=lock, populate_existing=lock)
    if user is None:
        raise NotFound(f"there is no account {user_id}")
    return user


def find_account(session: Session, name: str) -> User | None:
    """Return the account of a name, whatever its case; ``None`` if there is none."""
    if not name.isprintable():  # no database takes all of these characters, and no name has any
        return None
    return session.scalars(select(User).where(User.name_key == typed_key(name))).one_or_none()


def account_named(session: Session, name: str) -> User:
    """Return the account of a name.

    Raises:
        NotFound: When there is none.
    """
    user = find_account(session, name)
    if user is None:
        raise NotFound(f"there is no account named {name:.80}", hint="clearlines user list shows them")
    return user


def change_role(session: Session, user_id: int, role: str, now: datetime, actor: Actor) -> User:
    """Give an account another role, which counts from its next request on; links that a former admin made end.

    Raises:
        NotFound: When there is no such account.
        InvalidInput: When there is no such role.
        Conflict: When nobody would be left to look after the server.
    """
    role = checked_role(role)
    if role != "admin":
        _require_other_admin(session, user_id)
    user = get_account(session, user_id, lock=True)
    if user.role != role:
        record_account_event(session, "user.role_changed", now, actor, name=user.name, before=user.role, role=role)
        if user.role == "admin":
            revoke_links_by(session, user.name, now)
        user.role = role
        session.flush()
    return user


def disable_account(session: Session, user_id: int, now: datetime, actor: Actor) -> User:
    """Shut an account: sessions, tokens, and links to it and by it end at once, for good. What was done stays.

    Raises:
        NotFound: When there is no such account.
        Conflict: When nobody would be left to look after the server.
    """
    _require_other_admin(session, user_id)
    user = get_account(session, user_id, lock=True)
    if user.disabled_at is None:
        user.disabled_at = now
        session.flush()
        end_sessions(session, user.id, now)
        session.execute(
            update(Token).where(Token.user_id == user.id, Token.revoked_at.is_(None)).values(revoked_at=now)
        )
        revoke_links_to(session, user.id, now)
        revoke_links_by(session, user.name, now)
        record_account_event(session, "user.disabled", now, actor, name=user.name)
    return user


def enable_account(session: Session, user_id: int, now: datetime, actor: Actor) -> User:
    """Open an account again; its holder signs in anew, and makes new tokens.

    Raises:
        NotFound: When there is no such account.
    """
    user = get_account(session, user_id, lock=True)
    if user.disabled_at is not None:
        user.disabled_at = None
        session.flush()
        record_account_event(session, "user.enabled", now, actor, name=user.name)
    return user


def change_email(session: Session, user_id: int, email: str | None, now: datetime, actor: Actor) -> User:
    """Store where somebody can be reached; ``None`` or nothing forgets it.

    Raises:
        NotFound: When there is no such account.
        InvalidInput: When it is no address.
    """
    email = checked_email(email)
    user = get_account(session, user_id, lock=True)
    if user.email != email:
        user.email = email
        session.flush()
        record_account_event(session, "user.email_changed", now, actor, name=user.name)
    return user


def change_password(
    session: Session, user: User, password_hash: str, now: datetime, actor: Actor, *, kind: str, keep: int | None = None
) -> None:
    """Store a new password, which ends all sessions but one, and all links that would choose another.

    Args:
        session: A writing session.
        user: Whose it is.
        password_hash: From `Passwords.hash_of`.
        now: When.
        actor: Who does it.
        kind: For the audit: ``user.password_changed`` by its holder, ``user.password_reset`` through a link.
        keep: The session that stays.
    """
    user.password_hash = password_hash
    session.flush()
    ended = end_sessions(session, user.id, now, but=keep)
    revoke_links_to(session, user.id, now)
    record_account_event(session, kind, now, actor, name=user.name, sessions_ended=ended)


def checked_email(email: str | None) -> str | None:
    """Return an address of mail, or ``None`` for an empty one; whether it exists isn't asked.

    Raises:
        InvalidInput: When it can't be one.
    """
    email = (email or "").strip() or None
    if email is None:
        return None
    local, _, host = email.rpartition("@")
    if not local or not host or len(email) > EMAIL_LENGTH or not email.isprintable() or " " in email:
        raise InvalidInput("this is no address of mail", where="email", expected="NAME@HOST")
    return email


def _require_other_admin(session: Session, user_id: int) -> None:
    """Refuse what would leave nobody to look after the server; holds all admins, so that two can't do it at once."""
    admins = session.scalars(select(User.id).where(_is_living_admin()).order_by(User.id).with_for_update()).all()
    if list(admins) == [user_id]:
        raise Conflict(
            "this is the last admin",
            where="role",
            hint="make somebody else an admin first: clearlines user create NAME --role admin",
        )


def _is_living_admin() -> ColumnElement[bool]:
    return and_(User.role == "admin", User.disabled_at.is_(None))
