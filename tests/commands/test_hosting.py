"""A server that others reach: not before somebody may let them in."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from app.clock import utc_now
from app.commands.hosting import require_admin
from app.commands.stores import opened_stores
from app.errors import Forbidden
from app.services.accounts import add_account
from app.services.events import Actor
from app.settings import Settings


@pytest.mark.parametrize("option", [("--host", "0.0.0.0"), ("--public-url", "https://lines.example.org")])
def test_others_are_not_let_in_before_there_is_an_admin(clearlines: Any, option: tuple[str, str]) -> None:
    said = clearlines("serve", *option, "--port", 0, status=2).stderr
    assert "clearlines user create NAME --role admin" in said
    assert "ClearLines is at" not in said


def test_an_admin_who_may_not_come_in_lets_nobody_in(tmp_path: Path) -> None:
    settings = Settings(data_dir=tmp_path, host="0.0.0.0")
    with opened_stores(settings) as (database, _), database.write() as session:
        add_account(session, "ada", "maintainer", utc_now(), Actor(None))
        add_account(session, "bea", "admin", utc_now(), Actor(None)).disabled_at = utc_now()
    with pytest.raises(Forbidden, match="no account"):
        require_admin(settings)
    with opened_stores(settings) as (database, _), database.write() as session:
        add_account(session, "cid", "admin", utc_now(), Actor(None))
    require_admin(settings)
