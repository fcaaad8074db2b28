"""What a detector's author sees of an image: hits, false positives and misses, by real keys and mouse."""

from __future__ import annotations

import io
import json
import re
import time
import zipfile
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import cv2
import httpx2 as httpx
import numpy as np
import pytest
from playwright.sync_api import Page, expect

from app.formats.label_npy import write_label_npy
from app.vision.segments import Segments

WIDTH, HEIGHT = 640, 480

Row = tuple[int, int, int]
# From x to x at height y: labels of all images, then what is submitted for each.
LABELS: tuple[Row, ...] = ((100, 500, 100), (100, 500, 200), (100, 500, 300))
FOUND: dict[str, tuple[Row, ...]] = {
    # A hit, a hit 1 px beside, a fragment of the third label, and a line where there is nothing.
    "a": ((100, 500, 100), (100, 500, 201), (100, 190, 300), (50, 350, 420)),
    "b": LABELS,
    "c": (),
}
# The other one misses the first label, finds the third, and has the same line where there is nothing.
FOUND_BY_OTHER = {**FOUND, "a": ((100, 500, 200), (100, 500, 300), (50, 340, 421))}


@dataclass(frozen=True)
class Scored:
    """Two scored submissions."""

    server: Any
    mine: int
    other: int
    hidden: int
    """A submission of the token's holder on a hidden split."""
    images: dict[str, int]
    """Ids of the open split's images, by name."""
    token: str

    def address(self, image: str, query: str = "", submission: int | None = None) -> str:
        return f"{self.server.address}/submissions/{submission or self.mine}/images/{self.images[image]}{query}"


def line(row: Row) -> np.ndarray:
    x0, x1, y = row
    return np.linspace((x0, y), (x1, y), x1 - x0 + 1, dtype=np.float32)


def segment(row: Row, place: int) -> dict[str, Any]:
    return {"points": line(row).tolist(), "score": 0.9 - place / 10}


def submission_file(found: dict[str, tuple[Row, ...]]) -> bytes:
    images = {
        name: {"segments": [segment(row, place) for place, row in enumerate(rows)]} for name, rows in found.items()
    }
    return json.dumps({"images": images}).encode()


def submit(api: httpx.Client, split: str, method: str, found: dict[str, tuple[Row, ...]]) -> int:
    """Submit and wait for the score."""
    files = {"files": ("lines.json", submission_file(found), "application/json")}
    answer = api.post(f"/splits/{split}/submissions", files=files, data={"method": method, "label": "v1"})
    assert answer.status_code == 202, answer.text
    number = answer.json()["id"]
    deadline = time.monotonic() + 60
    while True:
        state = api.get(f"/submissions/{number}").json()
        if state["status"] == "scored":
            return number
        assert state["status"] in ("received", "validating", "queued", "scoring"), state
        assert time.monotonic() < deadline, state
        time.sleep(0.1)


def upload(api: httpx.Client, dataset: str, images: tuple[str, ...], grey: int) -> None:
    """Make a dataset from a zip in the ClearLines layout, each image of which has the same labels."""
    labels = write_label_npy(Segments.from_list([line(row) for row in LABELS]))
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w") as archive:
        for number, name in enumerate(images):
            picture = cv2.imencode(".png", np.full((HEIGHT, WIDTH), grey + number, np.uint8))[1]
            archive.writestr(f"images/{name}.png", picture.tobytes())
            archive.writestr(f"labels/{name}_edge_segments_filtered.npy", labels)
    api.post("/datasets", json={"name": dataset}).raise_for_status()
    files = {"files": (f"{dataset}.zip", content.getvalue(), "application/zip")}
    api.post(f"/datasets/{dataset}/images", files=files).raise_for_status()


def freeze(api: httpx.Client, dataset: str, visibility: str) -> str:
    """Finish the review of a dataset's images and make a split of them."""
    for image in api.get(f"/datasets/{dataset}/images").json()["items"]:
        api.put(f"/images/{image['id']}/review", json={"status": "done"}).raise_for_status()
    given = {"name": f"{dataset} {visibility}", "visibility": visibility, "min_length": 0}
    answer = api.post(f"/datasets/{dataset}/splits", json=given)
    assert answer.status_code == 201, answer.text
    return answer.json()["slug"]


