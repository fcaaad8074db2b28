"""Accounts in a database, with passwords whose hashes cost next to nothing."""

from __future__ import annotations

from collections.abc import Callable
from datetime import datetime, timedelta
from typing import Any

import pytest
from argon2 import PasswordHasher

from app.db.models import User
from app.db.session import Database
from app.services.accounts import add_account
from app.services.events import Actor
from app.services.passwords import Passwords
from app.services.web_sessions import SessionRules

PASSWORD = "seven grey herons"


@pytest.fixture(scope="session")
def cheap() -> Passwords:
    return Passwords(PasswordHasher(time_cost=1, memory_cost=8, parallelism=1))


@pytest.fixture(scope="session")
def password_hash(cheap: Passwords) -> str:
    return cheap.hash_of(PASSWORD)


@pytest.fixture
def rules() -> SessionRules:
    return SessionRules(timedelta(days=30), timedelta(days=7))


@pytest.fixture
def actor() -> Actor:
    return Actor("rita", "192.0.2.7")


@pytest.fixture
def add(now: datetime, actor: Actor, password_hash: str) -> Callable[..., User]:
    """Return what makes an account that signs in with `PASSWORD`."""

    def add(database: Database, name: str, role: str = "annotator", **given: Any) -> User:
        with database.write() as session:
            return add_account(session, name, role, now, actor, **{"password_hash": password_hash, **given})

    return add
