"""Who may do what: roles, tokens, the cookie, and a policy that every address of the API is in."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from datetime import timedelta
from typing import Any

import pytest
from fastapi.testclient import TestClient
from sqlalchemy import select

from app.api.application import create_application
from app.api.cookies import TOKEN_COOKIE as COOKIE
from app.api.policy import LEAST, RULES, rule_of
from app.clock import utc_now
from app.db.models import Event, Review
from app.services.access import ROLES
from app.services.tokens import create_token, revoke_token
from app.settings import Settings

Make = Callable[..., str]


@pytest.fixture
def shared(settings: Settings) -> Iterator[TestClient]:
    """A server that others ask too: without a token one only reads."""
    application = create_application(settings.model_copy(update={"anonymous_role": "reader"}))
    with TestClient(application, base_url="http://127.0.0.1:8765") as client:
        yield client


@pytest.fixture
def make(shared: TestClient) -> Make:
    """Make a token and return it."""

    def make(name: str, role: str, **given: Any) -> str:
        with database_of(shared).write() as session:
            return create_token(session, name, role, utc_now(), person=None, **given).text

    return make


def database_of(client: TestClient) -> Any:
    application: Any = client.app
    return application.state.server.database


def bearer(token: str) -> dict[str, str]:
    return {"Authorization": f"Bearer {token}"}


def without_names(template: str) -> str:
    return re.sub(r"{\w+}", "{}", template)


def test_every_operation_is_in_the_policy_and_nothing_else(client: TestClient) -> None:
    document = client.get("/api/openapi.json").json()
    served = {
        f"{method.upper()} {without_names(path.removeprefix('/api'))}"
        for path, operations in document["paths"].items()
        for method in operations
    }
    beside = {"GET /openapi.json", "GET /docs"}  # addresses that the document doesn't list
    listed = [without_names(address) for addresses in LEAST.values() for address in addresses]
    assert len(set(listed)) == len(listed)
    assert set(listed) - beside == served


def test_an_address_is_found_by_its_words_before_its_parts() -> None:
    found = {f"{rule.method} {rule.template}" for rule in RULES}
    for rule in RULES:
        path = "/api" + re.sub(r"{\w+}", "7", rule.template)
        request = rule_of(rule.method, path)
        assert request is not None
        assert f"{request.rule.method} {request.rule.template}" in found
        assert request.rule.template == rule.template, path
    assert rule_of("GET", "/api/nope") is None
    assert rule_of("GET", "/datasets") is None
    head = rule_of("HEAD", "/api/health")
    assert head is not None
    assert head.rule.template == "/health"


def test_without_a_token_the_owner_asks_in_local_mode(client: TestClient) -> None:
    me = client.get("/api/me").json()
    assert (me["name"], me["role"], me["anonymous"]) == ("owner", "admin", True)
    assert all(me["can"].values())


def test_without_a_token_a_shared_server_only_reads(shared: TestClient) -> None:
    me = shared.get("/api/me").json()
    assert (me["name"], me["role"]) == (None, "reader")
    assert not any(me["can"].values())
    assert shared.get("/api/datasets").status_code == 200
    refused = shared.post("/api/datasets", json={"name": "x"})
    assert refused.status_code == 401
    assert refused.headers["www-authenticate"] == "Bearer"
    assert refused.json()["expected"] == "the role maintainer"
    assert shared.get("/api/configuration").json()["local"] is False
    assert shared.get("/api/nope").status_code == 404


def test_each_role_may_do_what_those_below_it_may(shared: TestClient, make: Make) -> None:
    tokens = {role: make(role, role) for role in ROLES}
    allowed = {
        ("POST", "/api/datasets"): "maintainer",
        ("PUT", "/api/images/1/review"): "annotator",
        ("POST", "/api/splits/x/submissions/validate"): "submitter",
        ("GET", "/api/splits"): "reader",
    }
    for (method, address), least in allowed.items():
        for role, token in tokens.items():
            status = shared.request(method, address, headers=bearer(token)).status_code
            is_enough = ROLES.index(role) >= ROLES.index(least)
            assert (status != 403) == is_enough, f"{role} {method} {address}: {status}"


def test_what_nobody_may_send_is_refused_before_it_is_read(shared: TestClient) -> None:
    """A body that can't be parsed would be 400 or 422, had anyone looked at it."""
    head = {"content-type": "multipart/form-data; boundary=x"}
    for content in (b"no form at all", b"--x\r\nContent-Disposition: broken"):
        answer = shared.post("/api/datasets/street/images", content=content, headers=head)
        assert answer.status_code == 401