@pytest.fixture(scope="module")
def scored(server: Any, create_token: Callable[..., str]) -> Scored:
    with httpx.Client(base_url=f"{server.address}/api", timeout=30) as api:
        upload(api, "lanes", tuple(FOUND), grey=100)
        upload(api, "secrets", ("x",), grey=60)
        split = freeze(api, "lanes", "open")
        mine = submit(api, split, "Row finder", FOUND)
        other = submit(api, split, "Other finder", FOUND_BY_OTHER)
        rows = api.get(f"/submissions/{mine}/images").json()["items"]
        secret = freeze(api, "secrets", "hidden")
        token = create_token(server, "author", "submitter")
        api.headers["Authorization"] = f"Bearer {token}"
        hidden = submit(api, secret, "Secret finder", {"x": LABELS})
    return Scored(server, mine, other, hidden, {row["name"]: row["image_id"] for row in rows}, token)


def open_viewer(page: Page, address: str) -> None:
    page.goto(address)
    page.locator("[role=application][aria-busy=false]").first.wait_for()


def place(page: Page, x: float, y: float, pane: int = 0) -> tuple[float, float]:
    """Where on the page the centre of an image pixel is while the whole image is shown."""
    box = page.get_by_role("application").nth(pane).bounding_box()
    assert box
    scale = min((box["width"] - 24) / WIDTH, (box["height"] - 24) / HEIGHT)
    return (
        box["x"] + box["width"] / 2 + (x + 0.5 - WIDTH / 2) * scale,
        box["y"] + box["height"] / 2 + (y + 0.5 - HEIGHT / 2) * scale,
    )


def selection(page: Page) -> Any:
    return expect(page.locator("#viewer-selection"))


def picture(page: Page, layer: int, pane: int = 0) -> str:
    """The pixels of a canvas: 0 the image, 1 the lines."""
    canvas = page.get_by_role("application").nth(pane).locator("canvas").nth(layer)
    return canvas.evaluate("canvas => canvas.toDataURL()")


def colours(page: Page) -> set[str]:
    """Which of the paper's colours the lines have that are drawn."""
    canvas = page.get_by_role("application").first.locator("canvas").nth(1)
    found = canvas.evaluate(
        """canvas => {
          const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
          const wanted = { green: [60, 215, 90], red: [255, 75, 85], orange: [255, 170, 0] };
          const seen = new Set();
          for (let i = 0; i < data.length; i += 4)
            for (const [name, colour] of Object.entries(wanted))
              if (data[i + 3] > 200 && colour.every((value, c) => Math.abs(value - data[i + c]) < 12)) seen.add(name);
          return [...seen];
        }"""
    )
    return set(found)


def test_errors_are_visited_worst_first_with_what_is_wrong(page: Page, scored: Scored) -> None:
    open_viewer(page, scored.address("a"))
    selection(page).to_have_text("No line selected")
    expect(page.get_by_label("Errors", exact=True)).to_contain_text("3 errors")
    page.keyboard.press("j")
    # 400 px of a label of which a fragment was found; then 300 px of nothing; then the fragment.
    selection(page).to_contain_text("Miss, label 3, error 1 of 3")
    page.keyboard.press("j")
    selection(page).to_contain_text("False positive, prediction 4, error 2 of 3, background, 300 pixels long")
    page.keyboard.press("Tab")
    selection(page).to_contain_text("False positive, prediction 3, error 3 of 3, fragment")
    line_section = page.get_by_label("Selected line")
    expect(line_section).to_contain_text("It covers too small a part of its label.")
    expect(line_section).to_contain_text("Label 3, miss")
    page.keyboard.press("k")
    selection(page).to_contain_text("prediction 4")
    page.get_by_text("Nearly").click()
    page.keyboard.press("Escape")
    selection(page).to_have_text("No line selected")
    page.keyboard.press("j")
    selection(page).to_contain_text("error 1 of 3")
    selection(page).to_contain_text("L I O U 0.2")


def test_a_line_under_the_cursor_tells_how_exact_it_is(page: Page, scored: Scored) -> None:
    open_viewer(page, scored.address("a"))
    x, y = place(page, 300, 201)
    page.mouse.move(x, y - 30)
    page.mouse.move(x, y)
    readout = page.locator(".hover-readout")
    expect(readout).to_contain_text("true positive")
    expect(readout).to_contain_text("LIoU 1.00 with label 2")
    expect(readout).to_contain_text("1.0 px off")
    expect(readout).to_contain_text("0.00°")
    expect(readout).to_contain_text("score 0.80")
    page.mouse.click(x, y)
    selection(page).to_contain_text("True positive, prediction 2, 400 pixels long")
    page.mouse.click(*place(page, 300, 50))
    selection(page).to_have_text("No line selected")


