"""Wrong passwords shut an account to whoever guesses, however they write its name, and not to whom it belongs."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from fastapi.testclient import TestClient

from app.api.throttle import Throttle
from app.settings import Settings
from tests.api.accounts.conftest import ADDRESS, OWN_PAGE, PASSWORD, Place


@pytest.fixture
def strict(place: Place) -> Place:
    settings = Settings(data_dir=place.server.settings.data_dir, anonymous_role="reader", sign_in_limit="2/minute")
    place.change_server(throttle=Throttle(settings))
    return place


def sign_in(place: Place, number: int, name: str, password: str) -> int:
    """Sign in from an address of that number."""
    browser = TestClient(place.client.app, base_url=ADDRESS, headers=OWN_PAGE, client=(f"198.51.100.{number}", 50000))
    return browser.post("/api/session", json={"name": name, "password": password}).status_code


def test_spaces_around_a_name_make_it_no_other_one(strict: Place, name: Callable[[], str]) -> None:
    guessed = name()
    strict.add(guessed, "annotator")
    typed = [guessed, f" {guessed}", f"{guessed}  ", guessed.upper()]
    assert [sign_in(strict, number, each, "a wrong one") for number, each in enumerate(typed)] == [401, 401, 429, 429]


def test_who_signed_in_there_before_is_not_kept_out_by_strangers(strict: Place, name: Callable[[], str]) -> None:
    mine = name()
    strict.add(mine, "admin")
    assert sign_in(strict, 100, mine, PASSWORD) == 200
    assert [sign_in(strict, number, mine, "a wrong one") for number in range(101, 104)] == [401, 401, 429]
    assert sign_in(strict, 104, mine, PASSWORD) == 429
    assert sign_in(strict, 100, mine, PASSWORD) == 200


@pytest.mark.parametrize("typed", ["a\\u0000b", "\\ud800", "\\u200b"])
def test_what_no_database_takes_is_nobody(strict: Place, typed: str) -> None:
    browser = strict.browser()
    answer = browser.post(
        "/api/session",
        content=f'{{"name": "{typed}", "password": "x"}}',
        headers={"content-type": "application/json"},
    )
    assert answer.status_code in {401, 422}, answer.text
