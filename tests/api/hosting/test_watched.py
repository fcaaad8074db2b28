"""Each request has an id, is logged without secrets and counted; what goes wrong is told with the id."""

from __future__ import annotations

import io
import json
import logging
from collections.abc import Iterator
from typing import Any

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient
from pydantic import SecretStr
from starlette.requests import ClientDisconnect

from app.api.metrics import Metrics
from app.api.observing import Mishaps, Observed, template_of
from app.clock import utc_now
from app.logs import configure_logs
from app.services.accounts import add_account
from app.services.events import Actor
from tests.api.hosting.conftest import HOME, Serve, server_of, token_for

PASSWORD = "seven grey herons"
SCRAPE = "scrape-with-this"


@pytest.fixture(scope="module")
def watched(serve: Serve) -> TestClient:
    return serve(metrics_token=SecretStr(SCRAPE))


@pytest.fixture
def log() -> Iterator[io.StringIO]:
    """All that is logged at the level debug, secrets that only the pattern of a line would hide included."""
    root, own = logging.getLogger(), logging.getLogger("app")
    levels = root.level, own.level
    stream = io.StringIO()
    handler = configure_logs("json", "debug", stream=stream)
    yield stream
    root.removeHandler(handler)
    root.setLevel(levels[0])
    own.setLevel(levels[1])


def lines(log: io.StringIO, event: str = "request") -> list[dict[str, Any]]:
    found = [json.loads(line) for line in log.getvalue().splitlines()]
    return [line for line in found if line["event"] == event]


def test_a_request_is_logged_by_its_template(watched: TestClient, log: io.StringIO) -> None:
    ada = token_for(watched, "ada", "annotator")
    answer = watched.get("/api/images/12345?secret=hunter2", headers=ada)
    (line,) = lines(log)
    assert line["request_id"] == answer.headers["x-request-id"]
    assert (line["method"], line["path"], line["status"]) == ("GET", "/api/images/{image_id}", 404)
    assert (line["viewer"], line["level"]) == ("ada", "info")
    assert line["ms"] >= 0
    assert "hunter2" not in log.getvalue()


@pytest.mark.parametrize(
    ("given", "taken"),
    [
        ("proxy-0123-abcd", True),
        ("x" * 64, True),
        ("short", False),
        ("x" * 65, False),
        ("with space", False),
        ("a;b=c-12345678", False),
        ("", False),
    ],
)
def test_an_id_of_a_proxy_is_taken_where_it_is_one(watched: TestClient, given: str, taken: bool) -> None:
    told = watched.get("/api/health", headers={"x-request-id": given}).headers["x-request-id"]
    assert (told == given) is taken
    assert len(told) >= 8


def test_no_secret_is_in_the_log_whatever_one_does(watched: TestClient, log: io.StringIO) -> None:
    with server_of(watched).database.write() as session:
        password_hash = server_of(watched).passwords.hash_of(PASSWORD)
        add_account(session, "root", "admin", utc_now(), Actor(None), password_hash=password_hash)
    page = {"origin": HOME}
    watched.post("/api/session", json={"name": "root", "password": "a wrong one that nobody has"}, headers=page)
    assert watched.post("/api/session", json={"name": "root", "password": PASSWORD}, headers=page).status_code == 200
    cookie = watched.cookies["clearlines_session"]
    invited = watched.post("/api/invitations", json={"role": "reader"}, headers=page).json()
    watched.post("/api/invitations/look", json={"secret": invited["secret"]}, headers=page)
    watched.post("/api/invitations/look", json={"secret": "an-invitation-of-nobody"}, headers=page)
    token = watched.post("/api/account/tokens", json={"label": "mine"}, headers=page).json()["token"]
    watched.cookies.clear()
    watched.get("/api/me", headers={"authorization": f"Bearer {token}"})
    watched.get("/api/me", headers={"cookie": "clearlines_session=a-session-of-nobody"})
    watched.get("/metrics", headers={"authorization": f"Bearer {SCRAPE}"})
    assert len(lines(log)) >= 9
    for secret in (PASSWORD, "a wrong one", cookie, invited["secret"], "of-nobody", token, SCRAPE, password_hash):
        assert secret not in log.getvalue()


