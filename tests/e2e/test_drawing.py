"""Lines by hand, with real keys and mouse: traced, cut, trimmed, joined, extended, and taken back across a reload."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any
from uuid import uuid4

import cv2
import numpy as np
import pytest
from playwright.sync_api import Page, expect

from app.formats.label_npy import write_label_npy
from app.vision.segments import Segments

WIDTH, HEIGHT = 640, 480
EDGE, ROOF = 299.5, 119.5
PATIENCE = 30_000
"""Milliseconds; the first answer waits for a worker process to start."""
IMAGES = ("draw", "shape", "away", "empty")


def wall(shade: int) -> np.ndarray:
    """A wall with a long edge at y = 299.5 from x = 80 to 560, and a roof line at y = 119.5."""
    image = np.full((HEIGHT, WIDTH), 70, np.uint8)
    image[300:, 80:561] = 170 + shade
    image[60:120, 100:541] = 200
    return image


@pytest.fixture(scope="module")
def images(
    tmp_path_factory: pytest.TempPathFactory, label_server: Any, import_dataset: Callable[..., None]
) -> dict[str, int]:
    """One image for each test, by name, each with an undecided candidate on the edge from x = 150 to 450."""
    folder = tmp_path_factory.mktemp("drawing")
    for part in ("images", "labels"):
        (folder / part).mkdir()
    x = np.arange(150, 451, dtype=np.float32)
    labels = write_label_npy(Segments.from_list([np.stack([x, np.full_like(x, EDGE)], axis=1)]))
    for number, name in enumerate(IMAGES):
        cv2.imwrite(str(folder / "images" / f"{name}.png"), wall(number))
        (folder / "labels" / f"{name}_edge_segments_filtered.npy").write_bytes(labels)
    import_dataset(label_server, folder, "drawing")
    found = {image["name"]: image["id"] for image in label_server.ask("/datasets/drawing/images")["items"]}
    for name in IMAGES:
        (segment,) = segments(label_server, found[name])
        group = {"client_id": str(uuid4()), "group_id": str(uuid4()), "segment_id": segment["id"]}
        label_server.ask(f"/images/{found[name]}/decisions", {"decisions": [{**group, "verdict": "undecided"}]})
    return found


def segments(server: Any, image: int) -> list[dict[str, Any]]:
    return server.ask(f"/images/{image}/segments")["segments"]


def spans(server: Any, image: int, height: float = EDGE) -> list[tuple[int, int]]:
    """First and last x of the lines at a height, from left to right."""
    boxes = [entry["box"] for entry in segments(server, image) if abs(entry["box"][1] - height) < 2]
    return sorted((round(box[0]), round(box[2])) for box in boxes)


def open_image(page: Page, server: Any, image: int) -> None:
    page.goto(f"{server.address}/datasets/drawing/images/{image}")
    page.locator("[role=application][aria-busy=false]").wait_for()
    page.keyboard.press("f")  # the selection may have moved the view


def place(page: Page, x: float, y: float) -> tuple[float, float]:
    """Where on the page the centre of an image pixel is while the whole image is shown."""
    box = page.get_by_role("application").bounding_box()
    assert box
    scale = min((box["width"] - 24) / WIDTH, (box["height"] - 24) / HEIGHT)
    return (
        box["x"] + box["width"] / 2 + (x + 0.5 - WIDTH / 2) * scale,
        box["y"] + box["height"] / 2 + (y + 0.5 - HEIGHT / 2) * scale,
    )


def said(page: Page, text: str | re.Pattern[str]) -> None:
    expect(page.locator(".toaster")).to_contain_text(text, timeout=PATIENCE)


def banner(page: Page) -> Any:
    return page.locator(".banner", has=page.get_by_role("button", name="Take back"))


def shown(page: Page, text: str | re.Pattern[str]) -> None:
    expect(banner(page)).to_contain_text(text, timeout=PATIENCE)


def history_known(page: Page, server: Any, image: int) -> None:
    """Reload, and wait until what can be undone has come."""
    open_image(page, server, image)
    expect(page.get_by_role("button", name="Undo")).to_be_enabled()


def test_a_missing_line_is_traced_shown_and_kept_and_undone_across_a_reload(
    page: Page, label_server: Any, images: dict[str, int]
) -> None:
    image = images["draw"]
    open_image(page, label_server, image)
    page.keyboard.press("l")
    expect(page.get_by_text("Click two points of a missing line")).to_be_visible()
    page.mouse.click(*place(page, 130, ROOF + 3))
    page.mouse.click(*place(page, 300, ROOF + 40))
    shown(page, "No edge here")
    page.keyboard.press("Backspace")
    page.mouse.click(*place(page, 500, ROOF - 2))
    shown(page, re.compile("3(69|70) px traced"))
    assert len(segments(label_server, image)) == 1  # shown, not stored
    page.keyboard.press("Enter")
    said(page, re.compile("Line added, 3(69|70) px"))
    assert spans(label_server, image, ROOF) == [(130, 500)]
    drawn = next(entry for entry in segments(label_server, image) if entry["origin"] == "manual")
    assert drawn["verdict"] == "keep"
    expect(page.get_by_label("Selected candidate")).to_contain_text("drawn by hand")

    # the tool stays in hand; a double click is the last point and accepts
    page.mouse.click(*place(page, 479.5, EDGE))
    page.mouse.dblclick(*place(page, 540.5, EDGE + 2))
    said(page, "Line added, 60 px")
    page.keyboard.press("Escape")
    expect(page.get_by_text("Click two points of a missing line")).to_be_hidden()
    assert spans(label_server, image) == [(150, 450), (480, 540)]

    history_known(page, label_server, image)
    page.keyboard.press("z")
    said(page, "Undone: added line")
    page.keyboard.press("z")
    expect(page.get_by_label("Progress").locator(".panel-progress")).to_contain_text("1")
    wait_for(page, lambda: len(segments(label_server, image)) == 1)
    history_known_redo(page, label_server, image)
    page.keyboard.press("Shift+Z")
    said(page, "Redone: added line")
    wait_for(page, lambda: spans(label_server, image, ROOF) == [(130, 500)])
    assert spans(label_server, image) == [(150, 450)]


def history_known_redo(page: Page, server: Any, image: int) -> None:
    open_image(page, server, image)
    expect(page.get_by_role("button", name="Redo")).to_be_enabled()


def wait_for(page: Page, condition: Callable[[], bool], *, tries: int = 200) -> None:
    """Ask until the condition holds; the page goes on meanwhile."""
    for _ in range(tries):
        if condition():
            return
        page.wait_for_timeout(25)
    pytest.fail("it didn't happen")


def test_a_line_is_cut_trimmed_joined_and_extended_at_the_pointer(
    page: Page, label_server: Any, images: dict[str, int]
) -> None:
    image = images["shape"]
    open_image(page, label_server, image)
    page.mouse.move(*place(page, 300.5, EDGE + 4))
    page.keyboard.press("c")
    said(page, "Line cut in two, 150 px and 149 px")
    assert spans(label_server, image) == [(150, 300), (301, 450)]
    assert [entry["verdict"] for entry in segments(label_server, image)] == ["undecided"] * 2

    page.mouse.move(*place(page, 330.5, EDGE))
    page.keyboard.press("Shift+C")
    said(page, "End trimmed, 119 px")
    assert spans(label_server, image) == [(150, 300), (331, 450)]

    page.mouse.click(*place(page, 200, EDGE))
    page.keyboard.down("Shift")
    page.mouse.click(*place(page, 400, EDGE))
    page.keyboard.up("Shift")
    page.keyboard.press("m")
    said(page, "Two lines joined, 300 px")
    (joined,) = segments(label_server, image)
    assert (joined["n_points"], joined["verdict"]) == (301, "keep")

    page.keyboard.press("Shift+L")
    said(page, "Line extended")
    ((first, last),) = spans(label_server, image)
    assert first == pytest.approx(80, abs=3)
    assert last == pytest.approx(560, abs=3)

    history_known(page, label_server, image)
    for undone in ("extension", "join", "trim", "cut"):
        page.keyboard.press("z")
        said(page, f"Undone: {undone}")
    wait_for(page, lambda: spans(label_server, image) == [(150, 450)])
    page.get_by_role("button", name="Redo").click()
    said(page, "Redone: cut")
    wait_for(page, lambda: spans(label_server, image) == [(150, 300), (301, 450)])


def test_without_a_network_the_line_and_the_verdicts_wait_and_come_once(
    page: Page, label_server: Any, images: dict[str, int]
) -> None:
    image = images["away"]
    open_image(page, label_server, image)
    page.keyboard.press("l")
    page.mouse.click(*place(page, 130, ROOF))
    page.mouse.click(*place(page, 500, ROOF))
    shown(page, re.compile("3(69|70) px traced"))
    for address in ("**/api/images/*/edits", "**/api/images/*/decisions"):
        page.route(address, lambda route: route.abort())
    page.keyboard.press("k")
    page.keyboard.press("Enter")
    shown(page, "Not saved")
    shown(page, "The line stays here")
    assert [entry["verdict"] for entry in segments(label_server, image)] == ["undecided"]
    # on another image and back, the line is still there
    for key, name in (("n", "draw"), ("p", "away")):
        page.keyboard.press(key)
        page.wait_for_url(f"**/images/{images[name]}*")
        expect(page.get_by_role("application", name=f"Image {name} ")).to_have_attribute("aria-busy", "false")
    shown(page, re.compile("3(69|70) px traced"))
    page.unroute_all()
    page.evaluate("window.dispatchEvent(new Event('online'))")
    expect(page.get_by_text("All saved")).to_be_visible()
    banner(page).get_by_role("button", name="Keep").click()
    said(page, "Line added, 3")
    assert sorted((entry["origin"], entry["verdict"]) for entry in segments(label_server, image)) == [
        ("import", "keep"),
        ("manual", "keep"),
    ]
    assert len(label_server.ask(f"/images/{image}/edits")["edits"]) == 1


def test_a_line_without_an_edge_is_kept_as_drawn_on_request(
    page: Page, label_server: Any, images: dict[str, int]
) -> None:
    image = images["empty"]
    open_image(page, label_server, image)
    page.get_by_role("button", name="Trace a missing line").click()
    page.mouse.move(*place(page, 150, 200))
    page.mouse.down()
    page.mouse.move(*place(page, 300, 210), steps=4)
    page.mouse.move(*place(page, 500, 220), steps=4)
    page.mouse.up()
    shown(page, "No edge here")
    banner(page).get_by_role("button", name="Keep it as drawn").click()
    said(page, "Line added, 351 px")
    drawn = next(entry for entry in segments(label_server, image) if entry["origin"] == "manual")
    assert drawn["box"] == pytest.approx([150, 200, 500, 220], abs=1)
    page.locator(".toaster").get_by_role("button", name="Undo").click()
    said(page, "Undone: added line")
    wait_for(page, lambda: len(segments(label_server, image)) == 1)
    page.keyboard.press("Escape")
    page.mouse.move(*place(page, 320, 400))
    page.keyboard.press("c")
    said(page, "Point at the line to cut")
