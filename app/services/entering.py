"""Ways into an account: with a name and a password, or with an invitation. Each ends with a session.

Hashing takes long, so it is done between the sessions of the database and never inside one.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from datetime import datetime

from app.db.models import User
from app.db.session import Database
from app.services.account_names import require_free_name
from app.services.accounts import add_account, change_password, find_account, get_account
from app.services.events import Actor, record_account_event
from app.services.invitations import look_at, name_on, no_such_invitation, take
from app.services.passwords import Passwords, checked_password, wrong_password
from app.services.web_sessions import Browser, NewSession, SessionRules, start_session


@dataclass(frozen=True)
class Entrance:
    """What everybody who comes in passes.

    Attributes:
        database: Where the accounts are.
        passwords: Compares and makes hashes.
        rules: How long a session is good.
        browser: Where they are.
        now: When.
    """

    database: Database
    passwords: Passwords
    rules: SessionRules
    browser: Browser
    now: datetime


def sign_in(entrance: Entrance, name: str, password: str) -> tuple[User, NewSession]:
    """Sign in with a name and a password.

    Raises:
        Unauthenticated: When the name is unknown, the password wrong or the account disabled; which of these, isn't
            told, and takes as long.
        Unavailable: When many others sign in.
    """
    with entrance.database.read() as session:
        user = find_account(session, name)
    stored = user.password_hash if user is not None and user.disabled_at is None else None
    is_right = entrance.passwords.is_right(password, stored)
    if user is None or stored is None or not is_right:
        _record_failure(entrance, user)
        raise wrong_password()
    renewed = entrance.passwords.hash_of(password) if entrance.passwords.is_outdated(stored) else stored
    with entrance.database.write() as session:
        user = get_account(session, user.id, lock=True)
        if user.disabled_at is not None or user.password_hash != stored:  # changed while this one was compared
            raise wrong_password()
        user.password_hash = renewed
        return user, start_session(session, user, entrance.now, entrance.rules, entrance.browser)


def accept(
    entrance: Entrance, text: str, name: str | None, password: str, *, reserved: Collection[str] = ()
) -> tuple[User, NewSession]:
    """Make the account that an invitation is for, or choose its new password, and sign in.

    Args:
        entrance: As above.
        text: The invitation's secret.
        name: What its holder wants to be called, where the invitation leaves it open.
        password: What they want to sign in with.
        reserved: Names that nobody may choose.

    Raises:
        NotFound: When the invitation isn't good (any more).
        InvalidInput: When name or password can't be.
        Conflict: When the name is or was somebody's.
        Unavailable: When many others sign in.
    """
    now, address = entrance.now, entrance.browser.address
    with entrance.database.read() as session:
        view = look_at(session, text, now)
        name = name_on(view, name)
        if view.kind == "join":  # said before anything is worked out; what counts is asked again below
            require_free_name(session, name, chosen=view.name is None, reserved=reserved)
    password_hash = entrance.passwords.hash_of(checked_password(password, name))
    with entrance.database.write() as session:
        row = take(session, text, now, by=name, address=address)
        actor = Actor(name, address)
        if row.kind == "join":
            user = add_account(
                session,
                name,
                row.role or "reader",
                now,
                actor,
                password_hash=password_hash,
                chosen=view.name is None,
                reserved=reserved,
            )
            user.created_by = row.created_by
            row.user_id = user.id
        else:
            user = get_account(session, row.user_id or 0, lock=True)
            if user.disabled_at is not None:
                raise no_such_invitation()
            change_password(session, user, password_hash, now, actor, kind="user.password_reset")
        return user, start_session(session, user, now, entrance.rules, entrance.browser)


def _record_failure(entrance: Entrance, user: User | None) -> None:
    """Tell the audit; of a name that is nobody's it is told nothing, since people type passwords there too."""
    name = {} if user is None else {"name": user.name}
    with entrance.database.write() as session:
        record_account_event(session, "session.failed", entrance.now, Actor(None, entrance.browser.address), **name)
