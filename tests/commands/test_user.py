"""``clearlines user``."""

from __future__ import annotations

import getpass
import io
import shutil
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from app.commands.user import server_address
from app.db.session import open_database
from app.services.accounts import account_named
from app.services.invitations import look_at
from app.services.passwords import Passwords
from app.settings import Settings

Run = Callable[..., Any]
PASSWORD = "seven grey herons"


@pytest.fixture
def folder(tmp_path: Path, sqlite_template: Path) -> Path:
    """A data folder whose tables are made already."""
    folder = tmp_path / "data"
    folder.mkdir()
    shutil.copy(sqlite_template, folder / "clearlines.sqlite3")
    return folder


@pytest.fixture
def typed(monkeypatch: pytest.MonkeyPatch) -> Callable[..., None]:
    """Return what has somebody type lines at prompts that don't show them."""

    def typed(*lines: str) -> None:
        left: Iterator[str] = iter(lines)
        monkeypatch.setattr(getpass, "getpass", lambda *_given, **_named: next(left))

    return typed


def stored(folder: Path, name: str) -> Any:
    database = open_database(f"sqlite:///{folder / 'clearlines.sqlite3'}")
    with database.read() as session:
        user = account_named(session, name)
    database.close()
    return user


def test_a_password_is_asked_for_twice_and_shown_never(
    clearlines: Run, folder: Path, typed: Callable[..., None]
) -> None:
    typed(PASSWORD, "a typing mistake", PASSWORD, PASSWORD)
    made = clearlines("user", "create", "Ada", "--role", "admin", "--email", "ada@example.org")
    assert "account of Ada, admin" in made.stderr
    assert PASSWORD not in made.stdout + made.stderr
    user = stored(folder, "ada")
    assert Passwords().is_right(PASSWORD, user.password_hash)
    assert user.created_by == "owner"
    listed = clearlines("user", "list").stdout
    assert listed.splitlines()[1].split()[:4] == ["Ada", "admin", "good", "ada@example.org"]
    assert "argon2" not in listed


def test_a_password_comes_from_a_pipe(clearlines: Run, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdin", io.StringIO(f" {PASSWORD} \nanother line\n"))
    clearlines("user", "create", "ada", "--role", "reader", "--password-stdin")
    assert Passwords().is_right(f" {PASSWORD} ", stored(folder, "ada").password_hash)


def test_links_are_printed_for_who_is_to_choose_a_password(
    clearlines: Run, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("CLEARLINES_PUBLIC_URL", "https://lines.example.org")
    links = [
        clearlines("user", "create", "ada", "--role", "admin", "--invite").stdout.strip(),
        clearlines("user", "reset", "ADA").stdout.strip(),
        clearlines("user", "invite", "--role", "annotator", "--name", "bob", "--days", "2").stdout.strip(),
    ]
    start = "https://lines.example.org/invitation#"
    assert all(link.startswith(start) for link in links)
    assert "no password" in clearlines("user", "list").stdout
    database = open_database(f"sqlite:///{folder / 'clearlines.sqlite3'}")
    with database.read() as session:
        now = account_named(session, "ada").created_at
        seen = [look_at(session, link.removeprefix(start), now) for link in links[1:]]
    database.close()
    assert [(view.kind, view.name, view.role) for view in seen] == [
        ("reset", "ada", "admin"),
        ("join", "bob", "annotator"),
    ]


def test_roles_are_given_and_accounts_disabled_but_for_the_last_admin(clearlines: Run, folder: Path) -> None:
    for name in ("ada", "bob"):
        clearlines("user", "create", name, "--role", "admin", "--invite")
    clearlines("user", "role", "bob", "annotator")
    assert "this is the last admin" in clearlines("user", "disable", "ada", status=2).stderr
    clearlines("user", "disable", "bob")
    assert stored(folder, "bob").disabled_at is not None
    assert "is disabled" in clearlines("user", "reset", "bob", status=2).stderr
    clearlines("user", "enable", "bob")
    assert stored(folder, "bob").role == "annotator"


def test_what_can_t_be_is_told_before_anybody_types_a_password(
    clearlines: Run, folder: Path, typed: Callable[..., None]
) -> None:
    typed()  # a prompt would fail
    clearlines("user", "create", "ada", "--role", "admin", "--invite")
    for wrong, said in (
        (("ADA", "--role", "admin"), "is taken"),
        (("bob", "--role", "king"), "there is no role 'king'"),
        (("bob", "--role", "reader", "--email", "nobody"), "no address of mail"),
        (("bob", "--role", "reader", "--invite", "--password-stdin"), "either they choose"),
    ):
        assert said in clearlines("user", "create", *wrong, status=2).stderr
    assert "no account named eve" in clearlines("user", "role", "eve", "reader", status=2).stderr
    typed("short", "short")
    refused = clearlines("user", "create", "bob", "--role", "reader", status=2).stderr
    assert "10 to 200 characters" in refused


@pytest.mark.parametrize(
    ("given", "address"),
    [
        ({}, "http://127.0.0.1:8765"),
        ({"host": "0.0.0.0", "port": 80}, "http://localhost:80"),
        ({"host": "::1"}, "http://[::1]:8765"),
        ({"public_url": "https://lines.example.org"}, "https://lines.example.org"),
    ],
)
def test_where_a_server_is_found(tmp_path: Path, given: Any, address: str) -> None:
    assert server_address(Settings(data_dir=tmp_path, **given)) == address