def test_keys_show_and_hide_the_layers(page: Page, scored: Scored) -> None:
    open_viewer(page, scored.address("a"))
    everything = {"green", "red", "orange"}
    assert colours(page) == everything
    layers = (("1", "true positives", "green"), ("2", "false positives", "red"), ("3", "misses", "orange"))
    for key, layer, colour in layers:
        button = page.get_by_role("button", name=f"Show {layer}")
        before = picture(page, 1)
        page.keyboard.press(key)
        expect(button).to_have_attribute("aria-pressed", "false")
        changed(page, before)
        assert colours(page) == everything - {colour}
        hidden = picture(page, 1)
        page.keyboard.press(key)
        expect(button).to_have_attribute("aria-pressed", "true")
        changed(page, hidden)
    page.keyboard.press("h")
    expect(page.get_by_text("All lines are hidden.")).to_be_visible()
    page.wait_for_function(
        """() => {
          const canvas = document.querySelectorAll("[role=application] canvas")[1];
          const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
          return data.every((value) => value === 0);
        }"""
    )
    page.keyboard.press("h")
    page.keyboard.press("3")
    # What is hidden isn't visited.
    page.keyboard.press("j")
    selection(page).to_contain_text("False positive")
    page.wait_for_url(re.compile(r"show=tp-fp(&|$)"))


def test_ignored_lines_are_shown_on_request(page: Page, scored: Scored) -> None:
    open_viewer(page, scored.address("a"))
    ignored = page.get_by_role("button", name="Show ignored")
    expect(ignored).to_have_attribute("aria-pressed", "false")
    page.keyboard.press("4")
    expect(ignored).to_have_attribute("aria-pressed", "true")
    page.wait_for_url(re.compile(r"show=tp-fp-fn-ignored$"))
    page.reload()
    expect(ignored).to_have_attribute("aria-pressed", "true")
    page.keyboard.press("4")
    expect(page).to_have_url(scored.address("a"))


@pytest.mark.parametrize("place", ["submissions/{submission}/images/{image}", "datasets/lanes/images/{image}"])
def test_the_bar_stays_whatever_is_scrolled_into_view(page: Page, scored: Scored, place: str) -> None:
    page.set_viewport_size({"width": 900, "height": 420})
    where = place.format(submission=scored.mine, image=scored.images["a"])
    open_viewer(page, f"{scored.server.address}/{where}")
    bar = page.get_by_role("banner")
    before = bar.bounding_box()
    # Panels scroll in themselves; the page that holds them doesn't.
    page.evaluate("() => document.querySelectorAll('main *').forEach((part) => part.scrollIntoView())")
    page.evaluate("() => window.scrollTo(0, 1000)")
    assert bar.bounding_box() == before
    assert page.evaluate("() => document.scrollingElement.scrollTop") == 0


def changed(page: Page, before: str) -> None:
    """Wait until the lines look different, and drawn to the end."""
    page.wait_for_function(
        """before => document.querySelectorAll("[role=application] canvas")[1].toDataURL() !== before""", arg=before
    )


def test_the_address_leads_to_the_same_line(page: Page, scored: Scored) -> None:
    open_viewer(page, scored.address("a", "?segment=p3"))
    selection(page).to_contain_text("prediction 4")
    page.keyboard.press("k")
    selection(page).to_contain_text("label 3")
    page.wait_for_url(re.compile(r"segment=l2"))
    page.reload()
    selection(page).to_contain_text("label 3")
    page.get_by_role("link", name="Row finder v1").click()
    expect(page).to_have_url(f"{scored.server.address}/submissions/{scored.mine}")


def test_keys_go_through_the_images_in_their_order(page: Page, scored: Scored) -> None:
    # By F1, the lowest first: nothing found, some found, all found.
    open_viewer(page, scored.address("c", "?sort=f1"))
    expect(page.get_by_text("The submission has no predictions for this image")).to_be_visible()
    for image in ("a", "b"):
        page.keyboard.press("n")
        expect(page).to_have_url(re.compile(rf"/images/{scored.images[image]}\?sort=f1"))
        expect(page.get_by_role("application", name=f"Image {image}")).to_have_attribute("aria-busy", "false")
    expect(page.get_by_label("Result on this image")).to_contain_text("Image 3 of 3")
    page.keyboard.press("j")
    expect(page.get_by_text("There are no errors")).to_be_attached()
    page.keyboard.press("n")
    expect(page.get_by_text("This is the last image")).to_be_attached()
    page.keyboard.press("p")
    expect(page.get_by_role("application", name="Image a")).to_be_visible()
    page.go_back()
    expect(page.get_by_role("application", name="Image b")).to_be_visible()


