"""Links end with the trust in who made them."""

from __future__ import annotations

from collections.abc import Callable
from datetime import datetime, timedelta

import pytest
from sqlalchemy.orm import Session

from app.db.models import User
from app.db.session import Database
from app.errors import NotFound
from app.services.account_tokens import end_token
from app.services.accounts import change_role, disable_account
from app.services.events import Actor
from app.services.invitations import invite, look_at, offer_reset
from app.services.tokens import create_token, list_tokens, revoke_token

Add = Callable[..., User]
End = Callable[[Session, User], object]
DAY = timedelta(days=1)
NOBODY = Actor(None)


def is_good(database: Database, text: str, now: datetime) -> bool:
    with database.read() as session:
        try:
            look_at(session, text, now)
        except NotFound:
            return False
    return True


def links_by(database: Database, name: str, user_id: int, now: datetime) -> list[str]:
    """Have somebody invite an admin, and offer a new password for an account."""
    actor = Actor(name)
    with database.write() as session:
        invited = invite(session, "admin", now, actor, lifetime=DAY)
        return [invited.text, offer_reset(session, user_id, now, actor, lifetime=DAY).text]


def test_who_is_disabled_or_lowered_leaves_no_link_behind(database: Database, add: Add, now: datetime) -> None:
    ends: tuple[End, ...] = (
        lambda session, user: disable_account(session, user.id, now, NOBODY),
        lambda session, user: change_role(session, user.id, "reader", now, NOBODY),
    )
    ada = add(database, "Ada", "admin")
    for number, end in enumerate(ends):
        gone = add(database, f"Bob {number}", "admin")
        (kept,) = links_by(database, "Ada", gone.id, now)[:1]
        made = links_by(database, gone.name, ada.id, now)
        assert all(is_good(database, text, now) for text in made)
        with database.write() as session:
            end(session, gone)
        assert not any(is_good(database, text, now) for text in made)
        assert is_good(database, kept, now)


def test_a_change_of_role_that_leaves_an_admin_one_ends_nothing(database: Database, add: Add, now: datetime) -> None:
    ada = add(database, "Ada", "admin")
    made = links_by(database, "Ada", ada.id, now)
    with database.write() as session:
        change_role(session, ada.id, "admin", now, NOBODY)
    assert all(is_good(database, text, now) for text in made)


@pytest.mark.parametrize("by_id", [False, True])
def test_with_a_service_s_token_its_links_end(sqlite_database: Database, add: Add, now: datetime, by_id: bool) -> None:
    database = sqlite_database
    ada = add(database, "Ada", "admin")
    with database.write() as session:
        create_token(session, "robot", "admin", now, person=None)
    made = links_by(database, "robot", ada.id, now)
    with database.write() as session:
        if by_id:
            end_token(session, list_tokens(session)[0].id, now, NOBODY)
        else:
            revoke_token(session, "robot", now, person=None)
    assert not any(is_good(database, text, now) for text in made)
