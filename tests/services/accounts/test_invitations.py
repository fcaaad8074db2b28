"""Links that make an account, or choose its password: once, while they are good."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from datetime import datetime, timedelta
from threading import Barrier

import pytest
from sqlalchemy import select

from app.db.models import Event, Invitation, Method, User, WebSession
from app.db.session import Database
from app.errors import ClearLinesError, Conflict, InvalidInput, NotFound, Unauthenticated
from app.services.accounts import account_named, disable_account
from app.services.entering import Entrance, accept, sign_in
from app.services.events import Actor
from app.services.invitations import (
    NewInvitation,
    invitation_address,
    invite,
    list_invitations,
    look_at,
    offer_reset,
    revoke_invitation,
)
from app.services.passwords import Passwords
from app.services.web_sessions import Browser, SessionRules, session_of, start_session

Add = Callable[..., User]
DAY = timedelta(days=1)
PASSWORD = "nine brown otters"


@pytest.fixture
def enter(cheap: Passwords, rules: SessionRules, now: datetime) -> Callable[[Database], Entrance]:
    return lambda database: Entrance(database, cheap, rules, Browser("192.0.2.9", "Firefox"), now)


def made(database: Database, now: datetime, actor: Actor, role: str = "annotator", **given: object) -> NewInvitation:
    name = given.get("name")
    with database.write() as session:
        return invite(session, role, now, actor, lifetime=DAY, name=None if name is None else str(name))


def test_an_invitation_makes_an_account_once_and_signs_in(
    database: Database, enter: Callable[[Database], Entrance], now: datetime, actor: Actor, rules: SessionRules
) -> None:
    invitation = made(database, now, actor)
    with database.read() as session:
        seen = look_at(session, invitation.text, now)
    assert (seen.kind, seen.role, seen.name, seen.expires_at) == ("join", "annotator", None, now + DAY)
    user, browser = accept(enter(database), invitation.text, " Ada ", PASSWORD)
    assert (user.name, user.role, user.created_by) == ("Ada", "annotator", "rita")
    with database.read() as session:
        assert session_of(session, browser.text, now, rules)[1].id == user.id
        assert [row.user_id for row in list_invitations(session)] == [user.id]
    assert sign_in(enter(database), "ada", PASSWORD)[0].id == user.id
    with pytest.raises(NotFound):
        accept(enter(database), invitation.text, "Bob", PASSWORD)
    with database.read() as session:
        told = [(event.kind, event.person) for event in session.scalars(select(Event).order_by(Event.id))]
        whole = str([event.details for event in session.scalars(select(Event))])
    assert told[:4] == [
        ("invitation.created", "rita"),
        ("invitation.used", "Ada"),
        ("user.created", "Ada"),
        ("session.started", "Ada"),
    ]
    assert invitation.text not in whole


def test_of_two_who_use_an_invitation_at_once_one_gets_the_account(
    database: Database, enter: Callable[[Database], Entrance], now: datetime, actor: Actor
) -> None:
    invitation = made(database, now, actor)
    start = Barrier(2)

    class Together(Passwords):
        def hash_of(self, password: str) -> str:
            start.wait(20)  # both have seen a good invitation
            return "hash of " + password

    entrance = replace(enter(database), passwords=Together())

    def use(name: str) -> str:
        try:
            return accept(entrance, invitation.text, name, PASSWORD)[0].name
        except ClearLinesError as error:
            return error.code

    with ThreadPoolExecutor(2) as pool:
        found = sorted(pool.map(use, ["Ada", "Bob"]))
    assert found in (["Ada", "not-found"], ["Bob", "not-found"])
    with database.read() as session:
        assert len(session.scalars(select(User)).all()) == 1


def test_of_two_who_choose_a_name_at_once_one_gets_it_and_the_other_may_choose_again(
    database: Database, enter: Callable[[Database], Entrance], now: datetime, actor: Actor
) -> None:
    texts = [made(database, now, actor).text for _ in range(2)]
    start = Barrier(2)

    class Together(Passwords):
        def hash_of(self, password: str) -> str:
            start.wait(20)
            return "hash of " + password

    entrance = replace(enter(database), passwords=Together())

    def use(text: str) -> str:
        try:
            return accept(entrance, text, "Ada", PASSWORD)[0].name
        except ClearLinesError as error:
            return error.code

    with ThreadPoolExecutor(2) as pool:
        assert sorted(pool.map(use, texts)) == ["Ada", "conflict"]
    with database.read() as session:
        left = session.scalars(select(Invitation).where(Invitation.used_at.is_(None))).all()
    assert len(left) == 1


def test_an_unknown_an_expired_a_revoked_and_a_used_one_answer_the_same(
    database: Database, enter: Callable[[Database], Entrance], now: datetime, actor: Actor
) -> None:
    expired, revoked, used = (made(database, now, actor) for _ in range(3))
    accept(enter(database), used.text, "Ada", PASSWORD)
    with database.write() as session:
        revoke_invitation(session, revoked.id, now, actor)
        with pytest.raises(NotFound):
            revoke_invitation(session, revoked.id, now, actor)
        with pytest.raises(NotFound):
            revoke_invitation(session, used.id, now, actor)
    later = replace(enter(database), now=now + DAY)
    answers = set()
    for text, entrance in (
        ("x", enter(database)),
        (expired.text, later),
        (revoked.text, enter(database)),
        (used.text, enter(database)),
    ):
        with database.read() as session, pytest.raises(NotFound) as looked:
            look_at(session, text, entrance.now)
        with pytest.raises(NotFound) as accepted:
            accept(entrance, text, "Bob", PASSWORD)
        answers |= {str(looked.value), str(accepted.value)}
    assert len(answers) == 1


def test_a_name_that_was_said_can_t_be_changed(
    sqlite_database: Database, enter: Callable[[Database], Entrance], now: datetime, actor: Actor
) -> None:
    invitation = made(sqlite_database, now, actor, name="Ada")
    with pytest.raises(InvalidInput):
        accept(enter(sqlite_database), invitation.text, "Bob", PASSWORD)
    assert accept(enter(sqlite_database), invitation.text, None, PASSWORD)[0].name == "Ada"
    with sqlite_database.write() as session, pytest.raises(Conflict):
        invite(session, "reader", now, actor, lifetime=DAY, name="ada")


def test_what_is_refused_leaves_the_invitation_as_good_as_before(
    sqlite_database: Database, enter: Callable[[Database], Entrance], add: Add, now: datetime, actor: Actor
) -> None:
    add(sqlite_database, "rita", "admin")
    with sqlite_database.write() as session:
        session.add(Method(slug="edges", name="Edges", owner="Eve", created_at=now))
    invitation = made(sqlite_database, now, actor)
    entrance = enter(sqlite_database)
    for name, password, error in (
        (None, PASSWORD, InvalidInput),
        ("\n", PASSWORD, InvalidInput),
        ("Bob", "short", InvalidInput),
        ("Bob Bobson", "bob bobson", InvalidInput),
        ("RITA", PASSWORD, Conflict),
        ("eve", PASSWORD, Conflict),
        ("owner", PASSWORD, Conflict),
    ):
        with pytest.raises(error):
            accept(entrance, invitation.text, name, password, reserved=["owner"])
    assert accept(entrance, invitation.text, "Bob", PASSWORD)[0].name == "Bob"


@pytest.mark.parametrize("given", [{"role": "king"}, {"lifetime": timedelta(0)}, {"lifetime": timedelta(days=400)}])
def test_what_can_t_be_an_invitation(
    sqlite_database: Database, now: datetime, actor: Actor, given: dict[str, object]
) -> None:
    wanted: dict[str, object] = {"role": "reader", "lifetime": DAY, **given}
    with sqlite_database.write() as session, pytest.raises(InvalidInput):
        invite(session, now=now, actor=actor, **wanted)  # pyright: ignore[reportArgumentType]


def test_a_reset_link_chooses_a_password_and_ends_every_session(
    database: Database,
    enter: Callable[[Database], Entrance],
    add: Add,
    now: datetime,
    actor: Actor,
    rules: SessionRules,
) -> None:
    ada = add(database, "ada", "submitter", password_hash=None)
    with database.write() as session:
        before = start_session(session, account_named(session, "ada"), now, rules, Browser())
        first, link = (offer_reset(session, ada.id, now, actor, lifetime=DAY) for _ in range(2))
        with pytest.raises(NotFound):  # the later one has ended the earlier one
            look_at(session, first.text, now)
        seen = look_at(session, link.text, now)
    assert (seen.kind, seen.role, seen.name) == ("reset", "submitter", "ada")
    with pytest.raises(Unauthenticated):
        sign_in(enter(database), "ada", PASSWORD)
    user, browser = accept(enter(database), link.text, None, PASSWORD)
    assert user.id == ada.id
    with database.read() as session:
        assert session_of(session, browser.text, now, rules)[1].id == ada.id
        with pytest.raises(Unauthenticated):
            session_of(session, before.text, now, rules)
        kinds = session.scalars(select(Event.kind).where(Event.kind.startswith("user."))).all()
        assert kinds == ["user.created", "user.password_reset"]
    assert sign_in(enter(database), "ada", PASSWORD)[0].id == ada.id
    with pytest.raises(NotFound):
        accept(enter(database), link.text, None, "another " + PASSWORD)


def test_an_account_that_is_disabled_meanwhile_stays_so(
    sqlite_database: Database, enter: Callable[[Database], Entrance], add: Add, now: datetime, actor: Actor
) -> None:
    add(sqlite_database, "rita", "admin")
    ada = add(sqlite_database, "ada")
    with sqlite_database.write() as session:
        link = offer_reset(session, ada.id, now, actor, lifetime=DAY)

    class Slow(Passwords):
        def hash_of(self, password: str) -> str:
            with sqlite_database.write() as session:
                disable_account(session, ada.id, now, actor)
            return "hash of " + password

    with pytest.raises(NotFound):
        accept(replace(enter(sqlite_database), passwords=Slow()), link.text, None, PASSWORD)
    with sqlite_database.read() as session:
        assert session.get_one(User, ada.id).password_hash == ada.password_hash
        assert not session.scalars(select(WebSession)).all()


def test_the_secret_is_the_fragment_of_the_address() -> None:
    assert invitation_address("https://lines.example.org/", "abc") == "https://lines.example.org/invitation#abc"
