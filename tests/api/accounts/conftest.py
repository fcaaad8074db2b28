"""A server with accounts: one for each role, cheap passwords, a clock that can be moved, and browsers to ask with."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from datetime import datetime, timedelta
from pathlib import Path
from typing import Any

import pytest
from argon2 import PasswordHasher
from fastapi.testclient import TestClient
from sqlalchemy import make_url, select, update

from app.api.application import create_application
from app.api.cookies import SESSION_COOKIE
from app.api.deps import Server
from app.clock import utc_now
from app.db.models import Event, Token, User, WebSession
from app.services.access import ROLES
from app.services.account_tokens import end_token, make_own_token
from app.services.accounts import add_account, disable_account, get_account
from app.services.events import Actor
from app.services.passwords import Passwords
from app.services.tokens import create_token, revoke_token
from app.services.web_sessions import Browser, end_session, session_rules, start_session
from app.settings import Settings

PASSWORD = "seven grey herons"
ADDRESS = "http://127.0.0.1:8765"
OWN_PAGE = {"Origin": ADDRESS}


@dataclass
class Place:
    """The server, and who has an account there: `reader`, `submitter`..., each with `PASSWORD`.

    Attributes:
        users: Ids of accounts by name.
        later: How far the server's clock is ahead.
    """

    client: TestClient
    users: dict[str, int] = field(default_factory=dict)
    later: timedelta = timedelta(0)

    @property
    def server(self) -> Server:
        application: Any = self.client.app
        return application.state.server

    def change_server(self, **fields: Any) -> None:
        """Put other things into the server."""
        self.put_server(replace(self.server, **fields))

    def put_server(self, server: Server) -> None:
        """Have another server answer."""
        application: Any = self.client.app
        application.state.server = server

    def now(self) -> datetime:
        return utc_now() + self.later

    def add(self, name: str, role: str, **given: Any) -> int:
        """Make an account that signs in with `PASSWORD`."""
        with self.server.database.write() as session:
            given = {"password_hash": self.server.passwords.hash_of(PASSWORD), **given}
            self.users[name] = add_account(session, name, role, self.now(), Actor("rita"), **given).id
        return self.users[name]

    def browser(self, name: str | None = None, password: str = PASSWORD, *, agent: str = "Firefox") -> TestClient:
        """Return a browser of its own, which sends what browsers send, signed in where a name is given."""
        application: Any = self.client.app
        browser = TestClient(application, base_url=ADDRESS, headers={**OWN_PAGE, "user-agent": agent})
        if name is not None:
            answer = browser.post("/api/session", json={"name": name, "password": password})
            assert answer.status_code == 200, answer.text
        return browser

    def program(self, token: str) -> TestClient:
        """Return a program that sends a token."""
        application: Any = self.client.app
        return TestClient(application, base_url=ADDRESS, headers={"Authorization": f"Bearer {token}"})

    def told(self, kind: str) -> list[tuple[str | None, str | None, dict[str, Any]]]:
        """Who did things of a kind, from where, with what details."""
        with self.server.database.read() as session:
            events = session.scalars(select(Event).where(Event.kind.startswith(kind)).order_by(Event.id)).all()
        return [(event.person, event.address, event.details) for event in events]


def opened(folder: Path, template: Path, **given: Any) -> Iterator[Place]:
    settings = Settings(data_dir=folder, workers=1, **given)
    shutil.copy(template, str(make_url(settings.database_address).database))
    with TestClient(create_application(settings), base_url=ADDRESS) as client:
        place = Place(client)
        cheap = Passwords(PasswordHasher(time_cost=1, memory_cost=8, parallelism=1))
        place.change_server(clock=place.now, passwords=cheap)
        for role in ROLES:
            place.add(role, role)
        yield place


@pytest.fixture(scope="module")
def running(tmp_path_factory: pytest.TempPathFactory, sqlite_template: Path) -> Iterator[Place]:
    yield from opened(
        tmp_path_factory.mktemp("accounts"), sqlite_template, anonymous_role="reader", sign_in_limit="1000/second"
    )


@pytest.fixture
def place(running: Place) -> Iterator[Place]:
    """The server of a file's tests; what a test has changed of the server itself is as before afterwards."""
    server = running.server
    running.later = timedelta(0)
    yield running
    running.put_server(server)


