"""Labelling by keyboard alone, in a real browser, on a real server."""

from __future__ import annotations

import io
import re
import time
import urllib.request
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from playwright.sync_api import Page, expect


def draw_lines(path: Path, seed: int) -> None:
    """Write a picture with a few long edges."""
    rng = np.random.default_rng(seed)
    image = np.full((300, 400), 90, np.uint8)
    for x in (40, 160, 280):
        cv2.rectangle(image, (x, 20), (x + 50, 270), int(rng.integers(150, 255)), -1, cv2.LINE_AA)
    cv2.imwrite(str(path), image)


def draw_street(parent: Path) -> Path:
    """A folder of two pictures."""
    folder = parent / "street"
    folder.mkdir()
    for seed, name in enumerate(("one", "two")):
        draw_lines(folder / f"{name}.png", seed)
    return folder


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return draw_street(tmp_path)


def wait_for_run(server: Any, slug: str) -> list[dict[str, Any]]:
    """Wait until every image of the dataset has candidates; return the images."""
    for _ in range(600):
        run = server.ask(f"/datasets/{slug}")["latest_run"]
        if run and run["status"] == "done":
            return server.ask(f"/datasets/{slug}/images")["items"]
        time.sleep(0.1)
    pytest.fail("the run didn't finish")


@pytest.fixture(scope="module")
def images(
    server: Any, import_dataset: Callable[..., None], tmp_path_factory: pytest.TempPathFactory
) -> list[dict[str, Any]]:
    """Two pre-labelled images."""
    import_dataset(server, draw_street(tmp_path_factory.mktemp("labelling")), "By keys")
    server.ask("/datasets/by-keys/runs", {})
    return wait_for_run(server, "by-keys")


def judged(page: Page) -> str:
    return page.get_by_label("Progress").locator(".panel-progress").inner_text()


def test_two_images_are_labelled_by_keys_alone_and_exported(
    page: Page, serve: Callable[..., Any], folder: Path
) -> None:
    server = serve(str(folder))
    images = wait_for_run(server, "street")
    total = images[0]["candidates"]
    assert total >= 4
    page.goto(f"{server.address}/datasets/street/images/{images[0]['id']}")
    progress = page.get_by_label("Progress").locator(".panel-progress")
    expect(progress).to_have_text(f"0 of {total} judged")

    page.keyboard.press("k")
    expect(progress).to_have_text(f"1 of {total} judged")
    page.keyboard.press("k")
    page.keyboard.press("a")
    expect(progress).to_have_text(f"3 of {total} judged")
    page.keyboard.press("z")
    expect(progress).to_have_text(f"2 of {total} judged")
    expect(page.get_by_text("All saved")).to_be_visible()

    page.reload()
    expect(progress).to_have_text(f"2 of {total} judged")
    page.keyboard.press("z")
    expect(progress).to_have_text(f"1 of {total} judged")
    page.keyboard.press("Shift+Z")
    expect(progress).to_have_text(f"2 of {total} judged")

    page.keyboard.press("Enter")
    expect(page.get_by_text("undecided", exact=False).first).to_be_visible()
    assert page.url.split("?")[0].endswith(f"/images/{images[0]['id']}")
    page.keyboard.press("r")
    expect(progress).to_have_text(f"{total} of {total} judged")
    page.keyboard.press("Enter")
    expect(page).to_have_url(re.compile(rf"/datasets/street/images/{images[1]['id']}(\?|$)"))

    expect(progress).to_have_text(f"0 of {images[1]['candidates']} judged")
    page.keyboard.press("Tab")
    page.keyboard.press("k")
    page.keyboard.press("r")
    expect(progress).to_have_text(f"{images[1]['candidates']} of {images[1]['candidates']} judged")
    page.keyboard.press("Enter")
    expect(page.get_by_role("heading", name="All images are done")).to_be_visible()

    with page.expect_download() as download:
        page.get_by_role("link", name="Export labels").click()
    check_export(Path(download.value.path()), server, images)


