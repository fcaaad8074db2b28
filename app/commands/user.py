"""``clearlines user``: the accounts of a server, looked after at its machine."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime, timedelta
from typing import TYPE_CHECKING

from rich.console import Console
from rich.table import Table

from app.clock import utc_now
from app.commands.stores import opened_stores
from app.services import accounts
from app.services.access import checked_role
from app.services.account_names import checked_account_name, require_free_name
from app.services.events import Actor
from app.services.invitations import NewInvitation, invitation_address, invite, offer_reset
from app.services.passwords import Passwords, checked_password
from app.settings import Settings

if TYPE_CHECKING:
    from app.db.models import User

WILDCARDS = frozenset({"0.0.0.0", "::", "[::]"})  # noqa: S104


def require_possible(settings: Settings, name: str, role: str, email: str | None) -> None:
    """Refuse what can't be an account before anybody types a password for it.

    Raises:
        InvalidInput: When name, role or email can't be.
        Conflict: When the name is or was somebody's.
    """
    checked_role(role)
    accounts.checked_email(email)
    with opened_stores(settings) as (database, _), database.read() as session:
        require_free_name(session, checked_account_name(name), chosen=False)


def make_user(settings: Settings, name: str, role: str, *, email: str | None, password: str) -> User:
    """Make an account with a password; a server at work knows it at once.

    Raises:
        ClearLinesError: As `app.services.accounts.add_account` and `app.services.passwords.checked_password`.
    """
    password_hash = Passwords().hash_of(checked_password(password, name))
    with opened_stores(settings) as (database, _), database.write() as session:
        return accounts.add_account(
            session, name, role, utc_now(), _actor(settings), email=email, password_hash=password_hash
        )


def make_user_with_link(settings: Settings, name: str, role: str, *, email: str | None) -> tuple[User, str]:
    """Make an account without a password, and return it with the link by which its holder chooses one.

    Raises:
        ClearLinesError: As `app.services.accounts.add_account`.
    """
    now, actor = utc_now(), _actor(settings)
    with opened_stores(settings) as (database, _), database.write() as session:
        user = accounts.add_account(session, name, role, now, actor, email=email)
        made = offer_reset(session, user.id, now, actor, lifetime=_lifetime(settings, None))
    return user, _link(settings, made)


def make_reset_link(settings: Settings, name: str) -> str:
    """Return a link by which the holder of an account chooses a new password.

    Raises:
        NotFound: When there is no account of the name.
        Conflict: When it is disabled.
    """
    with opened_stores(settings) as (database, _), database.write() as session:
        user = accounts.account_named(session, name)
        made = offer_reset(session, user.id, utc_now(), _actor(settings), lifetime=_lifetime(settings, None))
    return _link(settings, made)


def make_invitation(settings: Settings, role: str, *, name: str | None, days: float | None) -> str:
    """Return a link that makes an account.

    Raises:
        ClearLinesError: As `app.services.invitations.invite`.
    """
    with opened_stores(settings) as (database, _), database.write() as session:
        made = invite(session, role, utc_now(), _actor(settings), lifetime=_lifetime(settings, days), name=name)
    return _link(settings, made)


def give_role(settings: Settings, name: str, role: str) -> None:
    """Give an account another role.

    Raises:
        ClearLinesError: As `app.services.accounts.change_role`.
    """
    with opened_stores(settings) as (database, _), database.write() as session:
        user = accounts.account_named(session, name)
        accounts.change_role(session, user.id, role, utc_now(), _actor(settings))


def switch_user(settings: Settings, name: str, *, disabled: bool) -> None:
    """Disable an account, or enable it again.

    Raises:
        ClearLinesError: As `app.services.accounts.disable_account`.
    """
    switch = accounts.disable_account if disabled else accounts.enable_account
    with opened_stores(settings) as (database, _), database.write() as session:
        switch(session, accounts.account_named(session, name).id, utc_now(), _actor(settings))


def print_users(settings: Settings, console: Console) -> None:
    """List all accounts: names, roles and times."""
    with opened_stores(settings) as (database, _), database.read() as session:
        users = accounts.list_accounts(session)
    if not users:
        console.print("there are no accounts; clearlines user create NAME --role admin makes one")
        return
    console.print(_table(users))


def server_address(settings: Settings) -> str:
    """Return where a server with these settings is found."""
    if settings.public_url is not None:
        return settings.public_url
    host = "localhost" if settings.host in WILDCARDS else settings.host
    return f"http://[{host.strip('[]')}]:{settings.port}" if ":" in host else f"http://{host}:{settings.port}"


def _link(settings: Settings, made: NewInvitation) -> str:
    return invitation_address(server_address(settings), made.text)


def _lifetime(settings: Settings, days: float | None) -> timedelta:
    return timedelta(days=settings.invitation_days if days is None else days)


def _actor(settings: Settings) -> Actor:
    return Actor(settings.person)


def _table(users: Sequence[User]) -> Table:
    table = Table(box=None, pad_edge=False)
    for column in ("name", "role", "state", "email", "made", "last seen"):
        table.add_column(column)
    for user in users:
        table.add_row(
            user.name, user.role, _state(user), user.email or "-", _day(user.created_at), _day(user.last_seen_at)
        )
    return table


def _state(user: User) -> str:
    if user.disabled_at is not None:
        return "disabled"
    return "good" if user.has_password else "no password"


def _day(time: datetime | None) -> str:
    return "-" if time is None else time.strftime("%Y-%m-%d")
