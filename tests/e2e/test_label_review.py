"""What an annotator does on the label page, by real keys and mouse: choose, take back, hide, discard."""

from __future__ import annotations

import io
import re
from collections.abc import Callable
from typing import Any
from uuid import uuid4

import cv2
import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Page, expect

from app.formats.label_npy import write_label_npy
from app.vision.segments import Segments

WIDTH, HEIGHT = 640, 480
GREY = 110
# In the order of review. The first two are 3 px apart.
COLUMNS = (100, 103, 300, 500)
IMAGES = ("click", "restore", "hide", "discard", "done", "link", "tabs", "held")


def decide(server: Any, image: int, segments: list[int], verdict: str) -> None:
    group = str(uuid4())
    decisions = [
        {"client_id": str(uuid4()), "group_id": group, "segment_id": segment, "verdict": verdict}
        for segment in segments
    ]
    server.ask(f"/images/{image}/decisions", {"decisions": decisions})


@pytest.fixture(scope="module")
def images(
    tmp_path_factory: pytest.TempPathFactory, label_server: Any, import_dataset: Callable[..., None]
) -> dict[str, int]:
    """One image for each test, by name, all with the same undecided candidates; one whose file is cut off."""
    folder = tmp_path_factory.mktemp("review")
    for part in ("images", "labels"):
        (folder / part).mkdir()
    lines = [np.linspace((x, 100), (x, 380), 100, dtype=np.float32) for x in COLUMNS]
    labels = write_label_npy(Segments.from_list(lines))
    for number, name in enumerate(IMAGES):
        cv2.imwrite(str(folder / "images" / f"{name}.png"), np.full((HEIGHT, WIDTH), GREY + number, np.uint8))
        (folder / "labels" / f"{name}_edge_segments_filtered.npy").write_bytes(labels)
    # a PGM is told to be whole when it is decoded, other kinds when they are brought in
    (folder / "images" / "zz_broken.pgm").write_bytes(b"P5 %d %d 255\n" % (WIDTH, HEIGHT) + bytes(WIDTH))
    import_dataset(label_server, folder, "review")
    found = {image["name"]: image["id"] for image in label_server.ask("/datasets/review/images")["items"]}
    for name in IMAGES:
        ids = [segment["id"] for segment in label_server.ask(f"/images/{found[name]}/segments")["segments"]]
        decide(label_server, found[name], ids, "undecided")
    return found


def open_image(page: Page, server: Any, image: int, query: str = "") -> None:
    page.goto(f"{server.address}/datasets/review/images/{image}{query}")
    page.locator("[role=application][aria-busy=false]").wait_for()


def place(page: Page, x: float, y: float) -> tuple[float, float]:
    """Where on the page the centre of an image pixel is while the whole image is shown."""
    box = page.get_by_role("application").bounding_box()
    assert box
    scale = min((box["width"] - 24) / WIDTH, (box["height"] - 24) / HEIGHT)
    return (
        box["x"] + box["width"] / 2 + (x + 0.5 - WIDTH / 2) * scale,
        box["y"] + box["height"] / 2 + (y + 0.5 - HEIGHT / 2) * scale,
    )


def selection(page: Page) -> Any:
    return expect(page.locator("#label-selection"))


def progress(page: Page) -> Any:
    return expect(page.get_by_label("Progress").locator(".panel-progress"))


def test_a_click_selects_the_nearest_and_again_the_next_one_there(
    page: Page, label_server: Any, images: dict[str, int]
) -> None:
    open_image(page, label_server, images["click"])
    selection(page).to_contain_text("Candidate 1 of 4")
    page.mouse.click(*place(page, 103, 240))
    selection(page).to_contain_text("Candidate 2 of 4")
    page.mouse.click(*place(page, 103, 240))
    selection(page).to_contain_text("Candidate 1 of 4")
    # Beside the selected one, not again at its place: the nearest counts.
    page.mouse.click(*place(page, 104, 200))
    selection(page).to_contain_text("Candidate 2 of 4")
    page.mouse.click(*place(page, 400, 240))
    selection(page).to_have_text("No candidate selected")
    page.keyboard.press("Tab")
    selection(page).to_contain_text("Candidate 3 of 4")


def test_a_drag_moves_the_image_and_selects_nothing(page: Page, label_server: Any, images: dict[str, int]) -> None:
    open_image(page, label_server, images["click"])
    selection(page).to_contain_text("Candidate 1 of 4")
    x, y = place(page, 300, 240)
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 40, y + 10, steps=4)
    page.mouse.up()
    selection(page).to_contain_text("Candidate 1 of 4")
    page.mouse.click(x + 40, y + 10)
    selection(page).to_contain_text("Candidate 3 of 4")


def test_one_undo_brings_back_all_that_one_key_rejected(page: Page, label_server: Any, images: dict[str, int]) -> None:
    open_image(page, label_server, images["restore"])
    page.keyboard.press("k")
    page.keyboard.press("r")
    progress(page).to_have_text("4 of 4 judged")
    page.keyboard.press("z")
    progress(page).to_have_text("1 of 4 judged")
    expect(page.get_by_text("Undone: reject of 3 candidates")).to_be_visible()
    page.keyboard.press("Shift+Z")
    progress(page).to_have_text("4 of 4 judged")
    page.keyboard.press("z")
    page.keyboard.press("z")
    progress(page).to_have_text("0 of 4 judged")
    expect(page.get_by_text("Undone: keep")).to_be_visible()


