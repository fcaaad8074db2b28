"""Browsers that are signed in."""

from __future__ import annotations

from collections.abc import Callable
from datetime import datetime, timedelta

import pytest
from sqlalchemy import select

from app.db.models import User, WebSession
from app.db.session import Database
from app.errors import NotFound, Unauthenticated
from app.services.access import Viewer
from app.services.accounts import account_named
from app.services.events import Actor
from app.services.web_sessions import (
    Browser,
    SessionRules,
    end_session,
    end_sessions,
    is_use_due,
    list_sessions,
    record_use,
    session_of,
    session_viewer,
    start_session,
)

Add = Callable[..., User]
DAY = timedelta(days=1)


def test_a_session_is_good_until_it_expires_or_is_idle(
    database: Database, add: Add, now: datetime, rules: SessionRules
) -> None:
    ada = add(database, "ada", "submitter")
    with database.write() as session:
        made = start_session(session, account_named(session, "ada"), now, rules, Browser("192.0.2.7", "Fire\nfox"))
    with database.read() as session:
        row, user = session_of(session, made.text, now + 6.9 * DAY, rules)
        assert session_viewer(row, user) == Viewer("ada", "submitter", user_id=ada.id, web_session_id=row.id)
        assert (row.address, row.agent, user.last_seen_at) == ("192.0.2.7", "Firefox", now)
        for text, time in ((made.text, now + 7 * DAY), (made.text[:-1], now), (row.sha256, now), ("", now)):
            with pytest.raises(Unauthenticated):
                session_of(session, text, time, rules)
    with database.write() as session:  # used every day, it still ends
        row = session.scalars(select(WebSession)).one()
        record_use(session, row, now + 29 * DAY)
    with database.read() as session:
        assert session_of(session, made.text, now + 29.9 * DAY, rules)[0].id == made.row.id
        with pytest.raises(Unauthenticated):
            session_of(session, made.text, now + 30 * DAY, rules)


def test_each_sign_in_makes_a_secret_of_256_bits_that_is_kept_as_a_hash(
    sqlite_database: Database, add: Add, now: datetime, rules: SessionRules
) -> None:
    add(sqlite_database, "ada")
    with sqlite_database.write() as session:
        user = account_named(session, "ada")
        texts = {start_session(session, user, now, rules, Browser()).text for _ in range(3)}
        stored = str([vars(row) for row in session.scalars(select(WebSession))])
    assert len(texts) == 3
    assert all(len(text) == 43 and text not in stored for text in texts)  # 32 bytes in base64


def test_the_last_use_is_stored_now_and_then(rules: SessionRules, now: datetime) -> None:
    row = WebSession(last_used_at=now)
    assert not is_use_due(row, now + timedelta(minutes=9), rules)
    assert is_use_due(row, now + timedelta(minutes=10), rules)
    hasty = SessionRules(DAY, timedelta(minutes=10))
    assert is_use_due(row, now + timedelta(minutes=1), hasty)


def test_sessions_are_listed_and_ended_one_by_one_by_whose_they_are(
    database: Database, add: Add, now: datetime, rules: SessionRules, actor: Actor
) -> None:
    ada, bob = add(database, "ada"), add(database, "bob")
    with database.write() as session:
        old, new = (start_session(session, account_named(session, "ada"), now, rules, Browser()) for _ in range(2))
        start_session(session, account_named(session, "bob"), now, rules, Browser())
        assert [row.id for row in list_sessions(session, ada.id, now, rules)] == [new.row.id, old.row.id]
        with pytest.raises(NotFound):
            end_session(session, bob.id, old.row.id, now, actor, "session.revoked")
        end_session(session, ada.id, old.row.id, now, actor, "session.revoked")
        with pytest.raises(NotFound):
            end_session(session, ada.id, old.row.id, now, actor, "session.revoked")
        assert [row.id for row in list_sessions(session, ada.id, now, rules)] == [new.row.id]
        assert end_sessions(session, ada.id, now) == 1
        assert not list_sessions(session, ada.id, now, rules)
        assert len(list_sessions(session, bob.id, now, rules)) == 1
        assert not list_sessions(session, bob.id, now + 8 * DAY, rules)


def test_what_is_long_over_is_forgotten(
    sqlite_database: Database, add: Add, now: datetime, rules: SessionRules
) -> None:
    add(sqlite_database, "ada")
    for later in (0, 40, 61):
        with sqlite_database.write() as session:
            start_session(session, account_named(session, "ada"), now + later * DAY, rules, Browser())
    with sqlite_database.read() as session:
        assert [row.created_at for row in session.scalars(select(WebSession))] == [now + 40 * DAY, now + 61 * DAY]
