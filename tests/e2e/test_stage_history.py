"""How a candidate was found, asked for in the inspector and drawn on the image."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from typing import Any

import cv2
import numpy as np
import pytest
from playwright.sync_api import Page, expect

from app.formats.label_npy import write_label_npy
from app.vision.segments import Segments

POSTS = ((130, 134), (240, 245))


@pytest.fixture(scope="module")
def images(
    tmp_path_factory: pytest.TempPathFactory, label_server: Any, import_dataset: Callable[..., None]
) -> dict[str, int]:
    """Two images of a step along row 100 that posts interrupt, and of a whole one below; one has a label too."""
    folder = tmp_path_factory.mktemp("stages")
    for part in ("images", "labels"):
        (folder / part).mkdir()
    picture = np.full((200, 400), 160, np.uint8)
    picture[:100] = 60
    picture[170:] = 220
    for first, last in POSTS:
        picture[70:130, first:last] = 110
    for number, name in enumerate(("found", "labelled")):
        cv2.imwrite(str(folder / "images" / f"{name}.png"), picture + np.uint8(number))
    label = Segments.from_list([np.linspace((20, 180), (380, 180), 90, dtype=np.float32)])
    (folder / "labels" / "labelled_edge_segments_filtered.npy").write_bytes(write_label_npy(label))
    import_dataset(label_server, folder, "Stages")
    return {image["name"]: image["id"] for image in label_server.ask("/datasets/stages/images")["items"]}


@pytest.fixture(scope="module")
def found(label_server: Any, images: dict[str, int]) -> dict[str, Any]:
    """How the upper candidate of the one image was found, once it is pre-labelled."""
    run = label_server.ask("/datasets/stages/runs", {"image_ids": [images["found"]]})["id"]
    deadline = time.monotonic() + 90
    while (state := label_server.ask(f"/runs/{run}"))["status"] != "done":
        assert state["status"] != "failed", state["error"]
        assert time.monotonic() < deadline
        time.sleep(0.1)
    segments = label_server.ask(f"/images/{images['found']}/segments")["segments"]
    upper = min(segments, key=lambda segment: segment["box"][1])
    return label_server.ask(f"/segments/{upper['id']}/history")


def open_candidate(page: Page, server: Any, image: int, segment: int) -> None:
    page.goto(f"{server.address}/datasets/stages/images/{image}?segment={segment}")
    expect(page.get_by_role("application")).to_have_attribute("aria-busy", "false")


def drawn(page: Page) -> str:
    """What lies on the canvas above all others."""
    return page.locator(".label-canvas canvas").last.evaluate("canvas => canvas.toDataURL()")


def test_by_keys_alone_a_candidate_tells_its_pieces(page: Page, label_server: Any, found: dict[str, Any]) -> None:
    pieces = len(found["pieces"])
    assert pieces == len(POSTS) + 1
    open_candidate(page, label_server, found["image_id"], found["segment_id"])
    toggle = page.get_by_role("button", name="How it was found")
    expect(toggle).to_have_attribute("aria-expanded", "false")
    # what is suggested colours the selected line
    expect(page.get_by_text("By the general model")).to_be_visible(timeout=30_000)
    before = drawn(page)

    page.keyboard.press("i")
    expect(toggle).to_have_attribute("aria-expanded", "true")
    section = page.get_by_label("Selected candidate")
    expect(section.get_by_text(f"{pieces} pieces, {pieces - 1} joins")).to_be_visible()
    expect(section.get_by_role("heading", name=f"Score {found['score']:.2f}")).to_be_visible()
    expect(section.get_by_role("row")).to_have_count(1 + len(found["score_parts"]))
    opened = drawn(page)
    assert opened != before

    joins = page.get_by_label("Joins").get_by_role("button")
    expect(joins).to_have_count(pieces - 1)
    page.keyboard.press("j")
    expect(joins.first).to_be_focused()
    expect(joins.first).to_contain_text(f"{found['joins'][0]['gap']:.1f} px")
    page.wait_for_function(
        "before => document.querySelector('.label-canvas canvas:last-of-type').toDataURL() !== before", arg=opened
    )
    page.keyboard.press("j")
    expect(joins.nth(1)).to_be_focused()
    page.keyboard.press("Shift+J")
    expect(joins.first).to_be_focused()
    page.keyboard.press("Enter")
    expect(page.locator(".status-strip__scale")).to_have_text("600%")

    page.keyboard.press("Escape")
    expect(toggle).to_have_attribute("aria-expanded", "false")
    expect(page.get_by_role("application")).to_be_focused()
    page.keyboard.press("f")
    page.wait_for_function(
        "before => document.querySelector('.label-canvas canvas:last-of-type').toDataURL() === before", arg=before
    )


def test_it_stays_open_along_the_candidates(page: Page, label_server: Any, found: dict[str, Any]) -> None:
    open_candidate(page, label_server, found["image_id"], found["segment_id"])
    page.get_by_role("button", name="How it was found").click()
    summary = page.locator(".stages__summary")
    expect(summary).to_contain_text("pieces")
    asked: list[str] = []
    page.on("request", lambda request: asked.append(request.url) if request.url.endswith("/history") else None)
    with page.expect_response("**/history") as answer:
        page.keyboard.press("Tab")
    other = answer.value.json()
    assert other["segment_id"] != found["segment_id"]
    expect(summary).to_contain_text(f"{len(other['pieces'])} piece")
    page.keyboard.press("Shift+Tab")
    expect(summary).to_contain_text(f"{len(found['pieces'])} pieces")
    # what was told once isn't asked for again
    assert len(asked) == 1


def test_a_label_says_that_it_has_no_history(page: Page, label_server: Any, images: dict[str, int]) -> None:
    image = images["labelled"]
    label = label_server.ask(f"/images/{image}/segments")["segments"][0]
    open_candidate(page, label_server, image, label["id"])
    page.keyboard.press("i")
    expect(page.get_by_text("This segment was imported")).to_be_visible()


def test_what_another_version_found_is_told_calmly_and_a_dead_server_too(
    page: Page, label_server: Any, found: dict[str, Any]
) -> None:
    problem = {"title": "Not Found", "status": 404, "code": "no-history", "message": "another version of it did"}
    page.route(
        "**/history",
        lambda route: route.fulfill(status=404, content_type="application/problem+json", body=json.dumps(problem)),
    )
    open_candidate(page, label_server, found["image_id"], found["segment_id"])
    page.keyboard.press("i")
    expect(page.get_by_text("Another version of it did.")).to_be_visible()
    expect(page.get_by_role("button", name="Try again")).to_have_count(0)

    page.unroute("**/history")
    page.route("**/history", lambda route: route.abort())
    open_candidate(page, label_server, found["image_id"], found["segment_id"])
    page.keyboard.press("i")
    again = page.get_by_role("button", name="Try again")
    expect(again).to_be_visible(timeout=20_000)
    page.unroute("**/history")
    again.click()
    expect(page.locator(".stages__summary")).to_contain_text("pieces")