def test_a_held_key_judges_one_candidate(page: Page, label_server: Any, images: dict[str, int]) -> None:
    open_image(page, label_server, images["held"])
    selection(page).to_contain_text("Candidate 1 of 4")
    for _ in range(10):
        page.keyboard.down("x")
    page.keyboard.up("x")
    selection(page).to_contain_text("Candidate 2 of 4")
    progress(page).to_have_text("1 of 4 judged")


def test_rejected_candidates_can_be_hidden(page: Page, label_server: Any, images: dict[str, int]) -> None:
    open_image(page, label_server, images["hide"])
    page.keyboard.press("r")
    progress(page).to_have_text("4 of 4 judged")
    page.keyboard.press("Escape")
    grey = GREY + IMAGES.index("hide")

    def wait_for_line(drawn: bool) -> None:
        x, y = place(page, 500, 240)
        clip = {"x": int(x) - 4, "y": y - 40, "width": 8, "height": 80}
        for _ in range(60):
            content = page.screenshot(clip=clip)  # type: ignore[arg-type]
            pixels = np.asarray(Image.open(io.BytesIO(content)).convert("L"), dtype=int)
            if (abs(pixels - grey).max() > 20) == drawn:
                return
            page.wait_for_timeout(50)
        pytest.fail(f"the line is {'not ' if drawn else ''}drawn")

    wait_for_line(drawn=True)
    page.keyboard.press("h")
    wait_for_line(drawn=False)
    page.keyboard.press("h")
    wait_for_line(drawn=True)


def test_an_image_is_discarded_with_a_reason_and_reopened(
    page: Page, label_server: Any, images: dict[str, int]
) -> None:
    image = images["discard"]
    open_image(page, label_server, image)
    page.keyboard.press("d")
    page.keyboard.type("lines are missing, kerb too")
    page.keyboard.press("Enter")
    expect(page.get_by_text("Discarded.")).to_be_visible()
    detail = label_server.ask(f"/images/{image}")
    assert (detail["status"], detail["reason"]) == ("discarded", "lines are missing, kerb too")
    assert detail["verdicts"]["undecided"] == 4
    page.get_by_label("Review").get_by_role("button", name="Reopen").click()
    expect(page.get_by_text("Discarded.")).to_be_hidden()
    assert label_server.ask(f"/images/{image}")["status"] == "open"
    page.keyboard.press("d")
    page.keyboard.press("Escape")
    expect(page.get_by_role("button", name="Blurred")).to_be_hidden()


def test_a_done_image_is_open_again_once_a_verdict_is_taken_back(
    page: Page, label_server: Any, images: dict[str, int]
) -> None:
    image = images["done"]
    open_image(page, label_server, image)
    page.keyboard.press("r")
    page.keyboard.press("Enter")
    page.wait_for_url(lambda address: not address.split("?")[0].endswith(f"/{image}"))
    assert label_server.ask(f"/images/{image}")["status"] == "done"
    page.go_back()
    expect(page.get_by_text("Done.")).to_be_visible()
    page.mouse.click(*place(page, 300, 240))
    page.keyboard.press("u")
    expect(page.get_by_text("Done.")).to_be_hidden()
    assert label_server.ask(f"/images/{image}")["status"] == "open"


def test_the_address_names_the_selected_candidate_without_filling_the_history(
    page: Page, label_server: Any, images: dict[str, int]
) -> None:
    image = images["link"]
    third = label_server.ask(f"/images/{image}/segments")["segments"][2]["id"]
    open_image(page, label_server, image)
    before = page.evaluate("history.length")
    for _ in range(2):
        page.keyboard.press("Tab")
    expect(page).to_have_url(re.compile(rf"\?segment={third}$"))
    assert page.evaluate("history.length") == before
    page.reload()
    selection(page).to_contain_text("Candidate 3 of 4")


def test_what_another_tab_decided_shows_when_one_comes_back(
    page: Page, label_server: Any, images: dict[str, int]
) -> None:
    image = images["tabs"]
    ids = [segment["id"] for segment in label_server.ask(f"/images/{image}/segments")["segments"]]
    open_image(page, label_server, image)
    page.keyboard.press("k")
    expect(page.get_by_text("All saved")).to_be_visible()
    decide(label_server, image, ids[:2], "reject")
    page.evaluate("window.dispatchEvent(new Event('focus'))")
    expect(page.get_by_text("2 verdicts from elsewhere, 1 in place of what stood here")).to_be_visible()
    progress(page).to_have_text("2 of 4 judged")
    page.get_by_role("button", name="Show", exact=True).click()
    selection(page).to_contain_text("Candidate 1 of 4, reject")


def test_the_page_of_a_broken_image_says_why(page: Page, label_server: Any, images: dict[str, int]) -> None:
    page.goto(f"{label_server.address}/datasets/review/images/{images['zz_broken']}")
    expect(page.get_by_role("heading", name="The image can't be shown")).to_be_visible()
    expect(page.get_by_text("broken or cut off", exact=False)).to_be_visible()
    page.keyboard.press("d")
    page.get_by_role("button", name="Blurred").click()
    expect(page.get_by_text("Discarded.")).to_be_visible()
