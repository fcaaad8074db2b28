"""Signing in with a name and a password."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from datetime import datetime

import pytest
from argon2 import PasswordHasher
from sqlalchemy import select

from app.db.models import Event, User, WebSession
from app.db.session import Database
from app.errors import Unauthenticated
from app.services.accounts import change_password, disable_account, get_account
from app.services.entering import Entrance, sign_in
from app.services.events import Actor
from app.services.passwords import Passwords
from app.services.web_sessions import Browser, SessionRules

Add = Callable[..., User]
PASSWORD = "seven grey herons"


@pytest.fixture
def entrance(sqlite_database: Database, cheap: Passwords, rules: SessionRules, now: datetime) -> Entrance:
    return Entrance(sqlite_database, cheap, rules, Browser("192.0.2.9", "Firefox"), now)


def test_the_right_password_opens_whatever_the_name_s_case(entrance: Entrance, add: Add) -> None:
    ada = add(entrance.database, "Ada Lovelace")
    for name in ("Ada Lovelace", "ada lovelace", " ADA LOVELACE"):
        user, made = sign_in(entrance, name, PASSWORD)
        assert user.id == made.row.user_id == ada.id
    with entrance.database.read() as session:
        rows = session.scalars(select(WebSession)).all()
    assert {(row.address, row.agent) for row in rows} == {("192.0.2.9", "Firefox")}
    assert len({row.sha256 for row in rows}) == 3


def test_failures_of_every_kind_say_the_same(entrance: Entrance, add: Add, now: datetime, actor: Actor) -> None:
    add(entrance.database, "rita", "admin")
    add(entrance.database, "ada")
    add(entrance.database, "otto", password_hash=None)
    gone = add(entrance.database, "gone")
    with entrance.database.write() as session:
        disable_account(session, gone.id, now, actor)
    said = set()
    for name, password in (
        ("nobody", PASSWORD),
        ("ada", "wrong"),
        ("ada", ""),
        ("otto", PASSWORD),
        ("otto", ""),
        ("gone", PASSWORD),
        ("\0", PASSWORD),
        ("x" * 5_000, "x" * 5_000),
    ):
        with pytest.raises(Unauthenticated) as caught:
            sign_in(entrance, name, password)
        said.add(str(caught.value.as_dict()))
    assert len(said) == 1
    with entrance.database.read() as session:
        failed = session.scalars(select(Event).where(Event.kind == "session.failed").order_by(Event.id)).all()
        assert not session.scalars(select(WebSession)).all()
    assert {(event.person, event.address) for event in failed} == {(None, "192.0.2.9")}
    names = [event.details.get("name") for event in failed]
    assert names == [None, "ada", "ada", "otto", "otto", "gone", None, None]  # what nobody is called, is told nowhere


def test_a_hash_of_an_earlier_cost_is_made_anew(entrance: Entrance, add: Add) -> None:
    ada = add(entrance.database, "ada")
    dearer = Passwords(PasswordHasher(time_cost=2, memory_cost=16, parallelism=1))
    sign_in(replace(entrance, passwords=dearer), "ada", PASSWORD)
    with entrance.database.read() as session:
        stored = session.get_one(User, ada.id).password_hash
    assert stored is not None
    assert stored != ada.password_hash
    assert not dearer.is_outdated(stored)
    assert sign_in(entrance, "ada", PASSWORD)[0].id == ada.id


def test_a_password_that_is_changed_while_it_is_compared_opens_nothing(
    entrance: Entrance, add: Add, now: datetime, actor: Actor
) -> None:
    ada = add(entrance.database, "ada")

    class Slow(Passwords):
        def is_right(self, password: str, stored: str | None) -> bool:
            with entrance.database.write() as session:
                user = get_account(session, ada.id)
                change_password(session, user, "another hash", now, actor, kind="user.password_reset")
            return True

        def is_outdated(self, stored: str) -> bool:
            return False

    with pytest.raises(Unauthenticated):
        sign_in(replace(entrance, passwords=Slow()), "ada", PASSWORD)
    with entrance.database.read() as session:
        assert not session.scalars(select(WebSession)).all()
