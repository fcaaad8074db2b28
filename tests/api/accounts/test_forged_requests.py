"""What pages of other sites, and whatever else is on the machine, can't do in the name of who is signed in."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from app.api.cookies import SESSION_COOKIE
from app.services.tokens import create_token

Place = Any


@pytest.mark.parametrize("headers", [{"Origin": ""}, {"Origin": "https://example.org"}, {"Origin": "null"}])
def test_a_change_that_a_cookie_stands_for_must_come_from_a_page_of_ours(place: Place, headers: Any) -> None:
    browser = place.browser("maintainer")
    if not headers["Origin"]:
        del browser.headers["Origin"]
        headers = {}
    for method, address in (("POST", "/api/datasets"), ("DELETE", "/api/session"), ("PATCH", "/api/account")):
        refused = browser.request(method, address, json={"name": "Foreign"}, headers=headers)
        assert refused.status_code == 403, address
    assert browser.get("/api/me").json()["name"] == "maintainer"
    if not headers:
        own = {"Sec-Fetch-Site": "same-origin"}
        assert browser.post("/api/datasets", json={"name": "Own"}, headers=own).status_code == 201
        foreign = {"Sec-Fetch-Site": "cross-site"}
        assert browser.post("/api/datasets", json={"name": "Foreign"}, headers=foreign).status_code == 403


def test_a_program_s_header_stands_for_itself(place: Place, name: Callable[[], str]) -> None:
    with place.server.database.write() as session:
        token = create_token(session, "plain", "maintainer", place.now(), person=None).text
    assert place.program(token).post("/api/datasets", json={"name": name()}).status_code == 201
    browser = place.browser("reader")
    del browser.headers["Origin"]
    headers = {"Authorization": f"Bearer {token}"}  # beside the cookie
    assert browser.post("/api/datasets", json={"name": name()}, headers=headers).status_code == 201


def test_where_people_sign_in_a_page_s_claim_to_a_name_counts_for_nothing(place: Place) -> None:
    claim = {"X-ClearLines-Person": "admin"}
    assert place.browser().get("/api/me", headers=claim).json()["name"] is None
    assert place.browser("reader").get("/api/me", headers=claim).json()["name"] == "reader"


def test_a_link_on_another_site_s_page_signs_nobody_out(place: Place) -> None:
    """No cookie goes along with it, so the answer mustn't drop one either."""
    refused = place.browser().get("/api/users")
    assert refused.status_code == 401
    assert "set-cookie" not in refused.headers


def test_a_cookie_that_another_site_on_the_machine_has_set_is_not_in_the_way(place: Place) -> None:
    secret = place.browser("annotator").cookies[SESSION_COOKIE]
    headers = {"Cookie": f'other={{"a": [1, 2]}} é; {SESSION_COOKIE}={secret}'.encode()}
    assert place.browser().get("/api/me", headers=headers).json()["name"] == "annotator"
