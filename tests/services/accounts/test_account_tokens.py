"""Tokens that people make for programs of their own."""

from __future__ import annotations

from collections.abc import Callable
from datetime import datetime, timedelta

import pytest

from app.db.models import User
from app.db.session import Database
from app.errors import Conflict, Forbidden, InvalidInput, NotFound, Unauthenticated
from app.services import account_tokens
from app.services.access import ROLES, Viewer, lesser_role
from app.services.account_tokens import end_token, list_own_tokens, make_own_token
from app.services.accounts import change_role
from app.services.events import Actor
from app.services.tokens import create_token, list_tokens, record_use, token_of, token_viewer

Add = Callable[..., User]


def test_a_token_never_may_more_than_its_holder_may_now(
    database: Database, add: Add, now: datetime, actor: Actor
) -> None:
    ada = add(database, "ada", "annotator")
    with database.write() as session:
        _, text = make_own_token(session, ada.id, "cluster", now, actor)
        _, little = make_own_token(session, ada.id, "board", now, actor, role="submitter")
        with pytest.raises(Forbidden):
            make_own_token(session, ada.id, "more", now, actor, role="maintainer")

    def roles() -> list[str]:
        with database.read() as session:
            return [token_viewer(*token_of(session, each, now)).role for each in (text, little)]

    assert roles() == ["annotator", "submitter"]
    for given, seen in (("reader", ["reader", "reader"]), ("admin", ["annotator", "submitter"])):
        with database.write() as session:
            change_role(session, ada.id, given, now, actor)
            assert token_viewer(*token_of(session, text, now)).name == "ada"
        assert roles() == seen
        if given == "reader":  # an admin must be left
            add(database, "rita", "admin")


def test_a_token_is_shown_once_and_good_until_it_expires_or_is_revoked(
    sqlite_database: Database, add: Add, now: datetime, actor: Actor
) -> None:
    ada, bob = add(sqlite_database, "ada"), add(sqlite_database, "bob")
    with sqlite_database.write() as session:
        token, text = make_own_token(session, ada.id, " cluster ", now, actor, lifetime=timedelta(days=1))
        assert text.startswith("cl_")
        assert text not in str(vars(token))
        assert (token.label, token.name, token.user_id) == ("cluster", "ada", ada.id)
        with pytest.raises(Conflict):
            make_own_token(session, ada.id, "cluster", now, actor)
        make_own_token(session, bob.id, "cluster", now, actor)
        assert token_viewer(*token_of(session, text, now)) == Viewer("ada", "annotator", user_id=ada.id)
        with pytest.raises(Unauthenticated):
            token_of(session, text, now + timedelta(days=1))
        with pytest.raises(NotFound):
            end_token(session, token.id, now, actor, user_id=bob.id)
        end_token(session, token.id, now, actor, user_id=ada.id)
        with pytest.raises(NotFound):
            end_token(session, token.id, now, actor, user_id=ada.id)
        with pytest.raises(Unauthenticated):
            token_of(session, text, now)
        assert not list_own_tokens(session, ada.id)
        assert make_own_token(session, ada.id, "cluster", now, actor)[1] != text


def test_a_token_s_use_is_its_holder_s_too(sqlite_database: Database, add: Add, now: datetime, actor: Actor) -> None:
    ada = add(sqlite_database, "ada")
    with sqlite_database.write() as session:
        token, _ = make_own_token(session, ada.id, "cluster", now, actor)
        record_use(session, token, now)
    with sqlite_database.read() as session:
        assert session.get_one(User, ada.id).last_seen_at == now


def test_services_and_people_s_tokens_are_listed_together_and_revoked_by_an_admin(
    sqlite_database: Database, add: Add, now: datetime, actor: Actor
) -> None:
    ada = add(sqlite_database, "ada")
    with sqlite_database.write() as session:
        make_own_token(session, ada.id, "cluster", now, actor)
        robot = create_token(session, "robot", "submitter", now, person=None)
        listed = list_tokens(session)
        assert [(token.name, token.label) for token in listed] == [("ada", "cluster"), ("robot", None)]
        for token in listed:
            end_token(session, token.id, now, actor)
        with pytest.raises(Unauthenticated):
            token_of(session, robot.text, now)


@pytest.mark.parametrize(
    "given", [{"label": ""}, {"role": "king"}, {"lifetime": timedelta(0)}, {"lifetime": timedelta.max}]
)
def test_what_can_t_be_a_token_of_one_s_own(
    sqlite_database: Database, add: Add, now: datetime, actor: Actor, given: dict[str, object]
) -> None:
    ada = add(sqlite_database, "ada")
    wanted: dict[str, object] = {"label": "cluster", **given}
    with sqlite_database.write() as session, pytest.raises(InvalidInput):
        make_own_token(session, ada.id, now=now, actor=actor, **wanted)  # pyright: ignore[reportArgumentType]


def test_nobody_has_very_many(
    sqlite_database: Database, add: Add, now: datetime, actor: Actor, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(account_tokens, "MOST_TOKENS", 2)
    ada = add(sqlite_database, "ada")
    with sqlite_database.write() as session:
        for label in ("one", "two"):
            make_own_token(session, ada.id, label, now, actor)
        with pytest.raises(Conflict):
            make_own_token(session, ada.id, "three", now, actor)


def test_the_lesser_of_two_roles() -> None:
    for place, role in enumerate(ROLES):
        for other in ROLES[place:]:
            assert lesser_role(role, other) == lesser_role(other, role) == role
