"""Browsers that sign in and out: what they keep, and what that opens."""

from __future__ import annotations

import json
from datetime import timedelta
from typing import Any

import pytest
from sqlalchemy import select

from app.api.cookies import SESSION_COOKIE, TOKEN_COOKIE
from app.api.throttle import Throttle
from app.db.models import WebSession
from app.db.session import Database
from app.errors import Unavailable
from app.services.tokens import create_token, hash_of

Place = Any
PASSWORD = "seven grey herons"
GIVEN = {"name": "annotator", "password": PASSWORD}
JSON = {"Content-Type": "application/json"}


def cookies_of(answer: Any) -> dict[str, str]:
    return {line.partition("=")[0]: line for line in answer.headers.get_list("set-cookie")}


def test_a_session_is_a_cookie_that_no_script_reads_and_no_other_site_sends(place: Place) -> None:
    browser = place.browser()
    answer = browser.post("/api/session", json=GIVEN)
    me = answer.json()
    assert (me["name"], me["role"], me["anonymous"], me["hosted"]) == ("annotator", "annotator", False, True)
    assert me["can"] == {"submit": True, "label": True, "maintain": False, "see_hidden": False, "admin": False}
    account = {"id": place.users["annotator"], "name": "annotator", "email": None, "role": "annotator"}
    assert me["account"] == {**account, "has_password": True}
    cookie = cookies_of(answer)[SESSION_COOKIE]
    assert all(word in cookie for word in ("HttpOnly", "SameSite=strict", "Path=/api;", "Max-Age=2592000"))
    assert "Secure" not in cookie
    assert "Domain" not in cookie
    assert browser.get("/api/me").json() == me
    secret = browser.cookies[SESSION_COOKIE]
    with place.server.database.read() as session:
        row = session.scalars(select(WebSession).where(WebSession.sha256 == hash_of(secret))).one()
    assert (row.address, row.agent) == ("testclient", "Firefox")


def test_behind_https_the_cookie_travels_through_nothing_else(place: Place) -> None:
    assert (
        "Secure"
        in cookies_of(
            place.browser().post(
                "https://127.0.0.1:8765/api/session", json=GIVEN, headers={"Origin": "https://127.0.0.1:8765"}
            )
        )[SESSION_COOKIE]
    )
    settings = place.server.settings.model_copy(update={"public_url": "https://lines.example.org"})
    place.change_server(settings=settings)
    assert "Secure" in cookies_of(place.browser().post("/api/session", json=GIVEN))[SESSION_COOKIE]


def test_each_sign_in_makes_another_secret_and_ends_the_one_before(place: Place) -> None:
    browser = place.browser()
    browser.cookies.set(SESSION_COOKIE, "a-secret-that-somebody-planted", domain="127.0.0.1", path="/api")
    secrets = ["a-secret-that-somebody-planted"]
    for _ in range(2):
        assert browser.post("/api/session", json=GIVEN).status_code == 200
        (kept,) = [cookie.value for cookie in browser.cookies.jar if cookie.name == SESSION_COOKIE]
        secrets.append(str(kept))
    assert len(set(secrets)) == 3
    for secret, status in zip(secrets, (401, 401, 200), strict=True):
        headers = {"Cookie": f"{SESSION_COOKIE}={secret}"}
        assert place.browser().get("/api/me", headers=headers).status_code == status


def test_signing_out_ends_the_session_and_not_only_the_cookie(place: Place) -> None:
    browser = place.browser("annotator")
    secret = browser.cookies[SESSION_COOKIE]
    answer = browser.delete("/api/session")
    assert answer.json()["anonymous"]
    assert {SESSION_COOKIE, TOKEN_COOKIE} <= set(cookies_of(answer))
    assert browser.get("/api/me").json()["role"] == "reader"
    again = place.browser().get("/api/me", headers={"Cookie": f"{SESSION_COOKIE}={secret}"})
    assert again.status_code == 401
    assert f'{SESSION_COOKIE}=""' in again.headers["set-cookie"]
    assert place.told("session.ended")[-1][:2] == ("annotator", "testclient")


def test_failures_say_the_same_and_are_told_to_the_audit(place: Place) -> None:
    disabled = place.add("gone", "annotator")
    assert place.browser("admin").patch(f"/api/users/{disabled}", json={"disabled": True}).status_code == 200
    answers = {
        (answer.status_code, answer.text)
        for given in (
            {"name": "nobody", "password": PASSWORD},
            {"name": "annotator", "password": "wrong"},
            {"name": "annotator", "password": f" {PASSWORD}"},
            {"name": "gone", "password": PASSWORD},
            {"name": "a\0b", "password": "\0"},
            {"name": "annotator", "password": "\udc00"},
        )
        for answer in [place.browser().post("/api/session", content=json.dumps(given), headers=JSON)]
    }
    assert len(answers) == 1
    assert next(iter(answers))[0] == 401
    told = [details.get("name") for _, _, details in place.told("session.failed")]
    assert told[-6:] == [None, "annotator", "annotator", "gone", None, "annotator"]


