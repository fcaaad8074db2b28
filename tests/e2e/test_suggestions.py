"""Suggestions in a real browser: marked until they are accepted, for what is on the screen, and how good they are."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any
from uuid import uuid4

import cv2
import numpy as np
import pytest
from playwright.sync_api import Locator, Page, expect

pytestmark = pytest.mark.xdist_group("pages")

LINES = 24


def write_street(folder: Path) -> None:
    """Write three pictures with upright edges, and candidates that nobody judged: half along them, half that bend."""
    for number in range(3):
        random = np.random.default_rng(number)
        image = np.full((300, 480), 90, np.uint8)
        lines = []
        for index in range(LINES):
            x, y = 20 + 38 * (index // 2), np.linspace(60, 160, 60)
            if index % 2:
                cv2.rectangle(image, (x, 60), (x + 16, 160), int(random.integers(150, 255)), -1)
                lines.append(np.stack([np.full(60, x - 0.5), y], axis=1))
            else:
                lines.append(np.stack([x + 24 + 9 * np.sin(y / 25 + index), y], axis=1))
        segments = [{"points": line.round(2).tolist(), "verdict": "undecided"} for line in lines]
        for kind in ("images", "labels"):
            (folder / kind).mkdir(parents=True, exist_ok=True)
        cv2.imwrite(str(folder / "images" / f"{number}.png"), cv2.GaussianBlur(image, (0, 0), 0.8))
        (folder / "labels" / f"{number}.json").write_text(json.dumps({"segments": segments}))


@pytest.fixture(scope="module")
def server(
    label_server: Any, import_dataset: Callable[[Any, Path, str], None], tmp_path_factory: pytest.TempPathFactory
) -> Any:
    """The server with the dataset `suggested`."""
    folder = tmp_path_factory.mktemp("suggested")
    write_street(folder)
    import_dataset(label_server, folder, "Suggested")
    return label_server


def images(server: Any) -> list[int]:
    return [image["id"] for image in server.ask("/datasets/suggested/images")["items"]]


def open_image(page: Page, server: Any, image_id: int, segment_id: int | None = None) -> Locator:
    """Open an image, perhaps at a candidate, with both thresholds at 50 %: all is suggested one way or the other."""
    selected = "" if segment_id is None else f"?segment={segment_id}"
    page.goto(f"{server.address}/datasets/suggested/images/{image_id}{selected}")
    panel = page.get_by_role("region", name="Suggestions")
    panel.get_by_label("Keep from").fill("0.5")
    panel.get_by_label("Reject below").fill("0.5")
    return panel


def suggested(server: Any, image_id: int) -> dict[int, float]:
    answer = server.ask(f"/images/{image_id}/suggestions")
    return {segment["id"]: segment["probability"] for segment in answer["segments"]}


def counts_on(panel: Locator) -> tuple[int, int]:
    """How many would be kept and rejected, as the button says."""
    text = panel.get_by_role("button", name=re.compile("^(Keep|Reject|Nothing)")).inner_text()
    numbers = {word.lower(): int(number) for word, number in re.findall(r"(Keep|reject|Reject) (\d+)", text)}
    return numbers.get("keep", 0), numbers.get("reject", 0)


def progress(page: Page) -> Locator:
    return page.get_by_label("Progress").locator(".panel-progress")


def test_s_accepts_what_is_suggested_on_the_screen_and_undo_takes_it_back(page: Page, server: Any) -> None:
    [image_id, *_] = images(server)
    panel = open_image(page, server, image_id)
    probability = suggested(server, image_id)
    keep = sum(value >= 0.5 for value in probability.values())
    button = panel.get_by_role("button", name=re.compile(rf"^Keep {keep}, reject {LINES - keep}\b"))
    expect(button).to_be_visible()
    # a suggestion decides nothing
    expect(progress(page)).to_have_text(f"0 of {LINES} judged")
    assert server.ask(f"/images/{image_id}/decisions")["decisions"] == []

    for _ in range(3):
        page.keyboard.press("+")
    expect(button).not_to_be_visible()
    page.keyboard.press("s")
    toast = page.get_by_text("by suggestion")
    expect(toast).to_be_visible()
    seen = sum(int(number) for number in re.findall(r"\d+", toast.inner_text()))
    assert 0 < seen < LINES
    expect(progress(page)).to_have_text(f"{seen} of {LINES} judged")
    expect(page.get_by_text("All saved")).to_be_visible()
    stored = server.ask(f"/images/{image_id}/decisions")["decisions"]
    assert {decision["kind"] for decision in stored} == {"accept"}
    assert len({decision["group_id"] for decision in stored}) == 1
    assert all(decision["suggestion"] == probability[decision["segment_id"]] for decision in stored)
    assert all((decision["verdict"] == "keep") == (decision["suggestion"] >= 0.5) for decision in stored)

    page.get_by_role("button", name="Undo", exact=True).last.click()
    expect(progress(page)).to_have_text(f"0 of {LINES} judged")
    page.keyboard.press("f")
    expect(button).to_be_visible()
    page.keyboard.press("s")
    expect(progress(page)).to_have_text(f"{LINES} of {LINES} judged")
    expect(panel.get_by_role("button", name="Nothing to accept")).to_be_disabled()
    page.keyboard.press("z")
    expect(progress(page)).to_have_text(f"0 of {LINES} judged")
    expect(button).to_be_visible()


def test_thresholds_leave_what_is_between_them_to_a_person(page: Page, server: Any) -> None:
    [_, image_id, _] = images(server)
    panel = open_image(page, server, image_id)
    probability = sorted(suggested(server, image_id).values())
    panel.get_by_label("Keep from").fill("1")
    panel.get_by_label("Reject below").fill("0.3")
    below = sum(value < 0.3 for value in probability)
    expect(panel.get_by_role("button", name=re.compile(rf"^Reject {below}\b" if below else "^Nothing"))).to_be_visible()
    panel.get_by_role("button", name="Reset").click()
    model = server.ask(f"/images/{image_id}/suggestions")["thresholds"]
    kept = sum(value >= model["keep"] for value in probability)
    rejected = sum(value < model["reject"] for value in probability)
    expect(panel.get_by_role("button", name="Reset")).to_have_count(0)
    assert counts_on(panel) == (kept, rejected)

    # hidden, nothing is accepted
    page.keyboard.press("Shift+S")
    expect(panel.get_by_label("Keep from")).to_have_count(0)
    page.keyboard.press("s")
    expect(page.get_by_text("Suggestions are hidden")).to_be_visible()
    expect(progress(page)).to_have_text(f"0 of {LINES} judged")
    page.keyboard.press("Shift+S")
    expect(panel.get_by_label("Keep from")).to_be_visible()


def test_o_reviews_in_another_order_and_a_verdict_tells_what_was_suggested(page: Page, server: Any) -> None:
    [_, image_id, _] = images(server)
    open_image(page, server, image_id)
    worth = {segment["id"]: segment for segment in server.ask(f"/images/{image_id}/suggestions")["segments"]}
    order = page.get_by_role("group", name="Order of review")
    for kind in ("Score", "Length", "Value", "Lens", "Place", "Score", "Length", "Value"):
        page.keyboard.press("o")
        expect(order.get_by_role("radio", name=kind)).to_be_checked()
    best = max(worth, key=lambda key: worth[key]["value"])
    expect(page).to_have_url(re.compile(rf"segment={best}$"))
    fact = page.get_by_test_id("suggestion")
    expect(fact).to_contain_text(f"{round(100 * worth[best]['probability'])} %")
    page.keyboard.press("k")
    expect(page.get_by_text("All saved")).to_be_visible()
    [decision] = server.ask(f"/images/{image_id}/decisions")["decisions"]
    assert (decision["segment_id"], decision["kind"]) == (best, "judge")
    assert decision["suggestion"] == worth[best]["probability"]
    page.keyboard.press("z")
    for _ in range(2):
        page.keyboard.press("o")
    expect(order.get_by_role("radio", name="Place")).to_be_checked()


def test_the_page_tells_how_good_they_are_once_something_was_learnt(page: Page, server: Any) -> None:
    page.goto(f"{server.address}/datasets/suggested/suggestions")
    expect(page.get_by_role("heading", name="Nothing is learnt here yet")).to_be_visible()
    learn = page.get_by_role("button", name="Learn now")
    expect(learn).to_be_disabled()
    for image_id in images(server)[:2]:
        group = str(uuid4())
        segments = server.ask(f"/images/{image_id}/segments")["segments"]
        decisions = [
            {
                "client_id": str(uuid4()),
                "group_id": group,
                "segment_id": segment["id"],
                "verdict": "keep" if number % 2 else "reject",
            }
            for number, segment in enumerate(segments)
        ]
        server.ask(f"/images/{image_id}/decisions", {"decisions": decisions})
    page.reload()
    if learn.is_enabled():
        learn.click()
    expect(page.get_by_text(re.compile(r"Model \d+, learnt from 48 decisions on 2 images"))).to_be_visible(
        timeout=60_000
    )
    expect(page.get_by_role("heading", name="Are probabilities what they say?")).to_be_visible()
    expect(page.get_by_role("heading", name="What suggestions spare")).to_be_visible()
    page.goto(f"{server.address}/datasets/suggested/images/{images(server)[2]}")
    panel = page.get_by_role("region", name="Suggestions")
    expect(panel).to_contain_text("learnt from 48 decisions on 2 images")
    panel.get_by_role("link", name="How good it is").click()
    expect(page.get_by_role("heading", name="Suggestions", exact=True)).to_be_visible()


def test_one_key_accepts_what_was_left_as_suggested_and_finishes_the_image(page: Page, server: Any) -> None:
    [_, _, image_id] = images(server)
    probability = suggested(server, image_id)
    mended = max(probability, key=lambda segment_id: probability[segment_id])
    open_image(page, server, image_id, mended)
    page.get_by_role("application").focus()
    page.keyboard.press("x")
    expect(progress(page)).to_have_text(f"1 of {LINES} judged")
    page.keyboard.press("Shift+Enter")
    expect(page).not_to_have_url(re.compile(rf"/images/{image_id}\b"))
    assert server.ask(f"/images/{image_id}")["status"] == "done"
    decisions = {each["segment_id"]: each for each in server.ask(f"/images/{image_id}/decisions")["decisions"]}
    assert len(decisions) == LINES
    for segment_id, decision in decisions.items():
        as_suggested = (decision["verdict"] == "keep") == (probability[segment_id] >= 0.5)
        assert (decision["kind"], as_suggested) == (("judge", False) if segment_id == mended else ("accept", True))
