"""Many candidates at once on the label page: strokes, a lasso, families, filters, reasons; by keys, mouse and touch."""

from __future__ import annotations

import io
import json
import time
import urllib.request
from collections import Counter
from collections.abc import Callable
from typing import Any
from uuid import uuid4

import cv2
import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Browser, Page, expect

from app.formats.label_npy import write_label_npy
from app.vision.segments import Segments

WIDTH, HEIGHT = 640, 480
# In the order of review; the fourth and the fifth are the two sides of a pole.
COLUMNS = (60, 140, 220, 300, 308, 400, 480, 560)
LENGTHS = (280, 280, 280, 280, 280, 280, 60, 40)
MIDDLE = 240
IMAGES = ("brush", "turn", "lasso", "family", "filter", "focus", "reason", "touch", "frame-0", "frame-1")


@pytest.fixture(scope="module")
def images(
    tmp_path_factory: pytest.TempPathFactory, label_server: Any, import_dataset: Callable[..., None]
) -> dict[str, int]:
    """One image for each test, by name, all with the same undecided candidates; the frames are of one drive."""
    folder = tmp_path_factory.mktemp("tools")
    for part in ("images", "labels"):
        (folder / part).mkdir()
    lines = [
        np.linspace((x, MIDDLE - length / 2), (x, MIDDLE + length / 2), 80, dtype=np.float32)
        for x, length in zip(COLUMNS, LENGTHS, strict=True)
    ]
    labels = write_label_npy(Segments.from_list(lines))
    table = ["name,camera,source,sequence"]
    for number, name in enumerate(IMAGES):
        cv2.imwrite(str(folder / "images" / f"{name}.png"), np.full((HEIGHT, WIDTH), 60 + number, np.uint8))
        (folder / "labels" / f"{name}_edge_segments_filtered.npy").write_bytes(labels)
        table.append(f"{name},front,street,{'drive' if name.startswith('frame') else name}")
    (folder / "images.csv").write_text("\n".join(table))
    import_dataset(label_server, folder, "tools")
    found = {image["name"]: image["id"] for image in label_server.ask("/datasets/tools/images")["items"]}
    for name in IMAGES:
        send(label_server, found[name], dict.fromkeys(range(len(COLUMNS)), "undecided"))
    return found


def segments(server: Any, image: int) -> list[Any]:
    """The candidates as the server has them, from left to right."""
    return sorted(server.ask(f"/images/{image}/segments")["segments"], key=lambda segment: segment["box"][0])


def send(server: Any, image: int, verdicts: dict[int, str]) -> None:
    ids = [segment["id"] for segment in segments(server, image)]
    group = str(uuid4())
    decisions = [
        {"client_id": str(uuid4()), "group_id": group, "segment_id": ids[place], "verdict": verdict}
        for place, verdict in verdicts.items()
    ]
    server.ask(f"/images/{image}/decisions", {"decisions": decisions})


def open_image(page: Page, server: Any, image: int) -> None:
    page.goto(f"{server.address}/datasets/tools/images/{image}")
    page.locator("[role=application][aria-busy=false]").wait_for()
    selection(page).to_contain_text("Candidate 1 of 8")


def place(page: Page, x: float, y: float) -> tuple[float, float]:
    """Where on the page the centre of an image pixel is while the whole image is shown."""
    box = page.get_by_role("application").bounding_box()
    assert box
    scale = min((box["width"] - 24) / WIDTH, (box["height"] - 24) / HEIGHT)
    return (
        box["x"] + box["width"] / 2 + (x + 0.5 - WIDTH / 2) * scale,
        box["y"] + box["height"] / 2 + (y + 0.5 - HEIGHT / 2) * scale,
    )


def drag(page: Page, *places: tuple[float, float]) -> None:
    first, *others = [place(page, x, y) for x, y in places]
    page.mouse.move(*first)
    page.mouse.down()
    for x, y in others:
        page.mouse.move(x, y, steps=5)
    page.mouse.up()


def selection(page: Page) -> Any:
    return expect(page.locator("#label-selection"))


def judged(page: Page, count: int) -> None:
    expect(page.get_by_label("Progress").locator(".panel-progress")).to_have_text(f"{count} of 8 judged")


def comes(ask: Callable[[], Any], expected: Any) -> None:
    """Wait until the server says so: what the page sends is on its way."""
    deadline = time.monotonic() + 10
    while (found := ask()) != expected:
        assert time.monotonic() < deadline, f"the server has {found}"


