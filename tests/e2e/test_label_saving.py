"""Decisions survive a network that is gone, a page that is reloaded, and a browser that stores nothing."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import cv2
import numpy as np
import pytest
from playwright.sync_api import Page, expect

from app.formats.label_npy import write_label_npy
from app.vision.segments import Segments

DECISIONS = "**/api/images/*/decisions"
IMAGES = ("reload", "memory")


@pytest.fixture(scope="module")
def images(
    tmp_path_factory: pytest.TempPathFactory, label_server: Any, import_dataset: Callable[..., None]
) -> dict[str, int]:
    folder = tmp_path_factory.mktemp("saving")
    for part in ("images", "labels"):
        (folder / part).mkdir()
    lines = [np.linspace((x, 40), (x, 260), 50, dtype=np.float32) for x in (80, 200, 320)]
    labels = write_label_npy(Segments.from_list(lines))
    for number, name in enumerate(IMAGES):
        cv2.imwrite(str(folder / "images" / f"{name}.png"), np.full((300, 400), 90 + number, np.uint8))
        (folder / "labels" / f"{name}_edge_segments_filtered.npy").write_bytes(labels)
    import_dataset(label_server, folder, "saving")
    return {image["name"]: image["id"] for image in label_server.ask("/datasets/saving/images")["items"]}


def open_image(page: Page, server: Any, image: int) -> None:
    page.goto(f"{server.address}/datasets/saving/images/{image}")
    page.locator("[role=application][aria-busy=false]").wait_for()


def cut_network(page: Page) -> None:
    """Let no decision through any more, as long as the page itself can be loaded."""
    page.route(DECISIONS, lambda route: route.abort() if route.request.method == "POST" else route.continue_())


def try_again(page: Page) -> None:
    """Press what says that it is offline, unless it has found the network by itself meanwhile."""
    page.evaluate("document.querySelector('button.save-indicator--offline')?.click()")


def counts(page: Page) -> Any:
    """Numbers of undecided, kept, ambiguous and rejected candidates."""
    return expect(page.get_by_label("Progress").locator(".shown-row__count"))


def test_a_reload_without_network_keeps_what_was_decided(page: Page, label_server: Any, images: dict[str, int]) -> None:
    image = images["reload"]
    open_image(page, label_server, image)
    cut_network(page)
    for key in ("Tab", "x", "Tab", "a", "Tab", "u"):
        page.keyboard.press(key)
    offline = page.get_by_role("button", name="Offline, 3 kept here")
    expect(offline).to_be_visible()
    page.reload()
    expect(offline).to_be_visible()
    counts(page).to_have_text(["1", "0", "1", "1"])
    assert label_server.ask(f"/images/{image}")["verdicts"]["keep"] == 3
    page.keyboard.press("z")
    expect(page.get_by_role("button", name="Offline, 4 kept here")).to_be_visible()
    page.unroute(DECISIONS)
    try_again(page)
    expect(page.get_by_text("All saved")).to_be_visible()
    history = label_server.ask(f"/images/{image}/decisions")["decisions"]
    assert [row["verdict"] for row in history][-4:] == ["reject", "ambiguous", "undecided", "keep"]
    assert history[-1]["kind"] == "undo"
    assert len({row["client_id"] for row in history}) == len(history)


def test_a_browser_without_storage_says_so_and_saves_all_the_same(
    page: Page, label_server: Any, images: dict[str, int]
) -> None:
    page.add_init_script("Object.defineProperty(window, 'indexedDB', { value: undefined });")
    image = images["memory"]
    open_image(page, label_server, image)
    cut_network(page)
    page.keyboard.press("Tab")
    page.keyboard.press("x")
    note = page.get_by_role("button", name="Offline, 1 only in this tab")
    expect(note).to_be_visible()
    page.unroute(DECISIONS)
    try_again(page)
    expect(page.get_by_text("All saved")).to_be_visible()
    assert label_server.ask(f"/images/{image}")["verdicts"]["reject"] == 1
