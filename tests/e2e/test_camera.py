"""The page of a camera in a real browser: from kept lines to a lens, seen from all sides, into another tool's file."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray
from playwright.sync_api import Locator, Page, expect

pytestmark = pytest.mark.xdist_group("pages")

WIDTH, HEIGHT = 480, 360
MATRIX = np.array([[400.0, 0.0, 240.0], [0.0, 400.0, 180.0], [0.0, 0.0, 1.0]])
COEFFICIENTS = np.array([-0.28, 0.08, 0.0, 0.0, 0.0])
LINES = 16
REFERENCE = f"""%YAML:1.0
---
image_width: {WIDTH}
image_height: {HEIGHT}
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: {MATRIX.ravel().tolist()}
distortion_coefficients: !!opencv-matrix
   rows: 1
   cols: 5
   dt: d
   data: {COEFFICIENTS.tolist()}
"""


def bent_line(random: np.random.Generator) -> NDArray[np.float64]:
    """A straight line of the world as this lens shows it, with noise; px, (N, 2)."""
    while True:
        start, end = random.uniform(-0.15, 1.15, (2, 2)) * (WIDTH, HEIGHT)
        rays = (np.linspace(start, end, 90) - MATRIX[:2, 2]) / 400.0
        seen, _ = cv2.projectPoints(np.c_[rays, np.ones(90)], np.zeros(3), np.zeros(3), MATRIX, COEFFICIENTS)
        points = seen[:, 0] + random.normal(0.0, 0.08, (90, 2))
        points = points[((points > 2) & (points < (WIDTH - 3, HEIGHT - 3))).all(axis=1)]
        if len(points) > 40 and np.ptp(points, axis=0).max() > 130:
            return points


def write_camera(folder: Path, *, images: int, labelled: int) -> None:
    """Write pictures of lines through one lens; the first ones with their lines kept, the others with candidates."""
    random = np.random.default_rng(7)
    for kind in ("images", "labels"):
        (folder / kind).mkdir(parents=True)
    for number in range(images):
        image = np.full((HEIGHT, WIDTH), 70 + 20 * number, np.uint8)
        lines = [bent_line(random) for _ in range(LINES)]
        for line in lines:
            cv2.polylines(image, [np.round(line * 16).astype(np.int32)], False, 235, 2, cv2.LINE_AA, 4)
        cv2.imwrite(str(folder / "images" / f"view{number}.png"), image)
        verdict = "keep" if number < labelled else "undecided"
        segments = [{"points": line.round(3).tolist(), "verdict": verdict} for line in lines]
        (folder / "labels" / f"view{number}.json").write_text(json.dumps({"segments": segments}))


@pytest.fixture(scope="module")
def server(
    shared_server: Any, import_dataset: Callable[[Any, Path, str], None], tmp_path_factory: pytest.TempPathFactory
) -> Any:
    """The server with the datasets `lenses`, whose lines are kept, and `unlabelled`."""
    for name, labelled in (("Lenses", 4), ("Unlabelled", 0)):
        folder = tmp_path_factory.mktemp(name.lower())
        write_camera(folder, images=5 if labelled else 1, labelled=labelled)
        import_dataset(shared_server, folder, name)
    return shared_server


def camera_id(server: Any, slug: str) -> int:
    return server.ask(f"/datasets/{slug}/cameras")[0]["id"]


def pixels(page: Page) -> int:
    """A number that changes with what the canvas shows."""
    return page.evaluate(
        """() => {
            const canvas = document.querySelector(".split canvas");
            const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
            return data.reduce((sum, value, index) => (sum * 31 + value * (index % 7)) % 2147483647, 0);
        }"""
    )


def part(page: Page, name: str) -> Locator:
    return page.get_by_role("navigation", name="Parts of the camera").get_by_role("link", name=name)


def test_from_kept_lines_to_a_file(page: Page, server: Any, tmp_path: Path) -> None:
    page.goto(f"{server.address}/datasets/lenses?tab=cameras")
    page.get_by_role("link", name="Calibrate from 64 kept lines").click()
    page.get_by_role("button", name="Calibrate from 64 kept lines").first.click()
    verdict = page.get_by_role("region", name="How well the lens is known")
    expect(verdict.get_by_text("Lens accepted")).to_be_visible(timeout=60_000)
    expect(verdict.get_by_text(re.compile(r"^Expected error [\d.]+ px, below [\d.]+ px with 95 %$"))).to_be_visible()

    compare_before_and_after(page)
    read_maps(page)
    open_a_line(page)

    part(page, "Parameters").click()
    k1 = page.get_by_role("row", name=re.compile("^k1 ")).first
    expect(k1).to_contain_text("±")
    expect(page.get_by_role("table").filter(has_text="Why").get_by_text("Chosen")).to_have_count(1)

    compare_with_reference(page)

    part(page, "Export").click()
    with page.expect_download() as downloading:
        page.get_by_role("button", name="Download OpenCV YAML").click()
    saved = tmp_path / "lens.yaml"
    downloading.value.save_as(saved)
    storage = cv2.FileStorage(str(saved), cv2.FILE_STORAGE_READ)
    assert storage.getNode("distortion_coefficients").mat().size >= 4
    assert storage.getNode("image_width").real() == WIDTH
    with page.context.expect_page() as opening:
        page.get_by_role("link", name="Open the report").click()
    expect(opening.value.get_by_role("heading").first).to_be_visible()
    opening.value.close()

    part(page, "History").click()
    page.get_by_role("button", name=re.compile("^Delete calibration")).click()
    expect(page.get_by_text("No calibrations yet")).to_be_visible()
    page.get_by_role("button", name="Undo").click()
    expect(page.get_by_role("link", name=re.compile(r"^Calibration \d+$"))).to_be_visible()


def compare_before_and_after(page: Page) -> None:
    """The edge moves by keys and mouse, both sides differ, and the next image comes by its key."""
    edge = page.get_by_role("slider", name="Edge between before and after")
    expect(edge).to_have_attribute("aria-valuetext", "50 % before, 50 % after")
    edge.press("ArrowRight")
    expect(edge).to_have_attribute("aria-valuetext", "52 % before, 48 % after")
    box = page.locator(".split").bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + 0.52 * box["width"], box["y"] + 0.8 * box["height"])
    page.mouse.down()
    page.mouse.move(box["x"] + 0.25 * box["width"], box["y"] + 0.8 * box["height"], steps=4)
    page.mouse.up()
    expect(edge).to_have_attribute("aria-valuetext", "25 % before, 75 % after")
    expect(page.locator(".split__loading")).to_have_count(0)
    for key in ("g", "l", "b"):
        page.keyboard.press(key)
    expect(edge).to_have_attribute("aria-valuetext", "Before only")
    page.evaluate("() => new Promise(requestAnimationFrame)")
    before = pixels(page)
    page.keyboard.press("a")
    expect(edge).to_have_attribute("aria-valuetext", "After only")
    page.evaluate("() => new Promise(requestAnimationFrame)")
    assert pixels(page) != before
    first = page.locator(".before-after__name strong").inner_text()
    page.keyboard.press("n")
    expect(page.locator(".before-after__name strong")).not_to_have_text(first)
    expect(page).to_have_url(re.compile(r"image=\d+"))


def read_maps(page: Page) -> None:
    """Cells are read by keys and in a table, and the advice leads to images."""
    page.keyboard.press("2")
    expect(page).to_have_url(re.compile("tab=maps"))
    field = page.get_by_role("application", name=re.compile("^95 % bound of the error"))
    field.press("ArrowRight")
    readout = page.get_by_text(re.compile(r"^Around \(\d+, \d+\): below [\d.]+ px with 95 %"))
    expect(readout).to_be_visible()
    first = readout.inner_text()
    field.press("ArrowDown")
    expect(readout).not_to_have_text(first)
    page.get_by_text("As a table").first.click()
    expect(page.locator(".cell-table").first.locator("td").nth(100)).to_be_visible()
    advised = page.get_by_role("region", name="Where more lines help most")
    expect(advised.get_by_text(re.compile("^Five more lines around")).first).to_be_visible()
    expect(advised.get_by_role("link", name=re.compile("view4"))).to_be_visible()


def open_a_line(page: Page) -> None:
    """A line of the list leads to itself in its image, and Back to the list."""
    part(page, "Lines").click()
    rows = page.get_by_role("list", name="Lines").get_by_role("link")
    rows.first.press("ArrowDown")
    expect(rows.nth(1)).to_be_focused()
    number = re.search(r"Line (\d+)", rows.nth(1).get_attribute("aria-label") or "")
    assert number is not None
    page.keyboard.press("Enter")
    expect(page).to_have_url(re.compile(rf"/datasets/lenses/images/\d+\?segment={number[1]}$"))
    page.go_back()
    expect(rows.first).to_be_visible()


def compare_with_reference(page: Page) -> None:
    """The difference to an uploaded reference is shown in numbers; removing it can be undone."""
    page.keyboard.press("6")
    page.get_by_label("Calibration file").set_input_files(
        {"name": "chessboard.yaml", "mimeType": "application/yaml", "buffer": REFERENCE.encode()}
    )
    difference = page.get_by_role("region", name="Difference to the reference")
    expect(difference.get_by_text("RMS over the frame")).to_be_visible()
    rms = difference.locator("dd").first.inner_text()
    assert float(rms.removesuffix(" px")) < 0.5
    page.get_by_role("button", name="Remove").click()
    expect(page.get_by_role("heading", name="No reference")).to_be_visible()
    page.get_by_role("button", name="Undo").click()
    expect(difference).to_be_visible()


def test_says_what_is_missing(page: Page, server: Any) -> None:
    camera = camera_id(server, "unlabelled")
    page.goto(f"{server.address}/datasets/unlabelled/cameras/{camera}")
    expect(page.get_by_role("heading", name="No line is kept yet")).to_be_visible()
    expect(page.get_by_role("button", name="Calibrate", exact=True)).to_be_disabled()
    page.get_by_role("link", name="label some").click()
    expect(page).to_have_url(re.compile(rf"/datasets/unlabelled\?camera={camera}$"))

    page.goto(f"{server.address}/datasets/unlabelled/cameras/999999")
    expect(page.get_by_role("heading", name="There is no such camera")).to_be_visible()


def test_a_failed_calibration_can_be_tried_again(page: Page, server: Any) -> None:
    camera = camera_id(server, "lenses")

    failed = {
        **dict.fromkeys(("family", "progress", "summary", "person", "started_at", "finished_at")),
        "id": 999999,
        "camera_id": camera,
        "source": "labels",
        "status": "failed",
        "n_segments": 64,
        "created_at": "2026-03-14T12:00:00Z",
        "error": {"code": "timeout", "message": "it took too long"},
    }
    page.route(
        f"**/api/cameras/{camera}/calibrations?*",
        lambda route: route.fulfill(json={"items": [failed], "next_cursor": None, "total": 1}),
    )
    page.goto(f"{server.address}/datasets/lenses/cameras/{camera}?tab=history")
    expect(page.get_by_text("The latest calibration failed.")).to_be_visible()
    expect(page.get_by_text("It took too long.")).to_be_visible()
    expect(page.get_by_role("button", name="Try again")).to_be_visible()
