"""Two people, two browsers, one image: a name each, a lease, taking over, and whose verdict stands."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import cv2
import numpy as np
import pytest
from playwright.sync_api import Browser, Page, expect

from app.formats.label_npy import write_label_npy
from app.vision.segments import Segments

DECISIONS = "**/api/images/*/decisions"
IMAGES = ("lease", "stale")
IMAGE = "[role=application][aria-busy=false]"


@pytest.fixture(scope="module")
def images(
    tmp_path_factory: pytest.TempPathFactory, label_server: Any, import_dataset: Callable[..., None]
) -> dict[str, int]:
    """Images of three kept lines each."""
    folder = tmp_path_factory.mktemp("people")
    for part in ("images", "labels"):
        (folder / part).mkdir()
    lines = [np.linspace((x, 40), (x, 260), 50, dtype=np.float32) for x in (80, 200, 320)]
    labels = write_label_npy(Segments.from_list(lines))
    for number, name in enumerate(IMAGES):
        cv2.imwrite(str(folder / "images" / f"{name}.png"), np.full((300, 400), 60 + number, np.uint8))
        (folder / "labels" / f"{name}_edge_segments_filtered.npy").write_bytes(labels)
    import_dataset(label_server, folder, "people")
    return {image["name"]: image["id"] for image in label_server.ask("/datasets/people/images")["items"]}


@pytest.fixture
def open_as(browser: Browser, label_server: Any) -> Iterator[Callable[[str, int], Page]]:
    """Open an image in a browser of one's own, under a name that is chosen on the page."""
    contexts = []
    errors: list[str] = []

    def open_as(person: str, image: int) -> Page:
        context = browser.new_context(viewport={"width": 1440, "height": 900})
        contexts.append(context)
        page = context.new_page()
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.goto(label_server.address)
        page.get_by_role("button", name="Not signed in, owner").click()
        page.get_by_label("Your name").fill(person)
        page.get_by_role("button", name="Use this name").click()
        expect(page.get_by_role("button", name=person, exact=True)).to_be_visible()
        page.goto(f"{label_server.address}/datasets/people/images/{image}")
        page.locator(IMAGE).wait_for()
        return page

    yield open_as
    for context in contexts:
        context.close()
    assert errors == []


def look_again(page: Page) -> None:
    """Renew the lease now, as a page does that one comes back to."""
    page.evaluate("document.dispatchEvent(new Event('visibilitychange'))")


def latest(server: Any, image: int) -> list[tuple[str, str]]:
    """Who gave which verdict, latest last, without the imported ones."""
    rows = server.ask(f"/images/{image}/decisions")["decisions"]
    return [(row["person"], row["verdict"]) for row in rows if row["kind"] != "import"]


def test_one_holds_an_image_and_another_takes_it_over(
    open_as: Callable[[str, int], Page], label_server: Any, images: dict[str, int]
) -> None:
    image = images["lease"]
    mara = open_as("Mara", image)
    mara.keyboard.press("Tab")
    mara.keyboard.press("x")
    expect(mara.get_by_text("All saved")).to_be_visible()
    jon = open_as("Zoë", image)
    expect(jon.get_by_text("Mara is here")).to_be_visible()
    expect(jon.locator(".lease-banner")).to_contain_text("Mara is at this image")
    jon.keyboard.press("Tab")
    jon.keyboard.press("a")
    expect(jon.get_by_text("Take it over to judge").first).to_be_visible()
    look_again(mara)
    expect(mara.get_by_text("Zoë is here")).to_be_visible()
    jon.get_by_role("button", name="Take over").click()
    expect(jon.locator(".lease-banner")).to_have_count(0)
    jon.locator(IMAGE).focus()
    jon.keyboard.press("a")
    expect(jon.get_by_text("All saved")).to_be_visible()
    assert latest(label_server, image) == [("Mara", "reject"), ("Zoë", "ambiguous")]
    look_again(mara)
    expect(mara.locator(".lease-banner")).to_contain_text("Zoë is at this image")
    expect(mara.get_by_label("Progress").locator(".shown-row__count")).to_have_text(["0", "2", "1", "0"])
    jon.goto(label_server.address)
    look_again(mara)
    expect(mara.locator(".lease-banner")).to_have_count(0)


def test_a_stale_verdict_waits_until_it_is_said_whose_stands(
    open_as: Callable[[str, int], Page], label_server: Any, images: dict[str, int]
) -> None:
    image = images["stale"]
    mara = open_as("Mara", image)
    mara.route(DECISIONS, lambda route: route.abort() if route.request.method == "POST" else route.continue_())
    for key in ("Tab", "x", "Tab", "x", "Tab", "x"):
        mara.keyboard.press(key)
    expect(mara.get_by_role("button", name="Offline, 3 kept here")).to_be_visible()
    jon = open_as("Jon", image)
    jon.get_by_role("button", name="Take over").click()
    expect(jon.locator(".lease-banner")).to_have_count(0)
    jon.locator(IMAGE).focus()
    for key in ("Tab", "a", "Tab", "a"):
        jon.keyboard.press(key)
    expect(jon.get_by_text("All saved")).to_be_visible()

    mara.unroute(DECISIONS)
    mara.evaluate("document.querySelector('button.save-indicator--offline')?.click()")
    stale = mara.get_by_role("region", name="Decided differently by others")
    expect(stale).to_contain_text("Jon decided on 2 candidates of yours meanwhile")
    expect(stale.get_by_role("listitem")).to_have_count(2)
    expect(mara.get_by_text("2 kept here")).to_be_visible()
    assert sorted(latest(label_server, image)) == [("Jon", "ambiguous")] * 2 + [("Mara", "reject")]
    mara.reload()
    mara.locator(IMAGE).wait_for()
    expect(stale.get_by_role("listitem")).to_have_count(2)
    mara.keyboard.press("Shift+T")
    expect(stale.get_by_role("listitem")).to_have_count(1)
    mara.keyboard.press("t")
    expect(stale).to_have_count(0)
    expect(mara.get_by_text("All saved")).to_be_visible()
    assert latest(label_server, image)[-1] == ("Mara", "reject")
    assert len(latest(label_server, image)) == 4
    expect(mara.get_by_label("Progress").locator(".shown-row__count")).to_have_text(["0", "0", "1", "2"])