def stored(server: Any, image: int, *expected: str) -> None:
    """Wait until the server has these verdicts, from left to right."""
    comes(lambda: [segment["verdict"] for segment in segments(server, image)], list(expected))


def groups(server: Any, image: int, kind: str = "judge") -> list[int]:
    """How many candidates each act of this kind was about, after those that the test began with."""
    decisions = server.ask(f"/images/{image}/decisions")["decisions"]
    sizes = Counter(entry["group_id"] for entry in decisions if entry["kind"] == kind)
    return list(sizes.values())[1 if kind == "judge" else 0 :]


def test_a_stroke_judges_what_it_touches_and_a_click_the_nearest(
    page: Page, label_server: Any, images: dict[str, int]
) -> None:
    image = images["brush"]
    open_image(page, label_server, image)
    page.keyboard.down("w")
    drag(page, (40, 200), (250, 220))
    page.keyboard.up("w")
    judged(page, 3)
    expect(page.get_by_text("3 candidates kept")).to_be_visible()
    page.keyboard.down("e")
    page.mouse.click(*place(page, 309, 150))
    page.keyboard.up("e")
    judged(page, 4)
    # Judged ones too; the key comes up before the button, and the stroke still counts.
    page.keyboard.down("e")
    page.mouse.move(*place(page, 200, 300))
    page.mouse.down()
    page.mouse.move(*place(page, 420, 300), steps=5)
    page.keyboard.up("e")
    page.mouse.up()
    judged(page, 6)
    stored(label_server, image, *["keep"] * 2, *["reject"] * 4, *["undecided"] * 2)
    assert groups(label_server, image) == [3, 1, 3]
    page.keyboard.press("z")
    judged(page, 4)
    stored(label_server, image, *["keep"] * 3, "undecided", "reject", *["undecided"] * 3)
    # A stroke that Escape ends was never made; without the key the image moves.
    page.keyboard.down("w")
    page.mouse.move(*place(page, 350, 300))
    page.mouse.down()
    page.mouse.move(*place(page, 600, 300), steps=5)
    page.keyboard.press("Escape")
    page.mouse.up()
    page.keyboard.up("w")
    drag(page, (350, 300), (600, 310))
    judged(page, 4)


def test_the_turn_brush_turns_what_is_as_likely_between_two_wrong_lines(
    page: Page, label_server: Any, images: dict[str, int]
) -> None:
    image = images["turn"]
    found = label_server.ask(f"/images/{image}/suggestions")["segments"]
    of = {segment["id"]: segment["probability"] for segment in found}
    probability = [of[segment["id"]] for segment in segments(label_server, image)]
    suggested = ["keep" if value >= 0.5 else "reject" for value in probability]

    def turned(first: int, last: int) -> list[int]:
        low, high = sorted((probability[first], probability[last]))
        return [line for line in range(first, last + 1) if low <= probability[line] <= high]

    def after(lines: list[int]) -> list[str]:
        other = {"keep": "reject", "reject": "keep"}
        return [other[verdict] if line in lines else verdict for line, verdict in enumerate(suggested)]

    # the first two of which something between turns too, and something stays
    first, last = next(
        (first, last)
        for first in range(5)
        for last in range(first + 3, 6)
        if 2 < len(turned(first, last)) <= last - first
    )
    open_image(page, label_server, image)
    panel = page.get_by_role("region", name="Suggestions")
    panel.get_by_label("Keep from").fill("0.5")
    panel.get_by_label("Reject below").fill("0.5")
    page.keyboard.press("s")
    judged(page, 8)
    page.keyboard.down("t")
    drag(page, (COLUMNS[first], 200), (COLUMNS[last], 220))
    expect(page.get_by_text(f"{len(turned(first, last))} candidates turned")).to_be_visible()
    stored(label_server, image, *after(turned(first, last)))
    page.mouse.click(*place(page, COLUMNS[first], 300))
    page.keyboard.up("t")
    stored(label_server, image, *after(turned(first, last)[1:]))
    for _ in range(2):
        page.keyboard.press("z")
    stored(label_server, image, *suggested)
    # Without a key to hold, by the tool bar; it stays in hand on another image.
    button = page.get_by_role("button", name="Turn brush")
    button.click()
    page.mouse.click(*place(page, COLUMNS[7], 240))
    stored(label_server, image, *after([7]))
    page.keyboard.press("p")
    page.wait_for_url(lambda url: f"/images/{image}" not in url)
    expect(button).to_have_attribute("aria-pressed", "true")


