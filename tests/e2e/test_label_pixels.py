"""Where the label page draws: pixels as stored, candidates exactly on them."""

from __future__ import annotations

import io
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Page

from app.formats.label_npy import write_label_npy
from app.vision.segments import Segments

WIDTH, HEIGHT = 640, 480
FIT_MARGIN = 12
ZOOM_STEP = 1.4
KEEP = (0x2E, 0xE6, 0xA0)


def line(start: tuple[float, float], end: tuple[float, float]) -> np.ndarray:
    return np.linspace(start, end, 200, dtype=np.float32)


def write_labels(folder: Path, name: str, *lines: np.ndarray) -> None:
    path = folder / "labels" / f"{name}_edge_segments_filtered.npy"
    path.write_bytes(write_label_npy(Segments.from_list(list(lines))))


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory, label_server: Any, import_dataset: Callable[..., None]) -> Any:
    folder = tmp_path_factory.mktemp("pixels")
    for part in ("images", "labels"):
        (folder / part).mkdir()
    cross = np.zeros((HEIGHT, WIDTH), np.uint8)
    cross[240, :] = cross[:, 320] = 255
    cv2.imwrite(str(folder / "images" / "cross.png"), cross)
    write_labels(folder, "cross", line((320, 100), (320, 380)), line((100, 240), (540, 240)))
    halves = np.full((HEIGHT, WIDTH), 20, np.uint8)
    halves[:, WIDTH // 2 :] = 235
    turned = Image.fromarray(halves)
    exif = turned.getexif()
    exif[0x0112] = 6
    turned.save(folder / "images" / "turned.jpg", exif=exif, quality=95)
    write_labels(folder, "turned", line((319.5, 60), (319.5, 420)))
    import_dataset(label_server, folder, "pixels")
    return label_server


def open_image(page: Page, server: Any, name: str) -> None:
    images = {image["name"]: image["id"] for image in server.ask("/datasets/pixels/images")["items"]}
    page.goto(f"{server.address}/datasets/pixels/images/{images[name]}")
    page.locator("[role=application][aria-busy=false]").wait_for()


def screen(page: Page) -> np.ndarray:
    """The image region as RGB, in screen px, as floats."""
    content = page.get_by_role("application").screenshot()
    return np.asarray(Image.open(io.BytesIO(content)).convert("RGB"), dtype=float)


def settled_screen(page: Page) -> np.ndarray:
    """The image region once two looks at it are the same: a view that moved is drawn exactly a moment later."""
    before = screen(page)
    for _ in range(50):
        page.wait_for_timeout(150)
        after = screen(page)
        if np.array_equal(before, after):
            return after
        before = after
    pytest.fail("the image doesn't come to rest")


def is_line(pixels: np.ndarray) -> np.ndarray:
    """Whether pixels have the colour of a kept line."""
    return np.abs(pixels - KEEP).max(axis=-1) < 40


def middle(mask: np.ndarray) -> float:
    """The middle of the set positions; screen px count from their left edge."""
    return float(np.nonzero(mask)[0].mean()) + 0.5


@pytest.mark.parametrize("zooms", [0, 9])
def test_a_line_lies_on_the_middle_of_its_pixels(page: Page, server: Any, zooms: int) -> None:
    open_image(page, server, "cross")
    for _ in range(zooms):
        page.keyboard.press("+")
    shown = settled_screen(page)
    height, width, _ = shown.shape
    fit = min((width - 2 * FIT_MARGIN) / WIDTH, (height - 2 * FIT_MARGIN) / HEIGHT)
    scale = fit * ZOOM_STEP**zooms
    # The image's middle, the corner of the pixels (319, 239) and (320, 240), stays in the screen's middle.
    expected_x, expected_y = width / 2 + scale / 2, height / 2 + scale / 2
    away = int(20 + 3 * scale)
    row = shown[int(expected_y) - away]
    column = shown[:, int(expected_x) - away]
    assert middle(is_line(row)) == pytest.approx(expected_x, abs=0.6)
    assert middle(is_line(column)) == pytest.approx(expected_y, abs=0.6)
    if zooms:
        # So far in, the bright pixels beside the line are seen themselves: it runs through their middle.
        bright = row.min(axis=-1) > 200
        edges = np.nonzero(bright)[0]
        edges = edges[np.abs(edges - expected_x) < 3 * scale]  # the tool bar is bright too
        assert edges.max() - edges.min() + 1 == pytest.approx(scale, abs=1.5)
        assert (edges.min() + edges.max() + 1) / 2 == pytest.approx(middle(is_line(row)), abs=0.75)


def test_an_orientation_in_the_file_turns_neither_the_image_nor_its_lines(page: Page, server: Any) -> None:
    open_image(page, server, "turned")
    shown = settled_screen(page)
    height, width, _ = shown.shape
    for y in (height // 2 - 150, height // 2 + 150):
        row = shown[y]
        x = middle(is_line(row))
        assert x == pytest.approx(width / 2, abs=0.6)
        grey = row.mean(axis=-1)
        assert grey[int(x) - 60] == pytest.approx(20, abs=6)
        assert grey[int(x) + 60] == pytest.approx(235, abs=6)
