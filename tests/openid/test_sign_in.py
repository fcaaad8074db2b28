"""Signing in through a real provider: newcomers, invitations, linked accounts, and answers nobody asked for."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from datetime import timedelta
from pathlib import Path
from typing import Any
from urllib.parse import parse_qs, urlsplit

import pytest
from fastapi.testclient import TestClient
from pydantic import SecretStr
from sqlalchemy import make_url, select

from app.api.application import create_application
from app.api.own_paths import own_path
from app.clock import utc_now
from app.db.models import Event, Identity, User
from app.services import invitations
from app.services.accounts import add_account
from app.services.events import Actor
from app.settings import Settings
from tests.openid.real_provider import CLIENT, SECRET, answer_of, start_provider

HOME = "https://lines.example.org"
PEOPLE = {
    "alice": {"preferred_username": "Alice", "email": "alice@example.org", "email_verified": True},
    "bob": {"email": "bob@example.org", "email_verified": True},
    "carol": {"preferred_username": "Alice", "email": "alice@example.org", "email_verified": True},
    "dan": {"preferred_username": "owner"},
}
Walk = Callable[..., Any]


@pytest.fixture(scope="module")
def issuer() -> Iterator[str]:
    process, address = start_provider(f"{HOME}/api/session/openid/callback", PEOPLE)
    yield address
    process.terminate()
    process.wait(10)
    if process.stdout:
        process.stdout.close()


@pytest.fixture
def settings(tmp_path: Path, sqlite_template: Path, issuer: str) -> Settings:
    settings = Settings(
        data_dir=tmp_path / "data",
        workers=1,
        public_url=HOME,
        openid_issuer=issuer,
        openid_client_id=CLIENT,
        openid_client_secret=SecretStr(SECRET),
        openid_name="Example",
    )
    settings.data_dir.mkdir()
    shutil.copy(sqlite_template, str(make_url(settings.database_address).database))
    return settings


@pytest.fixture
def serve(settings: Settings) -> Iterator[Callable[..., TestClient]]:
    open_clients: list[TestClient] = []

    def serve(**changed: Any) -> TestClient:
        client = TestClient(create_application(settings.model_copy(update=changed)), base_url=HOME)
        open_clients.append(client.__enter__())
        return client

    yield serve
    for client in open_clients:
        client.__exit__(None, None, None)


def database(client: TestClient) -> Any:
    return client.app.state.server.database  # type: ignore[attr-defined]


def begin(client: TestClient, next_path: str = "/", **more: str) -> str:
    started = client.get("/api/session/openid/start", params={"next": next_path, **more}, follow_redirects=False)
    assert started.status_code == 302, started.text
    return started.headers["location"]


def enter(client: TestClient, person: str, next_path: str = "/", **more: str) -> Any:
    return client.get(answer_of(person, begin(client, next_path, **more)), follow_redirects=False)


def problem(answer: Any) -> str:
    """Return the code that the page has a sentence for."""
    return answer.text.partition("/sign-in?problem=")[2].partition('"')[0]


def test_somebody_new_gets_an_account_and_comes_back_to_it(serve: Callable[..., TestClient]) -> None:
    client = serve(openid_role="submitter")
    assert client.get("/api/session/providers").json() == [{"name": "Example", "start": "/api/session/openid/start"}]
    started = client.get("/api/session/openid/start?next=/datasets", follow_redirects=False)
    kept = started.headers["set-cookie"]
    assert kept.startswith("clearlines_openid=")
    for attribute in ("HttpOnly", "SameSite=lax", "Secure", "Path=/api/session/openid", "Max-Age=600"):
        assert attribute in kept
    answer = client.get(answer_of("alice", started.headers["location"]), follow_redirects=False)
    assert answer.status_code == 200
    # a page of ours goes on, so that the browser sends the Strict cookie along
    assert 'http-equiv="refresh" content="0;url=/datasets"' in answer.text
    cookies = answer.headers.get_list("set-cookie")
    session = next(cookie for cookie in cookies if cookie.startswith("clearlines_session="))
    for attribute in ("HttpOnly", "SameSite=strict", "Secure", "Path=/api"):
        assert attribute in session
    assert any(cookie.startswith('clearlines_openid="";') for cookie in cookies)
    me = client.get("/api/me").json()
    assert (me["name"], me["role"], me["anonymous"]) == ("Alice", "submitter", False)
    assert me["account"]["email"] == "alice@example.org"

    client.cookies.clear()
    enter(client, "alice")
    assert client.get("/api/me").json()["account"]["id"] == me["account"]["id"]


def test_an_email_or_a_name_alone_leads_to_nobody_s_account(serve: Callable[..., TestClient]) -> None:
    client = serve(openid_role="reader")
    with database(client).write() as session:
        add_account(session, "Alice", "admin", utc_now(), Actor(None), email="alice@example.org")
    enter(client, "carol")
    me = client.get("/api/me").json()
    assert (me["name"], me["role"]) == ("Alice 2", "reader")
    client.cookies.clear()
    enter(client, "dan")
    assert client.get("/api/me").json()["name"] == "owner 2"  # the person of local mode


def test_without_a_role_for_newcomers_an_invitation_is_needed(serve: Callable[..., TestClient]) -> None:
    client = serve()
    answer = enter(client, "bob")
    assert answer.status_code == 403
    assert problem(answer) == "not-invited"
    assert "clearlines_session" not in client.cookies
    with database(client).write() as session:
        made = invitations.invite(session, "annotator", utc_now(), Actor("ada"), lifetime=timedelta(days=1))
    started = client.post(
        "/api/session/openid/start", json={"next": "/", "invitation": made.text}, headers={"origin": HOME}
    )
    assert made.text not in started.json()["address"]
    client.get(answer_of("bob", started.json()["address"]))
    assert client.get("/api/me").json()["role"] == "annotator"
    assert client.get("/api/me").json()["name"] == "bob"
    # it is used up: somebody else doesn't get in by it
    client.cookies.clear()
    again = client.post("/api/session/openid/start", json={"invitation": made.text}, headers={"origin": HOME})
    refused = client.get(answer_of("carol", again.json()["address"]), follow_redirects=False)
    assert refused.status_code == 404
    with database(client).read() as session:
        assert len(session.scalars(select(Identity)).all()) == 1


def test_an_account_is_linked_by_whoever_is_signed_in_to_it(serve: Callable[..., TestClient]) -> None:
    client = serve(openid_role="reader")
    assert client.get("/api/session/openid/start?link=true", follow_redirects=False).status_code == 401
    enter(client, "alice")
    mine = client.get("/api/me").json()["account"]["id"]
    linked = enter(client, "bob", "/account", link="true")
    assert linked.status_code == 200
    assert client.get("/api/me").json()["account"]["id"] == mine
    client.cookies.clear()
    enter(client, "bob")
    assert client.get("/api/me").json()["account"]["id"] == mine
    client.cookies.clear()
    enter(client, "carol")
    taken = enter(client, "bob", "/account", link="true")
    assert taken.status_code == 409
    assert "/account?problem=conflict" in taken.text


def test_what_is_linked_is_unlinked_unless_nobody_could_come_in_any_more(serve: Callable[..., TestClient]) -> None:
    client = serve(openid_role="reader")
    enter(client, "alice")
    mine = client.get("/api/me").json()["account"]["id"]
    (first,) = client.get("/api/account").json()["identities"]
    sent = {"origin": HOME}
    refused = client.delete(f"/api/account/identities/{first['id']}", headers=sent)
    assert refused.status_code == 409
    assert "only way to sign in" in refused.json()["message"]
    assert "choose a password" in refused.json()["hint"]
    enter(client, "bob", "/account", link="true")
    assert client.delete(f"/api/account/identities/{first['id']}", headers=sent).status_code == 204
    (second,) = client.get("/api/account").json()["identities"]
    assert second["id"] != first["id"]
    assert client.delete(f"/api/account/identities/{second['id']}", headers=sent).status_code == 409
    assert client.post("/api/account/password", json={"new": "nine brown owls"}, headers=sent).status_code == 204
    client.cookies.clear()
    enter(client, "carol")  # somebody else
    assert client.delete(f"/api/account/identities/{second['id']}", headers=sent).status_code == 404
    client.cookies.clear()
    name = {"name": "Alice", "password": "nine brown owls"}
    assert client.post("/api/session", json=name, headers=sent).status_code == 200
    assert client.delete(f"/api/account/identities/{second['id']}", headers=sent).status_code == 204
    assert client.get("/api/account").json()["identities"] == []
    client.cookies.clear()
    enter(client, "bob")  # is somebody new now
    assert client.get("/api/me").json()["account"]["id"] != mine
    with database(client).read() as session:
        kinds = session.scalars(select(Event.kind).where(Event.kind == "user.unlinked")).all()
    assert len(kinds) == 2


@pytest.mark.parametrize(
    ("site", "status"), [("same-origin", 302), ("same-site", 403), ("cross-site", 403), ("none", 403)]
)
def test_linking_begins_on_a_page_of_this_site_alone(serve: Callable[..., TestClient], site: str, status: int) -> None:
    client = serve(openid_role="reader")
    enter(client, "alice")
    sent = {"sec-fetch-site": site}
    begun = client.get("/api/session/openid/start?link=true", headers=sent, follow_redirects=False)
    assert begun.status_code == status


def test_a_disabled_account_stays_closed(serve: Callable[..., TestClient]) -> None:
    client = serve(openid_role="reader")
    enter(client, "alice")
    with database(client).write() as session:
        session.scalars(select(User)).one().disabled_at = utc_now()
    client.cookies.clear()
    assert enter(client, "alice").status_code == 403
    assert client.get("/api/me").json()["anonymous"]


def test_an_answer_is_good_once_and_only_in_the_browser_that_asked(serve: Callable[..., TestClient]) -> None:
    client = serve(openid_role="reader")
    location = begin(client)
    kept = client.cookies["clearlines_openid"]
    answer = answer_of("alice", location)
    state = parse_qs(urlsplit(answer).query)["state"][0]
    client.cookies.clear()
    assert client.get(answer, follow_redirects=False).status_code == 401  # another browser
    header = {"cookie": f"clearlines_openid={kept}"}
    forged = answer.replace(state, "x" * len(state))
    assert client.get(forged, headers=header, follow_redirects=False).status_code == 401
    assert client.get(answer, headers=header, follow_redirects=False).status_code == 200
    client.cookies.clear()
    assert client.get(answer, headers=header, follow_redirects=False).status_code == 401  # played once more
    assert client.get("/api/me").json()["anonymous"]


def test_somebody_who_says_no_at_the_provider_is_told(serve: Callable[..., TestClient]) -> None:
    client = serve(openid_role="reader")
    state = parse_qs(urlsplit(begin(client)).query)["state"][0]
    callback = f"/api/session/openid/callback?error=access_denied&state={state}"
    answer = client.get(callback, follow_redirects=False)
    assert answer.status_code == 401
    assert problem(answer) == "unauthenticated"


@pytest.mark.parametrize(
    "given",
    [
        "https://evil.example",
        "//evil.example",
        "/\\evil.example",
        "/\t/evil.example",
        "javascript:alert(1)",
        "",
        "x",
        "/é",
    ],
)
def test_it_goes_on_to_paths_of_its_own_alone(given: str) -> None:
    assert own_path(given) == "/"


def test_own_paths_are_kept_whole() -> None:
    assert own_path("/datasets/a?b=c#d") == "/datasets/a?b=c#d"
    assert own_path("/") == "/"


def test_in_local_mode_nobody_signs_in(tmp_path: Path) -> None:
    with TestClient(create_application(Settings(data_dir=tmp_path)), base_url="http://127.0.0.1") as client:
        assert client.get("/api/session/providers").json() == []
        assert client.get("/api/session/openid/start", follow_redirects=False).status_code == 409