def test_a_lasso_selects_for_one_verdict(page: Page, label_server: Any, images: dict[str, int]) -> None:
    image = images["lasso"]
    open_image(page, label_server, image)
    page.keyboard.down("q")
    drag(page, (100, 60), (330, 60), (330, 300), (100, 300))
    page.keyboard.up("q")
    selection(page).to_have_text("4 candidates selected")
    page.keyboard.down("q")
    page.keyboard.down("Shift")
    drag(page, (440, 150), (600, 150), (600, 330), (440, 330))
    page.keyboard.up("Shift")
    page.keyboard.up("q")
    selection(page).to_have_text("6 candidates selected")
    page.keyboard.down("Shift")
    page.mouse.click(*place(page, 480, 240))
    page.keyboard.up("Shift")
    selection(page).to_have_text("5 candidates selected")
    page.keyboard.press("k")
    judged(page, 5)
    stored(label_server, image, "undecided", *["keep"] * 4, *["undecided"] * 2, "keep")
    assert groups(label_server, image) == [5]
    page.get_by_role("button", name="Undo").last.click()
    judged(page, 0)


def test_a_family_is_judged_by_one_key(page: Page, label_server: Any, images: dict[str, int]) -> None:
    image = images["family"]
    open_image(page, label_server, image)
    page.mouse.click(*place(page, 308, 200))
    selection(page).to_contain_text("Candidate 5 of 8")
    expect(page.get_by_test_id("suggestion")).to_be_visible()
    page.keyboard.press("g")
    selection(page).to_have_text("2 candidates selected")
    page.mouse.click(*place(page, 300, 200))
    page.keyboard.press("Shift+X")
    judged(page, 2)
    stored(label_server, image, *["undecided"] * 3, *["reject"] * 2, *["undecided"] * 3)
    assert groups(label_server, image) == [2]


def test_sliders_hide_and_judge_what_lies_beyond(page: Page, label_server: Any, images: dict[str, int]) -> None:
    image = images["filter"]
    open_image(page, label_server, image)
    page.get_by_text("length, score, residual").click()
    page.get_by_label("Length from").focus()
    for _ in range(90):
        page.keyboard.press("ArrowRight")
    expect(page.get_by_text("2 shorter than")).to_be_visible()
    expect(page.get_by_text("6 shown")).to_be_visible()
    page.get_by_role("button", name="Select the undecided shorter").click()
    selection(page).to_have_text("2 candidates selected")
    page.get_by_role("button", name="Reject the undecided shorter").click()
    judged(page, 2)
    stored(label_server, image, *["undecided"] * 6, *["reject"] * 2)
    # It stays so on the next image, where Tab passes over what is hidden.
    open_image(page, label_server, images["focus"])
    expect(page.get_by_text("6 shown")).to_be_visible()
    page.keyboard.press("Shift+Tab")
    selection(page).to_contain_text("Candidate 6 of 8")
    page.get_by_role("button", name="Show all again").click()
    expect(page.get_by_text("length, score, residual")).to_be_visible()


def test_the_others_become_faint_and_vanish(page: Page, label_server: Any, images: dict[str, int]) -> None:
    open_image(page, label_server, images["focus"])
    page.keyboard.press("Shift+S")
    x, y = place(page, 400, 200)

    def brightness() -> int:
        found = page.screenshot(clip={"x": x - 3, "y": y - 3, "width": 6, "height": 6})
        return int(np.asarray(Image.open(io.BytesIO(found)).convert("L")).max())

    def settles(expected: Callable[[int], bool]) -> None:
        for _ in range(50):
            if expected(brightness()):
                return
            page.evaluate("() => new Promise(requestAnimationFrame)")
        pytest.fail(f"brightness {brightness()}")

    settles(lambda value: value > 140)
    page.keyboard.press("Shift+H")
    expect(page.get_by_text("The others are faint")).to_be_visible()
    settles(lambda value: 75 < value < 130)
    page.keyboard.press("Shift+H")
    settles(lambda value: value < 75)
    page.keyboard.press("Shift+H")
    settles(lambda value: value > 140)


