"""Accounts: names, roles, the last admin, and what ends with them."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from datetime import datetime, timedelta
from threading import Barrier

import pytest
from sqlalchemy import select

from app.db.models import Event, Method, Token, User, WebSession
from app.db.session import Database
from app.errors import Conflict, InvalidInput, NotFound, Unauthenticated
from app.services.account_names import name_key, require_free_name
from app.services.account_tokens import make_own_token
from app.services.accounts import (
    account_named,
    change_email,
    change_password,
    change_role,
    disable_account,
    enable_account,
    find_account,
    has_admin,
    list_accounts,
)
from app.services.events import Actor
from app.services.invitations import look_at, offer_reset
from app.services.tokens import create_token, revoke_token, token_of
from app.services.web_sessions import Browser, SessionRules, session_of, start_session

Add = Callable[..., User]
DAY = timedelta(days=1)


def test_names_are_one_s_own_whatever_their_case(database: Database, add: Add) -> None:
    ada = add(database, "  Ada  Lovelace ")
    assert (ada.name, ada.name_key) == ("Ada Lovelace", "ada lovelace")
    for other in ("ada lovelace", "ADA LOVELACE", "Ａda Lovelace"):
        with pytest.raises(Conflict):
            add(database, other)
    with database.read() as session:
        for typed in ("ada LOVELACE", " Ada Lovelace "):
            found = find_account(session, typed)
            assert found is not None
            assert found.id == ada.id
        assert find_account(session, "bob") is None
        with pytest.raises(NotFound):
            account_named(session, "bob")


@pytest.mark.parametrize("name", ["", " ", "a\nb", "a\u200bb", "x" * 81, "\ufdfa" * 40])
def test_what_can_t_be_a_name(sqlite_database: Database, add: Add, name: str) -> None:
    with pytest.raises(InvalidInput):
        add(sqlite_database, name)


@pytest.mark.parametrize("given", [{"role": "king"}, {"email": "nobody"}, {"email": "a b@example.org"}])
def test_what_can_t_be_an_account(sqlite_database: Database, add: Add, given: dict[str, str]) -> None:
    with pytest.raises(InvalidInput):
        add(sqlite_database, "ada", **given)


def test_no_name_is_given_twice_not_even_a_service_s(
    sqlite_database: Database, add: Add, now: datetime, actor: Actor
) -> None:
    add(sqlite_database, "rita", "admin")
    gone = add(sqlite_database, "ada")
    with sqlite_database.write() as session:
        disable_account(session, gone.id, now, actor)
        create_token(session, "Robot", "submitter", now, person=None)
        revoke_token(session, "Robot", now, person=None)
        with pytest.raises(Conflict):
            create_token(session, "ADA", "submitter", now, person=None)
    for taken in ("ada", "robot"):
        with pytest.raises(Conflict):
            add(sqlite_database, taken)


def test_a_name_that_stands_on_a_method_is_given_by_an_admin_and_taken_by_nobody(
    sqlite_database: Database, add: Add, now: datetime
) -> None:
    with sqlite_database.write() as session:
        session.add(Method(slug="edges", name="Edges", owner="Ada", created_at=now))
    with sqlite_database.read() as session:
        for name in ("ada", "Owner"):
            with pytest.raises(Conflict):
                require_free_name(session, name, chosen=True, reserved=["owner"])
    assert add(sqlite_database, "ada").name == "ada"


def test_disabling_ends_sessions_tokens_and_links_for_good(
    database: Database, add: Add, now: datetime, actor: Actor, rules: SessionRules
) -> None:
    add(database, "rita", "admin")
    ada = add(database, "ada")
    with database.write() as session:
        browser = start_session(session, account_named(session, "ada"), now, rules, Browser())
        _, text = make_own_token(session, ada.id, "cluster", now, actor)
        link = offer_reset(session, ada.id, now, actor, lifetime=DAY)
        assert token_of(session, text, now)[0].label == "cluster"
        assert look_at(session, link.text, now).kind == "reset"
    with database.write() as session:
        disable_account(session, ada.id, now, actor)
        with pytest.raises(Conflict):
            offer_reset(session, ada.id, now, actor, lifetime=DAY)
        with pytest.raises(Conflict):
            make_own_token(session, ada.id, "later", now, actor)
    for _ in range(2):  # disabled, then enabled again
        with database.read() as session:
            with pytest.raises(Unauthenticated):
                session_of(session, browser.text, now, rules)
            with pytest.raises(Unauthenticated):
                token_of(session, text, now)
            with pytest.raises(NotFound):
                look_at(session, link.text, now)
        with database.write() as session:
            enable_account(session, ada.id, now, actor)


def test_the_last_admin_stays_one(database: Database, add: Add, now: datetime, actor: Actor) -> None:
    with database.read() as session:
        assert not has_admin(session)
    rita = add(database, "rita", "admin")
    with database.write() as session:
        assert has_admin(session)
        with pytest.raises(Conflict):
            change_role(session, rita.id, "maintainer", now, actor)
        with pytest.raises(Conflict):
            disable_account(session, rita.id, now, actor)
        assert change_role(session, rita.id, "admin", now, actor).role == "admin"
    ada = add(database, "ada", "admin")
    with database.write() as session:
        disable_account(session, rita.id, now, actor)
        with pytest.raises(Conflict):
            change_role(session, ada.id, "reader", now, actor)
        change_role(session, rita.id, "reader", now, actor)  # she couldn't look after anything anyway
        assert has_admin(session)


def test_of_two_admins_who_lower_each_other_one_stays(
    database: Database, add: Add, now: datetime, actor: Actor
) -> None:
    ids = [add(database, name, "admin").id for name in ("rita", "ada")]
    start = Barrier(2)

    def lower(user_id: int) -> bool:
        start.wait(20)
        try:
            with database.write() as session:
                change_role(session, user_id, "reader", now, actor)
        except Conflict:
            return False
        return True

    with ThreadPoolExecutor(2) as pool:
        done = list(pool.map(lower, ids))
    assert sorted(done) == [False, True]
    with database.read() as session:
        assert has_admin(session)


def test_a_new_password_ends_the_other_sessions(
    sqlite_database: Database, add: Add, now: datetime, actor: Actor, rules: SessionRules
) -> None:
    ada = add(sqlite_database, "ada")
    with sqlite_database.write() as session:
        user = account_named(session, "ada")
        here, there = (start_session(session, user, now, rules, Browser()) for _ in range(2))
        link = offer_reset(session, ada.id, now, actor, lifetime=DAY)
        change_password(session, user, "hash", now, actor, kind="user.password_changed", keep=here.row.id)
    with sqlite_database.read() as session:
        assert session_of(session, here.text, now, rules)[1].id == ada.id
        with pytest.raises(Unauthenticated):
            session_of(session, there.text, now, rules)
        with pytest.raises(NotFound):
            look_at(session, link.text, now)


def test_what_is_done_to_accounts_is_told_without_anything_secret(
    sqlite_database: Database, add: Add, now: datetime, actor: Actor, rules: SessionRules
) -> None:
    rita, ada = add(sqlite_database, "rita", "admin"), add(sqlite_database, "ada", email="ada@example.org")
    with sqlite_database.write() as session:
        change_role(session, ada.id, "maintainer", now, actor)
        change_role(session, ada.id, "maintainer", now, actor)  # nothing is told of what changes nothing
        change_email(session, ada.id, "ada@example.com", now, actor)
        made = start_session(session, account_named(session, "ada"), now, rules, Browser("192.0.2.9"))
        _, text = make_own_token(session, ada.id, "cluster", now, actor)
        link = offer_reset(session, ada.id, now, actor, lifetime=DAY)
        disable_account(session, ada.id, now, actor)
        enable_account(session, ada.id, now, actor)
    with sqlite_database.read() as session:
        told = [(event.kind, event.person, event.address) for event in session.scalars(select(Event))]
        whole = str([event.details for event in session.scalars(select(Event))])
        assert [user.name for user in list_accounts(session)] == ["ada", "rita"]
        assert {row.sha256 for row in session.scalars(select(WebSession))}.isdisjoint({made.text})
        assert {row.sha256 for row in session.scalars(select(Token))}.isdisjoint({text})
    by_rita = ("rita", "192.0.2.7")
    assert told == [
        ("user.created", *by_rita),
        ("user.created", *by_rita),
        ("user.role_changed", *by_rita),
        ("user.email_changed", *by_rita),
        ("session.started", "ada", "192.0.2.9"),
        ("token.created", *by_rita),
        ("invitation.created", *by_rita),
        ("user.disabled", *by_rita),
        ("user.enabled", *by_rita),
    ]
    secrets = (made.text, text, link.text, str(rita.password_hash), "example.com")
    assert not any(secret in whole for secret in secrets)


def test_keys_of_names_are_stable() -> None:
    assert name_key("STRASSE") == name_key("Straße") == name_key(name_key("straße"))
