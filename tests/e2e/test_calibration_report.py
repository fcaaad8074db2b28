"""The report of a calibration on paper: A4 pages, nothing cut off, nothing loaded, light even for dark screens."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from playwright.sync_api import Browser, Page

from app.calibration.lens import CameraLens
from app.cli import main
from app.formats.label_npy import write_label_npy
from app.vision.segments import Segments

SIZE = (640, 480)
TRUE = CameraLens("division", *SIZE, (0.18, 0.03, 0.0, 0.01, 0.0))
PAPER = {"width": 680, "height": 1000}
"""CSS px between the margins of an A4 page, 180 mm wide."""
OVERFLOWING = """() => {
  const right = document.body.getBoundingClientRect().right + 1;
  const wide = each => each instanceof HTMLElement && each.clientWidth && each.scrollWidth > each.clientWidth + 1;
  return [...document.querySelectorAll("body *")]
    .filter(each => each.getBoundingClientRect().right > right || wide(each))
    .map(each => `${each.tagName} ${each.textContent.slice(0, 60)}`);
}"""


def lines(seed: int, count: int) -> Segments:
    rng = np.random.default_rng(seed)
    found: list[np.ndarray] = []
    while len(found) < count:
        angle, middle = rng.uniform(0, np.pi), rng.uniform([0, 0], SIZE)
        points = TRUE.distort(
            TRUE.undistort(middle[None]) + np.arange(-120, 121)[:, None] * [np.cos(angle), np.sin(angle)]
        )
        inside = (points >= 0).all(axis=1) & (points <= [SIZE[0] - 1, SIZE[1] - 1]).all(axis=1)
        if inside.sum() > 90:
            found.append(points[inside] + rng.normal(0, 0.2, (int(inside.sum()), 2)))
    return Segments.from_list(found)


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The report of a camera with long names and many images, as the command writes it."""
    root = tmp_path_factory.mktemp("camera")
    name = "a-very-long-name-of-a-recording-without-any-place-to-break-it-in-two/2026_03_04_drive_{:04d}_sync"
    for seed in range(24):
        image = root / "images" / f"{name.format(seed)}.png"
        label = root / "labels" / f"{name.format(seed)}.npy"
        for path in (image, label):
            path.parent.mkdir(parents=True, exist_ok=True)
        cv2.imwrite(str(image), np.full((SIZE[1], SIZE[0], 3), 120, np.uint8))
        label.write_bytes(write_label_npy(lines(seed, 3)))
    known = root / "known.json"
    known.write_text(
        '{"width": 640, "height": 480, "K": [[400, 0, 319], [0, 400, 239], [0, 0, 1]], "D": [-0.2, 0.05, 0, 0]}'
    )
    with pytest.MonkeyPatch.context() as patch:
        command = ["clearlines", "calibrate", root, "--reference", known, "--report", root / "report.html"]
        patch.setattr("sys.argv", [*map(str, command)])
        with pytest.raises(SystemExit) as end:
            main()
    assert end.value.code in (0, None)
    return root / "report.html"


@pytest.fixture
def opened(browser: Browser, report: Path) -> Any:
    context = browser.new_context(viewport=PAPER, color_scheme="dark", java_script_enabled=True)  # type: ignore[arg-type]
    page = context.new_page()
    asked: list[str] = []
    page.on("request", lambda request: asked.append(request.url))
    page.goto(report.as_uri())
    assert [url for url in asked if not url.startswith(("file:", "data:"))] == []
    yield page
    context.close()


def test_it_prints_on_two_to_four_pages_with_nothing_cut_off(opened: Page) -> None:
    opened.emulate_media(media="print")
    assert opened.evaluate(OVERFLOWING) == []
    printed = opened.pdf(prefer_css_page_size=True, print_background=True)
    assert 2 <= len(re.findall(rb"/Type\s*/Page\b", printed)) <= 4
    boxes = {tuple(map(float, box.split())) for box in re.findall(rb"/MediaBox\s*\[([^\]]+)\]", printed)}
    assert [round(side) for side in max(boxes)[2:]] == [595, 842]  # A4 in points


def test_it_is_read_on_a_phone_and_light_on_a_dark_screen(opened: Page) -> None:
    assert opened.evaluate("getComputedStyle(document.body).backgroundColor") == "rgb(255, 255, 255)"
    assert opened.evaluate("getComputedStyle(document.documentElement).colorScheme") == "light"
    smallest = opened.evaluate(
        """() => Math.min(...[...document.querySelectorAll("body *")].filter(each => each.childNodes.length
             && [...each.childNodes].some(node => node.nodeType === 3 && node.textContent.trim()))
             .map(each => parseFloat(getComputedStyle(each).fontSize)))"""
    )
    assert smallest >= 10  # 7.5 pt on paper
    opened.set_viewport_size({"width": 390, "height": 800})
    assert opened.evaluate("document.documentElement.scrollWidth") <= 390