def failing_application(error: Exception) -> tuple[TestClient, Metrics]:
    metrics = Metrics()
    application = FastAPI()

    @application.get("/api/images/{image_id}")
    def fail(image_id: str) -> None:
        raise error

    application.add_middleware(Mishaps)
    application.add_middleware(Observed, metrics=metrics, level=logging.INFO, new_id=lambda: "the-id-of-it")
    return TestClient(application), metrics


def test_a_mistake_of_ours_is_logged_and_told_with_the_id(log: io.StringIO) -> None:
    client, metrics = failing_application(RuntimeError("the inside of it"))
    answer = client.get("/api/images/5")
    assert answer.status_code == 500
    assert answer.headers["content-type"] == "application/problem+json"
    assert answer.headers["x-request-id"] == "the-id-of-it"
    assert answer.json()["details"] == {"request_id": "the-id-of-it"}
    assert "the inside of it" not in answer.text
    (line,) = lines(log, "/api/images/{image_id} failed")
    assert line["request_id"] == "the-id-of-it"
    assert "RuntimeError: the inside of it" in line["exception"]
    assert 'status="5xx",template="/api/images/{image_id}"' in metrics.text().decode()


def test_a_client_that_goes_away_is_no_mistake(log: io.StringIO) -> None:
    client, _ = failing_application(ClientDisconnect())
    with pytest.raises(Exception):  # noqa: B017, PT011 - nothing is answered, which each client tells in its own words
        client.get("/api/images/5")
    assert lines(log, "/api/images/{image_id} failed") == []
    (line,) = lines(log)
    assert line["status"] == 499


@pytest.mark.parametrize(
    ("path", "template"),
    [
        ("/api/datasets/street/images", "/api/datasets/{slug}/images"),
        ("/api/nothing/at/all", "/api/?"),
        ("/api", "/api/?"),
        ("/metrics", "/api/metrics"),
        ("/invitation", "page"),
        ("/apix", "page"),
    ],
)
def test_templates_are_few_whatever_is_asked(path: str, template: str) -> None:
    assert template_of("GET", path) == template


def test_metrics_are_for_admins_and_for_the_token(watched: TestClient) -> None:
    for path in ("/metrics", "/api/metrics"):
        assert watched.get(path).status_code == 401
        assert watched.get(path, headers={"authorization": "Bearer another"}).status_code == 401
        assert watched.get(path, headers={"authorization": f"Bearer {SCRAPE}"}).status_code == 200
    assert watched.get("/metrics", headers=token_for(watched, "mo", "maintainer")).status_code == 403
    assert watched.get("/metrics", headers=token_for(watched, "boss", "admin")).status_code == 200
    # it opens nothing else
    assert watched.get("/api/status", headers={"authorization": f"Bearer {SCRAPE}"}).status_code == 401


def test_metrics_tell_what_was_done_and_how_things_are(watched: TestClient) -> None:
    admin = token_for(watched, "chief", "admin")
    watched.get("/api/nothing/here", headers=admin)
    server_of(watched).metrics.work_ended("detect", "done", 0.5)
    text = watched.get("/metrics", headers=admin).text
    for line in (
        'clearlines_request_seconds_count{method="GET",status="4xx",template="/api/?"}',
        'clearlines_work_seconds_count{kind="detect",outcome="done"} 1.0',
        "clearlines_requests_in_flight 1.0",
        "clearlines_database_up 1.0",
        'clearlines_queue_depth{kind="images",state="waiting"} 0.0',
        'clearlines_queue_oldest_wait_seconds{kind="submissions"} 0.0',
        "clearlines_dispatcher_active 1.0",
        'clearlines_disk_bytes{disk="blobs",state="free"}',
        'clearlines_database_connections{state="used"}',
        "clearlines_sign_in_failures_total",
        "clearlines_upload_bytes_total",
        "process_resident_memory_bytes",
    ):
        assert line in text, line