@pytest.mark.parametrize(
    "given",
    [
        {},
        {"name": "ada"},
        {"password": "x"},
        {"name": "a", "password": "x" * 1_001},
        {"name": "a", "password": "x", "token": "cl_x"},
        [],
    ],
)
def test_what_is_no_sign_in_is_refused_without_being_repeated(place: Place, given: Any) -> None:
    answer = place.browser().post("/api/session", content=json.dumps(given), headers=JSON)
    assert answer.status_code == 422
    assert "xxx" not in answer.text


def test_too_many_failures_of_an_account_are_refused_whoever_asks(place: Place) -> None:
    settings = place.server.settings.model_copy(
        update={"public_url": "https://lines.example.org", "sign_in_limit": "3/minute"}
    )
    place.change_server(throttle=Throttle(settings))
    wrong = {"name": "submitter", "password": "wrong"}
    spellings = ["submitter", "SUBMITTER", " submitter "]
    assert [place.browser().post("/api/session", json={**wrong, "name": each}).status_code for each in spellings] == (
        [401] * 3
    )
    refused = place.browser().post("/api/session", json={**wrong, "password": PASSWORD})
    assert refused.status_code == 429
    assert int(refused.headers["retry-after"]) > 0


def test_a_wrong_current_password_counts_as_a_failed_sign_in(place: Place) -> None:
    settings = place.server.settings.model_copy(
        update={"public_url": "https://lines.example.org", "sign_in_limit": "2/minute"}
    )
    place.change_server(throttle=Throttle(settings))
    browser = place.browser("annotator")
    change = {"current": "wrong", "new": "nine brown otters"}
    statuses = [browser.post("/api/account/password", json=change).status_code for _ in range(3)]
    assert statuses == [422, 422, 429]


def test_a_session_ends_by_itself_when_it_is_idle_or_old(place: Place) -> None:
    browser = place.browser("annotator")
    for days in (6, 12, 18, 24, 29.9):
        place.later = timedelta(days=days)
        assert browser.get("/api/me").json()["name"] == "annotator"
    place.later = timedelta(days=30.1)
    assert browser.get("/api/me").status_code == 401
    place.later = timedelta(0)
    idle = place.browser("annotator")
    place.later = timedelta(days=7.1)
    assert idle.get("/api/me").status_code == 401


def test_a_change_of_role_counts_from_the_next_request_on(place: Place) -> None:
    person = place.add("rising", "reader")
    browser, admin = place.browser("rising"), place.browser("admin")
    assert browser.post("/api/datasets", json={"name": "Rising"}).status_code == 403
    assert admin.patch(f"/api/users/{person}", json={"role": "maintainer"}).json()["role"] == "maintainer"
    assert browser.post("/api/datasets", json={"name": "Rising"}).status_code == 201
    assert admin.patch(f"/api/users/{person}", json={"role": "reader"}).status_code == 200
    assert browser.post("/api/datasets", json={"name": "Rising 2"}).status_code == 403


def test_whoever_is_disabled_is_out_at_the_next_request(place: Place) -> None:
    person = place.add("leaving", "maintainer")
    browser = place.browser("leaving")
    program = place.program(browser.post("/api/account/tokens", json={"label": "x"}).json()["token"])
    assert program.get("/api/me").json()["name"] == "leaving"
    place.browser("admin").patch(f"/api/users/{person}", json={"disabled": True})
    assert browser.get("/api/me").status_code == 401
    assert program.get("/api/me").status_code == 401


def test_a_token_signs_a_browser_in_and_takes_the_session_s_place(place: Place) -> None:
    with place.server.database.write() as session:
        token = create_token(session, "robot", "submitter", place.now(), person=None).text
    browser = place.browser("annotator")
    answer = browser.post("/api/session", json={"token": token})
    assert (answer.json()["name"], answer.json()["account"]) == ("robot", None)
    assert browser.get("/api/me").json()["name"] == "robot"
    assert browser.post("/api/session", json=GIVEN).status_code == 200
    assert browser.get("/api/me").json()["name"] == "annotator"


def test_in_local_mode_nobody_signs_in(place: Place) -> None:
    browser = place.browser("annotator")
    local = place.server.settings.model_copy(update={"anonymous_role": None})
    place.change_server(settings=local)
    me = browser.get("/api/me").json()
    assert (me["name"], me["role"], me["account"], me["hosted"]) == ("owner", "admin", None, False)
    refused = browser.post("/api/session", json=GIVEN)
    assert refused.status_code == 409
    assert "local mode" in refused.json()["message"]
    account = browser.get("/api/account")
    assert account.status_code == 404
    assert "local mode" in account.json()["message"]
    assert browser.get("/api/users").status_code == 200
    assert browser.get("/api/me", headers={"X-ClearLines-Person": "Mara"}).json()["name"] == "Mara"


def test_nobody_is_refused_because_the_time_of_their_last_use_can_t_be_stored(place: Place) -> None:
    browser = place.browser("annotator")

    class Full(Database):
        def write(self) -> Any:
            raise Unavailable("the disk is full")

    place.change_server(database=Full(place.server.database.engine))
    place.later = timedelta(days=1)
    assert browser.get("/api/me").json()["name"] == "annotator"
