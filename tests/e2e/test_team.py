"""Guidelines, tasks, second reviews, differences and statistics, as the people of a dataset meet them."""

from __future__ import annotations

import json
import re
import urllib.parse
import urllib.request
from collections.abc import Callable
from pathlib import Path
from typing import Any
from uuid import uuid4

import cv2
import numpy as np
import pytest
from playwright.sync_api import Page, expect

from app.formats.label_npy import write_label_npy
from app.vision.segments import Segments

ROWS = (40, 80, 120, 160)


def ask(server: Any, method: str, path: str, body: object = None, *, person: str = "Mara") -> Any:
    """Return what the API answers to a person."""
    request = urllib.request.Request(
        f"{server.address}/api{path}",
        None if body is None else json.dumps(body).encode(),
        {"Content-Type": "application/json", "X-ClearLines-Person": urllib.parse.quote(person)},
        method=method,
    )
    with urllib.request.urlopen(request, timeout=30) as answer:
        return json.load(answer)


def judge(server: Any, image: int, verdicts: list[str]) -> None:
    """Judge an image's candidates from the top to the bottom, as Mara, and finish it."""
    segments = sorted(ask(server, "GET", f"/images/{image}/segments")["segments"], key=lambda one: one["box"][1])
    decisions = [
        {
            "client_id": str(uuid4()),
            "group_id": str(uuid4()),
            "segment_id": segment["id"],
            "verdict": verdict,
            "elapsed_ms": 900,
        }
        for segment, verdict in zip(segments, verdicts, strict=True)
    ]
    ask(server, "POST", f"/images/{image}/decisions", {"decisions": decisions})
    ask(server, "PUT", f"/images/{image}/review", {"status": "done"})


@pytest.fixture(scope="module")
def team(
    tmp_path_factory: pytest.TempPathFactory, label_server: Any, import_dataset: Callable[[Any, Path, str], None]
) -> dict[str, int]:
    """A dataset of two images that Mara has reviewed; every image is to be reviewed twice."""
    folder = tmp_path_factory.mktemp("team")
    for part in ("images", "labels"):
        (folder / part).mkdir()
    label = Segments.from_list([np.linspace((20, row), (280, row), 60, dtype=np.float32) for row in ROWS])
    for number, name in enumerate(("first", "second")):
        picture = np.full((200, 300), 90 + number, np.uint8)
        for row in ROWS:
            picture[row : row + 20] = 200
        cv2.imwrite(str(folder / "images" / f"{name}.png"), picture)
        (folder / "labels" / f"{name}_edge_segments_filtered.npy").write_bytes(write_label_npy(label))
    import_dataset(label_server, folder, "Team")
    ids = {image["name"]: image["id"] for image in label_server.ask("/datasets/team/images")["items"]}
    judge(label_server, ids["first"], ["keep", "keep", "reject", "reject"])
    judge(label_server, ids["second"], ["keep", "reject", "reject", "reject"])
    return ids


def open_tab(page: Page, server: Any, tab: str) -> None:
    page.goto(f"{server.address}/datasets/team?tab={tab}")
    expect(page.get_by_role("link", name=re.compile(tab, re.IGNORECASE))).to_have_attribute("aria-current", "page")


