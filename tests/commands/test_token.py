"""``clearlines token``."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

Run = Callable[..., Any]


def test_a_token_is_printed_once_and_listed_without_itself(clearlines: Run) -> None:
    made = clearlines("token", "create", "ada", "--role", "submitter", "--expires", "30")
    token = made.stdout.strip()
    assert token.startswith("cl_")
    assert "ada, submitter" in made.stderr
    listed = clearlines("token", "list").stdout
    assert token not in listed
    assert listed.splitlines()[1].split()[:3] == ["ada", "submitter", "good"]
    assert clearlines("token", "revoke", "ada").stdout == ""
    assert "revoked" in clearlines("token", "list").stdout


def test_a_wrong_role_and_an_unknown_name_are_told(clearlines: Run) -> None:
    assert "there is no role 'king'" in clearlines("token", "create", "ada", "--role", "king", status=2).stderr
    assert "there is no token named ada" in clearlines("token", "revoke", "ada", status=2).stderr
    assert "there are no tokens" in clearlines("token", "list").stdout
