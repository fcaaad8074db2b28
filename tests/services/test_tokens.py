"""Tokens: shown once, kept as a hash, good until they expire or are revoked."""

from __future__ import annotations

from datetime import datetime, timedelta

import pytest
from sqlalchemy import select

from app.db.models import ROLES as STORED_ROLES
from app.db.models import Event, Token
from app.db.session import Database
from app.errors import Conflict, InvalidInput, NotFound, Unauthenticated
from app.services.access import ROLES, Viewer, can_see_details, is_at_least, owns
from app.services.tokens import (
    create_token,
    hash_of,
    is_use_due,
    list_tokens,
    record_use,
    revoke_token,
    token_of,
    token_viewer,
)


def test_only_the_hash_is_kept(database: Database, now: datetime) -> None:
    with database.write() as session:
        made = create_token(session, "ada", "submitter", now, lifetime=timedelta(days=1), person="owner")
    assert made.text.startswith("cl_")
    assert len(made.text) > 40
    with database.read() as session:
        row = session.scalars(select(Token)).one()
        assert row.sha256 == hash_of(made.text)
        assert made.text not in str(vars(row))
        assert made.text not in str([event.details for event in session.scalars(select(Event))])
        assert token_viewer(*token_of(session, made.text, now)) == Viewer("ada", "submitter")
        with pytest.raises(Unauthenticated):
            token_of(session, made.text, now + timedelta(days=1))
        with pytest.raises(Unauthenticated):
            token_of(session, made.text[:-1], now)


def test_a_name_is_free_again_once_its_token_is_revoked(database: Database, now: datetime) -> None:
    with database.write() as session:
        first = create_token(session, "ada", "submitter", now, person=None)
        with pytest.raises(Conflict):
            create_token(session, " ada ", "reader", now, person=None)
        revoke_token(session, "ada", now, person=None)
        second = create_token(session, "ada", "reader", now, person=None)
    with database.read() as session:
        with pytest.raises(Unauthenticated):
            token_of(session, first.text, now)
        assert token_of(session, second.text, now)[0].role == "reader"
        assert [token.revoked_at for token in list_tokens(session)] == [now, None]
    with database.write() as session, pytest.raises(NotFound):
        revoke_token(session, "bob", now, person=None)


@pytest.mark.parametrize(
    ("name", "role", "days"),
    [
        ("", "reader", 1),
        ("a\nb\0", "reader", 1),
        ("x" * 201, "reader", 1),
        ("a", "king", 1),
        ("a", "reader", 0),
    ],
)
def test_what_can_t_be_a_token(sqlite_database: Database, now: datetime, name: str, role: str, days: int) -> None:
    with sqlite_database.write() as session, pytest.raises(InvalidInput):
        create_token(session, name, role, now, lifetime=timedelta(days=days), person=None)


def test_the_last_use_is_stored_now_and_then(sqlite_database: Database, now: datetime) -> None:
    with sqlite_database.write() as session:
        made = create_token(session, "ada", "reader", now, person=None)
    with sqlite_database.write() as session:
        token, _ = token_of(session, made.text, now)
        assert is_use_due(token, now)
        record_use(session, token, now)
        assert not is_use_due(token, now + timedelta(minutes=1))
        assert is_use_due(token, now + timedelta(hours=1))


def test_roles_are_a_ladder() -> None:
    assert set(ROLES) == set(STORED_ROLES)
    annotator = Viewer("ada", "annotator")
    assert [is_at_least(annotator, role) for role in ROLES] == [True, True, True, False, False]
    assert can_see_details(annotator, "open")
    assert not can_see_details(annotator, "hidden")
    assert can_see_details(Viewer("bob", "maintainer"), "hidden")


def test_what_nobody_s_name_is_on_belongs_to_nobody() -> None:
    assert owns(Viewer("ada", "submitter"), "ada")
    assert not owns(Viewer("ada", "submitter"), "bob")
    assert not owns(Viewer(None, "reader", anonymous=True), None)