@dataclass(frozen=True)
class Asker:
    """Somebody who asks.

    Attributes:
        role: What they may do; ``None`` where nobody lets them in.
        headers: What they send.
        has_account: Whether they are somebody's account.
        anonymous: Whether they send nothing to say who they are.
    """

    role: str | None
    headers: Mapping[str, str]
    has_account: bool = False
    anonymous: bool = False


def cookie(secret: str) -> dict[str, str]:
    return {"cookie": f"{SESSION_COOKIE}={secret}", "origin": ADDRESS}


def bearer(token: str) -> dict[str, str]:
    return {"authorization": f"Bearer {token}"}


@pytest.fixture(scope="module")
def askers(running: Place) -> dict[str, Asker]:
    """Everybody there can be, by what they are."""
    place = running
    now, rules, actor = place.now(), session_rules(place.server.settings), Actor("rita")
    found = {"nobody": Asker("reader", {}, anonymous=True), "nobody with a wrong token": Asker(None, bearer("cl_x"))}
    found["nobody with a wrong session"] = Asker(None, cookie("x"))
    with place.server.database.write() as session:
        boss = get_account(session, place.users["admin"])

        def browser(user: User) -> str:
            return start_session(session, user, now, rules, Browser()).text

        for role in ROLES:
            holder = get_account(session, place.users[role])
            found[f"{role} in a browser"] = Asker(role, cookie(browser(holder)), has_account=True)
            _, own = make_own_token(session, boss.id, role, now, actor, role=role)
            found[f"admin's token for a {role}"] = Asker(role, bearer(own), has_account=True)
            service = create_token(session, f"service {role}", role, now, person=None)
            found[f"service as {role}"] = Asker(role, bearer(service.text))
        old, idle, ended = (start_session(session, boss, now, rules, Browser()) for _ in range(3))
        old.row.expires_at = now - timedelta(seconds=1)
        found["expired session"] = Asker(None, cookie(old.text))
        idle.row.last_used_at = now - timedelta(days=8)
        found["idle session"] = Asker(None, cookie(idle.text))
        end_session(session, boss.id, ended.row.id, now, actor, "session.revoked")
        found["ended session"] = Asker(None, cookie(ended.text))
        revoked, text = make_own_token(session, boss.id, "revoked", now, actor)
        end_token(session, revoked.id, now, actor)
        found["revoked token"] = Asker(None, bearer(text))
        expired, text = make_own_token(session, boss.id, "expired", now, actor, lifetime=timedelta(days=1))
        session.execute(update(Token).where(Token.id == expired.id).values(expires_at=now))
        found["expired token"] = Asker(None, bearer(text))
        gone = create_token(session, "service gone", "admin", now, person=None)
        revoke_token(session, "service gone", now, person=None)
        found["revoked service"] = Asker(None, bearer(gone.text))
    disabled = place.add("disabled", "admin")
    with place.server.database.write() as session:
        user = get_account(session, disabled)
        secret = start_session(session, user, now, rules, Browser()).text
        _, text = make_own_token(session, disabled, "x", now, actor)
        disable_account(session, disabled, now, actor)
        # as if they had been made at that very moment, and nobody had ended them
        session.execute(update(WebSession).where(WebSession.user_id == disabled).values(revoked_at=None))
        session.execute(update(Token).where(Token.user_id == disabled).values(revoked_at=None))
    found["disabled in a browser"], found["disabled's token"] = Asker(None, cookie(secret)), Asker(None, bearer(text))
    return found


@pytest.fixture
def name() -> Callable[[], str]:
    """Return what makes a name that nobody has."""
    taken = iter(range(1_000))
    return lambda: f"person {next(taken)} of {utc_now().timestamp()}"