@pytest.mark.parametrize("bad", ["cl_unknown", "x", "é", "cl_" + "a" * 5_000])
def test_an_unknown_token_is_refused_even_in_local_mode(client: TestClient, bad: str) -> None:
    answer = client.get("/api/datasets", headers={b"Authorization": f"Bearer {bad}".encode()})
    assert answer.status_code == 401
    assert answer.json()["code"] == "unauthenticated"


def test_expired_and_revoked_tokens_are_no_good(shared: TestClient, make: Make) -> None:
    short = make("short", "maintainer", lifetime=timedelta(microseconds=1))
    assert shared.get("/api/me", headers=bearer(short)).status_code == 401
    good = make("ada", "maintainer")
    assert shared.get("/api/me", headers=bearer(good)).json()["name"] == "ada"
    with database_of(shared).write() as session:
        revoke_token(session, "ada", utc_now(), person=None)
    assert shared.get("/api/me", headers=bearer(good)).status_code == 401


def test_a_browser_signs_in_with_a_cookie_that_no_script_reads(shared: TestClient, make: Make) -> None:
    token = make("ada", "annotator")
    answer = shared.post("/api/session", json={"token": token})
    assert answer.json()["role"] == "annotator"
    cookie = answer.headers["set-cookie"]
    assert all(word in cookie for word in (f"{COOKIE}={token}", "HttpOnly", "SameSite=strict", "Path=/api"))
    assert shared.get("/api/me").json()["name"] == "ada"
    assert shared.request("DELETE", "/api/session").json()["anonymous"]
    assert shared.get("/api/me").json()["role"] == "reader"


def test_a_cookie_that_is_no_longer_good_is_dropped_and_not_in_the_way(shared: TestClient, make: Make) -> None:
    shared.post("/api/session", json={"token": make("ada", "annotator")})
    with database_of(shared).write() as session:
        revoke_token(session, "ada", utc_now(), person=None)
    assert shared.post("/api/session", json={"token": make("bob", "submitter")}).status_code == 200
    with database_of(shared).write() as session:
        revoke_token(session, "bob", utc_now(), person=None)
    refused = shared.get("/api/me")
    assert refused.status_code == 401
    assert f'{COOKIE}=""' in refused.headers["set-cookie"]
    assert shared.get("/api/me").json()["anonymous"]


def test_what_a_viewer_does_is_stored_under_their_name(
    shared: TestClient, make: Make, picture: Callable[[int], bytes]
) -> None:
    head = bearer(make("ada", "maintainer"))
    assert shared.post("/api/datasets", json={"name": "Street"}, headers=head).status_code == 201
    files = [("files", ("one.png", picture(1)))]
    image = shared.post("/api/datasets/street/images", files=files, headers=head).json()["added"][0]["id"]
    labeller = bearer(make("bob", "annotator"))
    review = {"status": "discarded", "reason": "blurred"}
    assert shared.put(f"/api/images/{image}/review", json=review, headers=labeller).status_code == 200
    with database_of(shared).read() as session:
        assert session.get_one(Review, image).person == "bob"
        persons = {event.kind: event.person for event in session.scalars(select(Event))}
    assert (persons["dataset.created"], persons["image.reviewed"]) == ("ada", "bob")


def test_another_site_s_page_can_t_use_the_cookie(shared: TestClient, make: Make) -> None:
    shared.post("/api/session", json={"token": make("ada", "maintainer")})
    refused = shared.post("/api/datasets", json={"name": "x"}, headers={"Origin": "https://example.org"})
    assert refused.status_code == 403