def test_digits_reject_with_a_reason_that_can_be_changed(page: Page, label_server: Any, images: dict[str, int]) -> None:
    image = images["reason"]
    open_image(page, label_server, image)
    page.keyboard.press("2")
    selection(page).to_contain_text("Candidate 2 of 8")
    page.keyboard.press("Shift+Tab")
    lane = page.get_by_role("button", name="Lane marking")
    expect(lane).to_have_attribute("aria-pressed", "true")
    page.get_by_role("button", name="Shadow").click()
    expect(lane).to_have_attribute("aria-pressed", "false")
    selection(page).to_contain_text("Candidate 1 of 8")
    page.keyboard.press("z")
    expect(lane).to_have_attribute("aria-pressed", "true")
    comes(
        lambda: [entry["reason"] for entry in label_server.ask(f"/images/{image}/decisions")["decisions"]][-3:],
        ["lane_marking", "shadow", "lane_marking"],
    )
    assert segments(label_server, image)[0]["reason"] == "lane_marking"
    page.goto(f"{label_server.address}/datasets/tools/images/{image}")
    selection(page).to_contain_text("Candidate 2 of 8")
    page.keyboard.press("Shift+Tab")
    expect(lane).to_have_attribute("aria-pressed", "true")
    page.keyboard.press("z")
    expect(lane).to_have_attribute("aria-pressed", "false")
    judged(page, 0)


def test_keys_alone_judge_two_frames(page: Page, label_server: Any, images: dict[str, int]) -> None:
    rules = {"rules": {"second_share": 0, "ask_recall": True}}
    urllib.request.urlopen(
        urllib.request.Request(
            f"{label_server.address}/api/datasets/tools",
            json.dumps(rules).encode(),
            {"Content-Type": "application/json"},
            method="PATCH",
        ),
        timeout=30,
    ).close()
    first, second = images["frame-0"], images["frame-1"]
    open_image(page, label_server, first)
    page.keyboard.press("k")
    page.keyboard.press("3")
    page.keyboard.press("Control+a")
    selection(page).to_have_text("8 candidates selected")
    page.keyboard.press("Escape")
    selection(page).to_have_text("No candidate selected")
    page.keyboard.press("n")
    page.wait_for_url(f"**/images/{second}")
    selection(page).to_contain_text("Candidate 1 of 8")
    page.keyboard.press("y")
    expect(page.get_by_text("2 candidates judged as in the frames beside")).to_be_visible(timeout=30_000)
    judged(page, 2)
    stored(label_server, second, "keep", "reject", *["undecided"] * 6)
    assert segments(label_server, second)[1]["reason"] == "curved"
    assert groups(label_server, second, "take_over") == [2]
    page.keyboard.press("z")
    judged(page, 0)
    page.keyboard.press("Shift+Z")
    page.keyboard.press("r")
    judged(page, 8)
    page.keyboard.press("Enter")
    expect(page.get_by_text("Are all straight lines of this image kept?")).to_be_visible()
    page.keyboard.press("2")
    page.wait_for_url(lambda url: f"/images/{second}" not in url)
    assert label_server.ask(f"/images/{second}")["status"] == "done"


def test_fingers_use_the_tool_bar_and_two_of_them_zoom(
    browser: Browser, label_server: Any, images: dict[str, int]
) -> None:
    context = browser.new_context(viewport={"width": 900, "height": 700}, has_touch=True)
    page = context.new_page()
    open_image(page, label_server, images["touch"])
    fingers = context.new_cdp_session(page)

    def touch(kind: str, *places: tuple[float, float]) -> None:
        points = [{"x": x, "y": y, "id": number} for number, (x, y) in enumerate(places)]
        fingers.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    page.get_by_role("button", name="Reject brush").tap()
    touch("touchStart", place(page, 180, 200))
    for x in range(200, 320, 20):
        touch("touchMove", place(page, x, 200))
    touch("touchEnd")
    judged(page, 3)
    scale = page.locator(".status-strip__scale")
    before = scale.text_content() or ""
    touch("touchStart", place(page, 380, 200))
    touch("touchStart", place(page, 380, 200), place(page, 420, 200))
    for step in range(1, 6):
        touch("touchMove", place(page, 380 - 15 * step, 200), place(page, 420 + 15 * step, 200))
    touch("touchEnd")
    expect(scale).not_to_have_text(before)
    judged(page, 3)
    page.get_by_role("button", name="Pointer").tap()
    expect(page.get_by_role("button", name="Reject brush")).to_have_attribute("aria-pressed", "false")
    context.close()
