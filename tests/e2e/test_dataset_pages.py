"""The pages around labelling: make a dataset, bring images in, run the pipeline, tidy up."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from playwright.sync_api import Locator, Page, expect


def draw_lines(path: Path, seed: int) -> Path:
    """Write a picture with a few long edges."""
    rng = np.random.default_rng(seed)
    image = np.full((240, 320), 90, np.uint8)
    for x in (40, 140, 240):
        cv2.rectangle(image, (x, 20), (x + 40, 220), int(rng.integers(150, 255)), -1, cv2.LINE_AA)
    cv2.imwrite(str(path), image)
    return path


def wait_for(page: Page, condition: Callable[[], bool]) -> None:
    for _ in range(100):
        if condition():
            return
        page.wait_for_timeout(50)
    pytest.fail("it didn't happen within 5 s")


def make_dataset(page: Page, server: Any, name: str) -> None:
    page.goto(server.address)
    page.get_by_role("button", name="Empty dataset").or_(page.get_by_role("button", name="New dataset")).click()
    page.get_by_role("textbox").fill(name)
    page.keyboard.press("Enter")
    expect(page.get_by_role("heading", name=name)).to_be_visible()


def add_images(page: Page, files: list[Path]) -> None:
    page.locator("input[type=file]:not([webkitdirectory])").first.set_input_files(files)


def tiles(page: Page) -> Locator:
    return page.get_by_role("list", name="Images").get_by_role("link")


def test_a_newcomer_gets_from_nothing_to_candidates(page: Page, serve: Callable[..., Any], tmp_path: Path) -> None:
    server = serve()
    page.goto(server.address)
    expect(page.get_by_text("Drop images, a folder or a zip here")).to_be_visible()
    make_dataset(page, server, "Downtown")
    (tmp_path / "notes.png").write_bytes(b"no image")
    add_images(page, [draw_lines(tmp_path / "one.png", 1), draw_lines(tmp_path / "two.png", 2), tmp_path / "notes.png"])
    expect(tiles(page)).to_have_count(2)
    failed = page.get_by_role("listitem").filter(has_text="notes.png")
    expect(failed).to_contain_text("no image")

    page.get_by_role("button", name="Pre-label", exact=True).click()
    page.get_by_label("Minimum length").fill("50")
    page.get_by_role("button", name="Pre-label 2 images").click()
    expect(tiles(page).first).to_have_accessible_name(re.compile(r"\b[1-9]\d* candidate"), timeout=60_000)
    expect(page.get_by_text("0 of 2 done")).to_be_visible()
    run = server.ask("/datasets/downtown/runs")[0]
    assert run["parameters"]["min_length"] == 50

    page.keyboard.press("l")
    expect(page.get_by_label("Progress").locator(".panel-progress")).to_contain_text("judged")
    page.go_back()
    expect(page.get_by_role("heading", name="Downtown")).to_be_visible()


def test_what_is_deleted_comes_back_by_undo(page: Page, server: Any) -> None:
    make_dataset(page, server, "Mistake")
    page.goto(server.address)
    page.get_by_role("button", name="More for Mistake").click()
    page.get_by_role("button", name="Delete").click()
    expect(page.get_by_role("heading", name="Mistake")).to_have_count(0)
    assert "mistake" not in [dataset["slug"] for dataset in server.ask("/datasets")]
    page.get_by_role("button", name="Undo").click()
    expect(page.get_by_role("heading", name="Mistake")).to_be_visible()
    assert "mistake" in [dataset["slug"] for dataset in server.ask("/datasets")]


def test_filters_live_in_the_address(page: Page, server: Any, tmp_path: Path) -> None:
    make_dataset(page, server, "Filtered")
    add_images(page, [draw_lines(tmp_path / f"{name}.png", n) for n, name in enumerate(("alpha", "beta"), 30)])
    expect(tiles(page)).to_have_count(2)
    page.get_by_placeholder("Search names", exact=False).fill("alp")
    expect(page).to_have_url(f"{server.address}/datasets/filtered?search=alp")
    expect(tiles(page)).to_have_count(1)
    page.reload()
    expect(tiles(page)).to_have_count(1)
    expect(tiles(page).first).to_have_accessible_name(re.compile("alpha"))


def test_many_images_are_changed_and_deleted_at_once(page: Page, server: Any, tmp_path: Path) -> None:
    make_dataset(page, server, "Bulk")
    add_images(page, [draw_lines(tmp_path / f"{n}.png", n) for n in range(40, 43)])
    expect(tiles(page)).to_have_count(3)
    tiles(page).first.focus()
    page.keyboard.press("Control+a")
    page.get_by_role("button", name="Sequence").click()
    page.get_by_label("Sequence of the selected images").fill("drive 7")
    page.keyboard.press("Enter")
    wait_for(page, lambda: {i["sequence"] for i in server.ask("/datasets/bulk/images")["items"]} == {"drive 7"})
    page.get_by_role("button", name="Delete", exact=True).click()
    expect(tiles(page)).to_have_count(0)
    page.get_by_role("button", name="Undo").click()
    expect(tiles(page)).to_have_count(3)


def test_unknown_addresses_lead_back(page: Page, server: Any) -> None:
    page.goto(f"{server.address}/datasets/nowhere")
    expect(page.get_by_role("heading", name="There is no such dataset")).to_be_visible()
    page.get_by_role("link", name="All datasets", exact=True).click()
    expect(page).to_have_url(f"{server.address}/")
    page.goto(f"{server.address}/nowhere/at/all")
    page.locator("main a[href='/']").click()
    expect(page).to_have_url(f"{server.address}/")


def test_the_api_is_documented_without_the_internet(page: Page, server: Any) -> None:
    elsewhere: list[str] = []
    page.on("request", lambda request: elsewhere.append(request.url) if server.address not in request.url else None)
    page.goto(f"{server.address}/api/docs")
    expect(page.get_by_role("heading", name="REST API")).to_be_visible()
    expect(page.get_by_text("/api/images/{image_id}/decisions").first).to_be_visible()
    assert [url for url in elsewhere if not url.startswith(("data:", "blob:"))] == []