def test_from_guidelines_to_a_decision_between_two(page: Page, label_server: Any, team: dict[str, int]) -> None:
    # whoever imported the candidates as labels took part in the first review
    page.add_init_script("localStorage.setItem('clearlines-person', 'Ada')")
    open_tab(page, label_server, "team")
    guidelines = page.get_by_role("region", name="Guidelines and rules")
    guidelines.get_by_role("button", name="Edit").click()
    guidelines.get_by_role("textbox", name="Guidelines").fill("Kerbs count.\nTrees don't.")
    guidelines.get_by_label("Share reviewed a second time, %").fill("100")
    guidelines.get_by_role("button", name="Save").click()
    expect(guidelines.get_by_text("100 % of the images are reviewed a second time")).to_be_visible()

    # the second review: nothing of the first is told
    told: list[str] = []
    page.on("response", lambda answer: told.append(answer.url) if "/api/images/" in answer.url else None)
    page.get_by_role("link", name="Begin the next").click()
    expect(page.get_by_role("application")).to_have_attribute("aria-busy", "false")
    expect(page.get_by_text("0 of 4 judged")).to_be_visible()
    assert not [url for url in told if re.search(r"/images/\d+(/segments|/decisions|/suggestions|$)", url)]
    page.keyboard.press("k")
    expect(page.get_by_text("1 of 4 judged")).to_be_visible()
    expect(page.get_by_text("All saved")).to_be_visible()
    page.reload()
    expect(page.get_by_text("1 of 4 judged")).to_be_visible()
    page.keyboard.press("z")
    expect(page.get_by_text("0 of 4 judged")).to_be_visible()
    page.keyboard.press("Shift+Z")
    page.keyboard.press("r")
    expect(page.get_by_text("4 of 4 judged")).to_be_visible()
    page.keyboard.press("Enter")
    # on to the second image, where both agree
    expect(page.get_by_text("0 of 4 judged")).to_be_visible()
    page.keyboard.press("k")
    page.keyboard.press("r")
    page.keyboard.press("Enter")
    expect(page.get_by_text("no other image waits")).to_be_visible()

    agreement = page.get_by_role("region", name="Agreement")
    # seven of eight verdicts: 7/8 observed, (3 * 2 + 5 * 6) / 64 by chance
    expect(agreement.get_by_text("κ 0.71")).to_be_visible()
    agreement.get_by_role("link", name="Decide on 1 difference").click()
    expect(page.get_by_text("0 of 1 decided")).to_be_visible()
    said = page.locator("#difference-said")
    expect(said).to_contain_text("Mara")
    expect(page.get_by_role("application")).to_have_attribute("aria-busy", "false")
    page.keyboard.press("a")
    expect(page.get_by_text("1 of 1 decided")).to_be_visible()
    assert ask(label_server, "GET", f"/images/{team['first']}")["verdicts"]["ambiguous"] == 1
    page.keyboard.press("z")
    expect(page.get_by_text("0 of 1 decided")).to_be_visible()
    assert ask(label_server, "GET", f"/images/{team['first']}")["verdicts"]["ambiguous"] == 0
    page.keyboard.press("k")
    expect(page.get_by_text("1 of 1 decided")).to_be_visible()


def test_guidelines_and_other_images_one_key_away(page: Page, label_server: Any, team: dict[str, int]) -> None:
    ask(label_server, "PATCH", "/datasets/team", {"guidelines": "Kerbs count."})
    page.goto(f"{label_server.address}/datasets/team/images/{team['first']}")
    expect(page.get_by_role("application")).to_have_attribute("aria-busy", "false")
    page.keyboard.press("Shift+G")
    expect(page.get_by_role("region", name="Guidelines").get_by_text("Kerbs count.")).to_be_visible()
    page.keyboard.press("/")
    page.keyboard.type("sec")
    expect(page.get_by_role("option")).to_have_count(1)
    page.keyboard.press("Enter")
    expect(page).to_have_url(re.compile(f"/images/{team['second']}"))
    page.keyboard.press("/")
    page.keyboard.press("Escape")
    expect(page.get_by_role("application")).to_be_focused()


def test_tasks_are_given_out_and_found_again(page: Page, label_server: Any, team: dict[str, int]) -> None:
    open_tab(page, label_server, "images")
    page.get_by_role("button", name="More filters").click()
    page.get_by_label("Decided on by").select_option("Mara")
    expect(page).to_have_url(re.compile("person=Mara"))
    expect(page.get_by_text("2 of 2 images")).to_be_visible()
    page.get_by_label("Verdicts").select_option("Something undecided")
    expect(page.get_by_text("No image fits")).to_be_visible()

    ask(label_server, "POST", "/datasets/team/assign", {"people": ["Jon"], "mode": "to", "image_ids": [team["second"]]})
    open_tab(page, label_server, "team")
    page.get_by_role("table", name="Tasks").or_(page.locator("table")).first.get_by_role("link", name="Jon").click()
    expect(page).to_have_url(re.compile("assignee=Jon"))
    expect(page.get_by_text("1 of 2 images")).to_be_visible()


def test_statistics_of_the_work(page: Page, label_server: Any, team: dict[str, int]) -> None:
    open_tab(page, label_server, "statistics")
    expect(page.get_by_role("heading", name="Time per decision")).to_be_visible()
    expect(page.get_by_role("row", name=re.compile("Mara"))).to_contain_text("0.9 s")
    expect(page.get_by_role("img", name=re.compile("Decisions by the time they took"))).to_be_visible()
    page.get_by_role("group", name="Verdict").get_by_text("Reject").click()
    expect(page.get_by_role("img", name=re.compile("Decisions by the time they took"))).to_be_visible()
    expect(page.get_by_text("None given yet")).to_be_visible()