def check_export(path: Path, server: Any, images: list[dict[str, Any]]) -> None:
    """Every label file holds exactly the kept segments, point by point."""
    with zipfile.ZipFile(path) as archive:
        for image, kept in zip(images, (2, 1), strict=True):
            segments = server.ask(f"/images/{image['id']}/segments")["segments"]
            points = read_points(server, image["id"])
            expected = [points[segment["id"]] for segment in segments if segment["verdict"] == "keep"]
            assert len(expected) == kept
            content = archive.read(f"labels/{image['name']}_edge_segments_filtered.npy")
            loaded = np.load(io.BytesIO(content), allow_pickle=True)
            assert loaded.dtype == object
            assert [len(line) for line in loaded] == [len(line) for line in expected]
            for line, wanted in zip(loaded, expected, strict=True):
                np.testing.assert_array_equal(line.reshape(-1, 2), wanted)


def read_points(server: Any, image_id: int) -> dict[int, np.ndarray]:
    with urllib.request.urlopen(f"{server.address}/api/images/{image_id}/points", timeout=30) as answer:
        content = answer.read()
    count, total = np.frombuffer(content, "<u4", 2, 8)
    ids = np.frombuffer(content, "<u4", count, 16)
    offsets = np.frombuffer(content, "<u4", count + 1, 16 + 4 * int(count))
    points = np.frombuffer(content, "<f4", 2 * total, 16 + 4 * (2 * int(count) + 1)).reshape(-1, 2)
    return {int(i): points[a:b] for i, a, b in zip(ids, offsets[:-1], offsets[1:], strict=True)}


def test_decisions_made_while_the_server_is_dead_arrive_once_it_is_back(
    page: Page, serve: Callable[..., Any], folder: Path
) -> None:
    server = serve(str(folder))
    image = wait_for_run(server, "street")[0]
    page.goto(f"{server.address}/datasets/street/images/{image['id']}")
    progress = page.get_by_label("Progress").locator(".panel-progress")
    expect(progress).to_have_text(f"0 of {image['candidates']} judged")
    page.keyboard.press("k")
    expect(page.get_by_text("All saved")).to_be_visible()

    server.kill()
    page.keyboard.press("x")
    page.keyboard.press("k")
    expect(progress).to_have_text(f"3 of {image['candidates']} judged")
    expect(page.get_by_text("Offline, 2 kept here")).to_be_visible()

    again = serve(port=int(server.address.rpartition(":")[2]))
    expect(page.get_by_text("All saved")).to_be_visible(timeout=30_000)
    history = again.ask(f"/images/{image['id']}/decisions")["decisions"]
    assert [row["verdict"] for row in history] == ["keep", "reject", "keep"]
    assert len({row["client_id"] for row in history}) == 3


def test_a_click_selects_and_the_address_leads_back_to_the_candidate(
    page: Page, server: Any, images: list[dict[str, Any]]
) -> None:
    image = images[0]
    segments = server.ask(f"/images/{image['id']}/segments")["segments"]
    last = segments[-1]
    page.goto(f"{server.address}/datasets/by-keys/images/{image['id']}?segment={last['id']}")
    expect(page.locator("#label-selection")).to_contain_text("of")
    page.keyboard.press("x")
    expect(page.get_by_text("All saved")).to_be_visible()
    after = server.ask(f"/images/{image['id']}/segments")["segments"]
    assert {segment["id"]: segment["verdict"] for segment in after}[last["id"]] == "reject"
    assert sum(segment["verdict"] != "undecided" for segment in after) == 1


def test_the_key_list_shows_every_key(page: Page, server: Any, images: list[dict[str, Any]]) -> None:
    image = images[1]
    page.goto(f"{server.address}/datasets/by-keys/images/{image['id']}")
    expect(page.get_by_label("Progress")).to_be_visible()
    page.keyboard.press("?")
    for words in ("Keep", "Reject", "Ambiguous", "Undo", "Redo", "Hide rejected"):
        expect(page.get_by_role("region", name="Keys").get_by_text(words, exact=False).first).to_be_visible()
