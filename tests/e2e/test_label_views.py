"""Other views of the image under review, and what speaks for a candidate."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import cv2
import numpy as np
import pytest
from playwright.sync_api import Page, expect
from sqlalchemy import select

from app.db.models import RunImage
from app.db.session import open_database
from app.vision.brown import Brown
from app.vision.distortion import DistortionEstimate
from app.vision.division import Division
from app.vision.field import FieldError
from app.vision.lens_uncertainty import LensUncertainty

WIDTH, HEIGHT = 400, 300


@pytest.fixture(scope="module")
def images(
    tmp_path_factory: pytest.TempPathFactory, label_server: Any, import_dataset: Callable[..., None]
) -> dict[str, int]:
    """Two dark images of beams; the lens of the one is known."""
    folder = tmp_path_factory.mktemp("views")
    (folder / "images").mkdir()
    for number, name in enumerate(("known", "unknown")):
        picture = np.full((HEIGHT, WIDTH), 20 + number, np.uint8)
        for y in (40, 120, 220):
            picture[y : y + 24] = 50
        cv2.imwrite(str(folder / "images" / f"{name}.png"), picture)
    import_dataset(label_server, folder, "Views")
    ids = {image["name"]: image["id"] for image in label_server.ask("/datasets/views/images")["items"]}
    run = label_server.ask("/datasets/views/runs", {"image_ids": list(ids.values()), "min_length": 30})["id"]
    deadline = time.monotonic() + 90
    while (state := label_server.ask(f"/runs/{run}"))["status"] != "done":
        assert state["status"] != "failed", state["error"]
        assert time.monotonic() < deadline
        time.sleep(0.1)
    # so few lines tell nothing of a lens: one is put in the place of the estimate
    estimate = DistortionEstimate(
        brown=Brown(WIDTH, HEIGHT, (199.5, 149.5), 250.0, (0.25, 0.0, 0.0)),
        division=Division(WIDTH, HEIGHT),
        refit_error=FieldError(0.0, 0.0),
        uncertainty=LensUncertainty(0.5, 0.5, 0.0),
        accepted=True,
        reasons=(),
        counts={},
    )
    database = open_database(f"sqlite:///{next(label_server.data.glob('*.sqlite3'))}")
    with database.write() as session:
        session.scalars(select(RunImage).where(RunImage.image_id == ids["known"])).one().distortion = estimate.as_dict()
    database.close()
    return ids


def open_image(page: Page, server: Any, image: int) -> None:
    page.goto(f"{server.address}/datasets/views/images/{image}")
    expect(page.get_by_role("application")).to_have_attribute("aria-busy", "false")


def black_share(page: Page) -> float:
    """Share of the image's canvas that is painted black."""
    return page.locator(".label-canvas canvas").first.evaluate(
        """canvas => {
          const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
          let black = 0;
          for (let i = 0; i < data.length; i += 4)
            if (data[i + 3] === 255 && data[i] + data[i + 1] + data[i + 2] < 15) black++;
          return black / (data.length / 4);
        }"""
    )


def test_evidence_of_the_selected_candidate(page: Page, label_server: Any, images: dict[str, int]) -> None:
    open_image(page, label_server, images["known"])
    page.keyboard.press("Tab")
    section = page.get_by_label("Selected candidate")
    expect(section.get_by_role("img", name="Deviation from straight")).to_be_visible()
    expect(section.get_by_text("under the camera's lens")).to_be_visible()
    expect(section.get_by_text("levels")).to_be_visible()

    open_image(page, label_server, images["unknown"])
    page.keyboard.press("Tab")
    expect(section.get_by_text("the lens isn't known yet")).to_be_visible()


def test_views_by_key_and_by_hand(page: Page, label_server: Any, images: dict[str, int]) -> None:
    open_image(page, label_server, images["known"])
    choice = page.get_by_role("group", name="View of the image")
    assert black_share(page) == 0

    with page.expect_response("**/points?view=undistorted"), page.expect_response("**/display?view=undistorted"):
        page.keyboard.press("v")
    expect(choice.get_by_label("Straight")).to_be_checked()
    # the corrected image is smaller than the frame along its edges, where nothing is seen
    deadline = time.monotonic() + 10
    while black_share(page) < 0.01:
        assert time.monotonic() < deadline
    # candidates can be judged in every view
    page.keyboard.press("Tab")
    page.keyboard.press("k")
    expect(page.get_by_text("1 of 6 judged")).to_be_visible()

    page.keyboard.press("v")
    expect(choice.get_by_label("Plain")).to_be_checked()
    page.keyboard.press("b")
    expect(choice.get_by_label("CLAHE")).to_be_checked()
    choice.get_by_text("Plain").click()
    expect(choice.get_by_label("Plain")).to_be_checked()


def test_a_lens_that_is_not_known_is_told_and_the_plain_image_stays(
    page: Page, label_server: Any, images: dict[str, int]
) -> None:
    open_image(page, label_server, images["unknown"])
    page.keyboard.press("v")
    expect(page.get_by_text("lens of this image isn't known yet")).to_be_visible()
    expect(page.get_by_role("group", name="View of the image").get_by_label("Plain")).to_be_checked()


def test_brightness_by_keys_and_back_to_normal(page: Page, label_server: Any, images: dict[str, int]) -> None:
    open_image(page, label_server, images["known"])
    picture = page.locator(".label-canvas canvas").first
    page.keyboard.press(".")
    page.keyboard.press(".")
    expect(page.get_by_text("Brightness +2")).to_be_visible()
    expect(picture).to_have_css("filter", "brightness(1.69)")
    # a dark drive is dark all along
    page.keyboard.press("n")
    expect(page.get_by_role("application", name="unknown")).to_be_visible()
    expect(picture).to_have_css("filter", "brightness(1.69)")
    page.keyboard.press("Shift+B")
    expect(picture).to_have_css("filter", "none")
