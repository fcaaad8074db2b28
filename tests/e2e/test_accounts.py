"""A server that others reach: the first admin, an invitation, a second person, and the end of an account."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, Page, expect

from app.clock import utc_now
from app.commands.stores import opened_stores
from app.openid.identified import Identified
from app.services.accounts import account_named
from app.services.events import Actor
from app.services.identities import link_identified
from app.settings import Settings

PASSWORD = "seven horses at dawn"


@pytest.fixture(scope="module")
def hosted(
    tmp_path_factory: pytest.TempPathFactory, start_server: Callable[..., Any], unused_port: Callable[[], int]
) -> Iterator[Any]:
    """A hosted server with one admin, ada; behind no proxy, so its public address is its own."""
    data = tmp_path_factory.mktemp("hosted") / "data"
    port = unused_port()
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("CLEARLINES_PUBLIC_URL", f"http://127.0.0.1:{port}")
        make_admin(data)
        link_a_provider(data, "ada")
        server = start_server(data, port=port)
    yield server
    server.stop()


def make_admin(data: Path) -> None:
    clearlines = Path(sys.executable).with_name("clearlines")
    subprocess.run(
        [clearlines, "user", "create", "ada", "--role", "admin", "--password-stdin", "--data", data],
        input=f"{PASSWORD}\n",
        text=True,
        check=True,
    )


def link_a_provider(data: Path, name: str) -> None:
    with opened_stores(Settings(data_dir=data)) as (database, _), database.write() as session:
        found = Identified("https://login.example.org/of", "17", None, None)
        link_identified(session, account_named(session, name).id, found, utc_now(), Actor(name))


@pytest.fixture
def open_page(browser: Browser, hosted: Any) -> Iterator[Callable[[str], Page]]:
    """Open a page in a browser of its own."""
    contexts = []
    errors: list[str] = []

    def open_page(path: str) -> Page:
        context = browser.new_context(viewport={"width": 1280, "height": 800})
        contexts.append(context)
        page = context.new_page()
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.goto(path if path.startswith("http") else f"{hosted.address}{path}")
        return page

    yield open_page
    for context in contexts:
        context.close()
    assert errors == []


def sign_in(page: Page, name: str, password: str) -> None:
    page.get_by_role("textbox", name="Name", exact=True).fill(name)
    page.get_by_label("Password", exact=True).fill(password)
    page.get_by_role("main").get_by_role("button", name="Sign in").first.click()


def test_from_the_first_admin_to_the_end_of_an_account(open_page: Callable[[str], Page], hosted: Any) -> None:
    ada = open_page("/people")
    expect(ada.get_by_role("heading", name="Only administrators manage accounts")).to_be_visible()
    ada.get_by_role("main").get_by_role("link", name="Sign in").click()
    sign_in(ada, "ada", "the wrong password")
    expect(ada.get_by_role("alert")).to_contain_text("This name and password don't fit")
    sign_in(ada, "ADA", PASSWORD)
    expect(ada.get_by_role("heading", name="Accounts")).to_be_visible()

    ada.get_by_role("combobox", name="Role", exact=True).select_option("annotator")
    ada.get_by_role("button", name="Make a link").click()
    link = ada.get_by_label("Invitation link", exact=True).input_value()

    grace = open_page(link)
    expect(grace.get_by_text("annotator", exact=True)).to_be_visible()
    grace.get_by_role("textbox", name="Name").fill("grace")
    grace.get_by_label("Password", exact=True).fill("short")
    grace.get_by_role("button", name="Make the account").click()
    expect(grace.get_by_role("alert")).to_contain_text("10")
    grace.get_by_label("Password", exact=True).fill(PASSWORD)
    grace.get_by_role("button", name="Make the account").click()
    expect(grace.get_by_role("button", name="grace, annotator")).to_be_visible()
    expect(open_page(link).get_by_role("heading", name="This invitation is not good any more")).to_be_visible()

    grace.get_by_role("button", name="grace, annotator").click()
    expect(grace.get_by_role("link", name="People")).to_have_count(0)
    grace.get_by_role("link", name="Account", exact=True).click()
    grace.get_by_label("Label").fill("cluster")
    grace.get_by_role("button", name="Make a token").click()
    token = grace.get_by_label("Your new token", exact=True).input_value()
    assert token.startswith("cl_")
    expect(grace.get_by_role("row", name="cluster")).to_contain_text("submitter")
    me = grace.request.get(f"{hosted.address}/api/me", headers={"Authorization": f"Bearer {token}"}).json()
    assert (me["name"], me["role"]) == ("grace", "submitter")

    ada.reload()
    ada.get_by_label("Role of grace").select_option("maintainer")
    expect(ada.get_by_text("grace is maintainer now.")).to_be_visible()
    grace.reload()
    expect(grace.get_by_role("button", name="grace, maintainer")).to_be_visible()
    ada.get_by_role("button", name="More for grace").click()
    ada.get_by_role("button", name="Disable").click()
    expect(ada.get_by_text("grace is disabled and signed out everywhere.")).to_be_visible()
    grace.reload()
    expect(grace.get_by_role("link", name="Sign in").first).to_be_visible()
    grace.goto(f"{hosted.address}/sign-in")
    sign_in(grace, "grace", PASSWORD)
    expect(grace.get_by_role("alert")).to_contain_text("don't fit")

    ada.get_by_role("button", name="More for grace").click()
    ada.get_by_role("link", name="What they did").click()
    expect(ada.get_by_role("row", name="Token: created")).to_be_visible()
    assert "person=grace" in ada.url
    expect(ada.get_by_role("row", name="Invitation: created")).to_have_count(0)
    ada.get_by_role("button", name="Show all").click()
    expect(ada.get_by_role("row", name="User: disabled")).to_contain_text("name: grace")


def test_the_last_admin_stays_and_the_state_of_the_server_is_told(open_page: Callable[[str], Page]) -> None:
    page = open_page("/sign-in?next=/people")
    sign_in(page, "ada", PASSWORD)
    page.get_by_label("Role of ada").select_option("reader")
    expect(page.get_by_role("alert").or_(page.locator(".toast--danger"))).to_be_visible()
    expect(page.get_by_label("Role of ada")).to_have_value("admin")
    page.get_by_role("button", name="ada, admin").click()
    page.get_by_role("link", name="Account", exact=True).click()
    other_ways = page.get_by_role("region", name="Other ways in")
    expect(other_ways).to_contain_text("login.example.org")
    other_ways.get_by_role("button", name="Unlink").click()
    expect(other_ways).to_have_count(0)
    page.get_by_role("button", name="ada, admin").click()
    page.get_by_role("link", name="Status").click()
    expect(page.get_by_text("Everything is as it should be.")).to_be_visible()
    expect(page.get_by_role("row", name="Submissions")).to_be_visible()
    page.get_by_role("button", name="ada, admin").click()
    page.get_by_role("button", name="Sign out").click()
    expect(page.get_by_role("heading", name="Only administrators see the state of the server")).to_be_visible()