def test_keys_stay_among_the_images_that_were_searched_for(page: Page, scored: Scored) -> None:
    page.goto(f"{scored.server.address}/submissions/{scored.mine}?tab=images&sort=f1")
    images = page.get_by_role("list", name="Images").get_by_role("link")
    expect(images).to_have_count(3)
    page.get_by_label("Search images").fill("b")
    expect(images).to_have_count(1)
    images.first.click()
    expect(page.get_by_label("Result on this image")).to_contain_text("Image 1 of 1")
    page.keyboard.press("n")
    expect(page.get_by_text("This is the last image")).to_be_attached()
    page.get_by_role("link", name="Row finder v1").click()
    expect(images).to_have_count(1)
    expect(page.get_by_label("Search images")).to_have_value("b")


def test_two_submissions_move_together_and_show_where_they_differ(page: Page, scored: Scored) -> None:
    open_viewer(page, scored.address("a"))
    page.get_by_role("button", name="Compare with…").click()
    page.get_by_role("button", name="Other finder v1").click()
    compare = page.get_by_label("Compare", exact=True)
    expect(compare.get_by_role("row", name="Found")).to_have_text(re.compile(r"^Found\s*1\s*1$"))
    # The line where there is nothing is in both; the fragment is the first one's alone.
    expect(compare.get_by_role("row", name="False positives")).to_have_text(re.compile(r"^False positives\s*1\s*0$"))
    page.mouse.click(*place(page, 300, 100))
    selection(page).to_contain_text("True positive, prediction 1")
    page.keyboard.press("b")
    selection(page).to_contain_text("Miss, label 1, error")
    page.keyboard.press("s")
    expect(page.get_by_role("application")).to_have_count(2)
    page.locator("[role=application][aria-busy=false]").nth(1).wait_for()
    page.mouse.move(*place(page, 300, 240, pane=1))
    page.mouse.wheel(0, -400)
    page.mouse.wheel(-60, 0)
    page.wait_for_function(
        """() => {
          const [one, other] = [...document.querySelectorAll("[role=application]")]
            .map((region) => region.querySelector("canvas").toDataURL());
          return one === other;
        }"""
    )
    before = picture(page, 1)
    page.keyboard.press("d")
    changed(page, before)
    page.wait_for_url(re.compile(rf"with={scored.other}&side=b&view=both&differences=1&segment=l0"))
    page.reload()
    expect(page.get_by_role("application")).to_have_count(2)
    expect(page.get_by_label("Highlight the differences")).to_be_checked()
    selection(page).to_contain_text("Miss, label 1")


def test_a_false_positive_goes_to_the_review_queue(page: Page, scored: Scored) -> None:
    open_viewer(page, scored.address("a", "?segment=l2"))
    selection(page).to_contain_text("Miss")
    page.keyboard.press("r")
    expect(page.get_by_text("Only a false positive can be sent to review")).to_be_visible()
    page.keyboard.press("j")
    selection(page).to_contain_text("prediction 4")
    page.keyboard.press("r")
    toast = page.locator(".toast", has_text="a candidate of a in lanes")
    expect(toast).to_be_visible()
    expect(page.get_by_role("button", name="In the review queue")).to_be_disabled()
    toast.get_by_role("button", name="Open the review").click()
    page.locator("[role=application][aria-busy=false]").wait_for()
    expect(page.get_by_label("Progress").get_by_role("listitem").filter(has_text="Undecided")).to_contain_text("1")
    expect(page.get_by_label("Selected candidate")).to_contain_text("import")


def test_what_there_is_nothing_of_is_said(page: Page, scored: Scored) -> None:
    page.goto(f"{scored.server.address}/submissions/{scored.mine}/images/987654")
    alert = page.get_by_role("alert")
    expect(alert).to_be_visible()
    expect(alert.get_by_role("link", name="To the submission")).to_be_visible()
    page.goto(scored.address("a", submission=987654))
    expect(page.get_by_role("alert")).to_be_visible()


def test_the_author_sees_no_image_of_a_hidden_split(page: Page, scored: Scored) -> None:
    address = scored.server.address
    signed_in = page.request.post(f"{address}/api/session", data={"token": scored.token})
    assert signed_in.ok
    page.goto(f"{address}/submissions/{scored.hidden}/images/1")
    expect(page.get_by_role("heading", name="Images of a hidden split aren't shown")).to_be_visible()
    expect(page.get_by_role("application")).to_have_count(0)
    page.get_by_role("link", name="To the submission").click()
    expect(page).to_have_url(f"{address}/submissions/{scored.hidden}")


def test_the_list_of_keys_opens_and_closes(page: Page, scored: Scored) -> None:
    open_viewer(page, scored.address("b"))
    page.keyboard.press("?")
    keys = page.get_by_label("Keys", exact=True)
    for word in ("Next error", "Misses", "Flip between A and B", "Send to review"):
        expect(keys).to_contain_text(word)
    page.keyboard.press("Escape")
    expect(keys).to_have_count(0)
