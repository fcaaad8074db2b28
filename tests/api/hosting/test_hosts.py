"""Under which names a hosted server answers, whose pages may change anything, and what answers carry then."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest
from fastapi.testclient import TestClient
from starlette.datastructures import Headers

from app.api.guard import Guard, check_direct
from app.api.origins import OwnNames, origin_of, own_names
from app.errors import Forbidden
from app.settings import Settings
from tests.api.hosting.conftest import HOME, Serve, token_for
from tests.event_loop import run

ELSEWHERE = "https://notebooks.example.org"


@pytest.fixture(scope="module")
def shared(serve: Serve) -> TestClient:
    """A server whom pages of another site may ask."""
    return serve(cors_origins=[ELSEWHERE], sign_in_limit="1000/minute")


@pytest.mark.parametrize(
    ("host", "status"),
    [
        ("lines.example.org", 200),
        ("LINES.example.org:443", 200),
        ("127.0.0.1:8765", 200),
        ("localhost", 200),
        ("192.0.2.4:8765", 200),
        ("[2001:db8::1]", 200),
        ("evil.example", 403),
        ("lines.example.org.evil.example", 403),
        ("xlines.example.org", 403),
        ("127.0.0.1.evil.example", 403),
        ("", 403),
    ],
)
def test_it_answers_under_its_own_names_and_under_numbers(hosted: TestClient, host: str, status: int) -> None:
    assert hosted.get("/api/health", headers={"host": host}).status_code == status


@pytest.mark.parametrize(
    ("headers", "passes"),
    [
        ({"origin": HOME}, True),
        ({"origin": HOME, "sec-fetch-site": "same-origin"}, True),
        ({"origin": HOME, "host": "127.0.0.1:8765"}, True),  # a proxy that doesn't pass the name on
        ({"origin": "http://lines.example.org"}, False),  # anybody on the way can make such a page
        ({"origin": "https://lines.example.org:8443"}, False),
        ({"origin": "https://evil.example"}, False),
        ({"origin": "null"}, False),
        ({"origin": ""}, False),
        ({"sec-fetch-site": "cross-site"}, False),
        ({"sec-fetch-site": "same-site"}, False),
        ({"origin": ELSEWHERE}, False),  # allowed, but without a token of its own
    ],
)
def test_only_its_own_pages_ask_for_changes(shared: TestClient, headers: dict[str, str], passes: bool) -> None:
    # signing in with a password that is nobody's: 401 once the guard has let it pass
    answer = shared.post("/api/session", json={"name": "ada", "password": "no such password"}, headers=headers)
    assert (answer.status_code != 403) is passes, answer.text


def test_a_page_that_is_allowed_asks_with_a_token_and_without_cookies(shared: TestClient) -> None:
    asked = {"access-control-request-method": "POST", "access-control-request-headers": "authorization"}
    preflight = shared.options("/api/datasets", headers={"origin": ELSEWHERE, **asked})
    assert preflight.status_code == 200
    assert preflight.headers["access-control-allow-origin"] == ELSEWHERE
    assert "access-control-allow-credentials" not in preflight.headers
    token = token_for(shared, "notebook", "maintainer")
    sent = {**token, "origin": ELSEWHERE, "sec-fetch-site": "cross-site"}
    made = shared.post("/api/datasets", json={"name": "x"}, headers=sent)
    assert made.status_code == 201, made.text
    assert made.headers["access-control-allow-origin"] == ELSEWHERE
    foreign = shared.get("/api/datasets", headers={"origin": "https://evil.example"})
    assert "access-control-allow-origin" not in foreign.headers


def test_elsewhere_is_off_unless_it_is_asked_for(hosted: TestClient) -> None:
    asked = {"origin": ELSEWHERE, "access-control-request-method": "POST"}
    for method in ("GET", "OPTIONS"):
        answer = hosted.request(method, "/api/datasets", headers=asked)
        assert not [name for name in answer.headers if name.startswith("access-control")]


def test_browsers_are_told_to_use_tls_alone(hosted: TestClient) -> None:
    for answer in (hosted.get("/api/health"), hosted.get("/api/nope"), hosted.get("/x", headers={"host": "evil"})):
        assert answer.headers["strict-transport-security"] == "max-age=31536000"
        assert "unsafe-inline" not in answer.headers["content-security-policy"]


def test_without_tls_they_are_not() -> None:
    for settings in (Settings(), Settings(host="0.0.0.0"), Settings(public_url="http://lines.example.org:8080")):
        guard = Guard(lambda *_: asyncio.sleep(0), own=own_names(settings), max_body_bytes=1)
        assert "Strict-Transport-Security" not in guard.answer_headers


@pytest.mark.parametrize(
    ("address", "origin"),
    [
        ("https://Lines.Example.org/", "https://lines.example.org"),
        ("https://lines.example.org:443", "https://lines.example.org"),
        ("http://lines.example.org:443", "http://lines.example.org:443"),
        ("https://[2001:DB8::1]:8443", "https://[2001:db8::1]:8443"),
    ],
)
def test_an_origin_is_written_as_browsers_write_it(address: str, origin: str) -> None:
    assert origin_of(address) == origin


def test_in_local_mode_further_names_mean_nothing() -> None:
    own = own_names(Settings(allowed_hosts=["lines.example.org"], cors_origins=[ELSEWHERE]))
    assert own == OwnNames()
    assert not own.has("lines.example.org")
    assert not own.has("192.0.2.4")
    assert not own.may_ask(ELSEWHERE, Headers({"authorization": "Bearer cl_x"}))


def test_where_there_are_accounts_a_proxy_may_pass_requests_on() -> None:
    passed_on = Headers({"host": "localhost", "x-forwarded-for": "192.0.2.4"})
    with pytest.raises(Forbidden, match="proxy"):
        check_direct(passed_on, own_names(Settings()))
    for settings in (Settings(anonymous_role="reader"), Settings(public_url=HOME), Settings(host="0.0.0.0")):
        check_direct(passed_on, own_names(settings))


def test_a_body_that_stops_coming_is_not_waited_for() -> None:
    sent: list[dict[str, Any]] = []
    begun = [{"type": "http.request", "body": b"{", "more_body": True}]

    async def receive() -> dict[str, Any]:
        if begun:
            return begun.pop()
        await asyncio.sleep(3600)
        raise AssertionError

    async def send(message: Any) -> None:
        sent.append(message)

    async def reading(scope: Any, receive: Any, send: Any) -> None:
        while (await receive())["more_body"]:
            pass

    scope = {"type": "http", "method": "POST", "path": "/", "headers": [(b"host", b"localhost")], "query_string": b""}
    guard = Guard(reading, own=OwnNames(), max_body_bytes=100, silence=0.01)
    with pytest.raises(Exception, match="didn't come") as refused:
        run(guard(scope, receive, send))
    assert getattr(refused.value, "status", None) == 408
