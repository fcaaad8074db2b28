"""The leaderboard as its visitors meet it: freeze a split, submit to it, read the board, share what was found."""

from __future__ import annotations

import io
import json
import re
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from playwright.sync_api import FilePayload, Locator, Page, expect

from app.formats.label_npy import write_label_npy
from app.vision.segments import Segments

WIDTH, HEIGHT = 640, 480
IMAGES = ("alley", "bridge", "corner")
COLUMNS = (100, 200, 300, 400)
SCORED = 60_000  # ms


def vertical(x: float) -> np.ndarray:
    return np.linspace((x, 100), (x, 380), 100, dtype=np.float32)


def archive(columns: dict[str, tuple[float, ...]]) -> bytes:
    """A zip of one npz per image, with vertical lines at these places."""
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as members:
        for name, places in columns.items():
            lines = [vertical(x) for x in places]
            content = io.BytesIO()
            offsets = np.cumsum([0, *map(len, lines)], dtype=np.int64)
            np.savez(content, points=np.concatenate(lines), offsets=offsets)
            members.writestr(f"{name}.npz", content.getvalue())
    return packed.getvalue()


PERFECT: dict[str, tuple[float, ...]] = dict.fromkeys(IMAGES, COLUMNS)
"""Every line of every image."""
# Half of the lines; on the bridge two wrong ones beside them, so that it is the worst image.
WEAK: dict[str, tuple[float, ...]] = {"alley": (100, 200), "bridge": (100, 150, 250), "corner": (100, 200)}


@pytest.fixture(scope="module")
def streets(tmp_path_factory: pytest.TempPathFactory, server: Any, import_dataset: Callable[..., None]) -> Any:
    """The server with a labelled dataset and a split of it, which nothing was submitted to."""
    streets = tmp_path_factory.mktemp("leaderboard") / "streets"
    for part in ("images", "labels"):
        (streets / part).mkdir(parents=True)
    labels = write_label_npy(Segments.from_list([vertical(x) for x in COLUMNS]))
    for number, name in enumerate(IMAGES):
        cv2.imwrite(str(streets / "images" / f"{name}.png"), np.full((HEIGHT, WIDTH), 90 + number, np.uint8))
        (streets / "labels" / f"{name}_edge_segments_filtered.npy").write_bytes(labels)
    import_dataset(server, streets, "streets")
    server.ask("/datasets/streets/splits", {"name": "Old town", "visibility": "open"})
    return server


def submit(page: Page, server: Any, method: str, files: FilePayload | list[FilePayload]) -> None:
    """Hand in files on the page, up to the point where they are scored."""
    page.goto(f"{server.address}/splits/old-town/submit")
    choose(page, files)
    expect(page.get_by_role("heading", name="Valid")).to_be_visible(timeout=SCORED)
    page.get_by_label("Method").fill(method)
    page.get_by_role("button", name=re.compile("^Submit")).click()
    expect(page.get_by_label("Progress of the submission")).to_contain_text("F1 ", timeout=SCORED)


def choose(page: Page, files: FilePayload | list[FilePayload]) -> None:
    page.locator("input[type=file]:not([webkitdirectory])").set_input_files(files)


def zipped(columns: dict[str, tuple[float, ...]]) -> FilePayload:
    return {"name": "results.zip", "mimeType": "application/zip", "buffer": archive(columns)}


@pytest.fixture(scope="module")
def board(streets: Any, browser: Any) -> Any:
    """The server with two methods on the board of the split."""
    page = browser.new_page()
    submit(page, streets, "Sharp", zipped(PERFECT))
    submit(page, streets, "Dull", zipped(WEAK))
    page.close()
    return streets


def submissions(server: Any) -> dict[str, Any]:
    found = server.ask("/splits/old-town/submissions?mine=true")["items"]
    return {submission["method"]["name"]: submission for submission in found}


def rows(page: Page) -> Locator:
    return page.get_by_role("table", name="Leaderboard").locator("tbody tr")


def test_a_maintainer_freezes_a_split_and_finds_its_empty_board(page: Page, streets: Any) -> None:
    page.goto(f"{streets.address}/datasets/streets")
    page.get_by_role("link", name="Splits", exact=True).click()
    page.get_by_role("button", name="Freeze a split").click()
    panel = page.get_by_role("form", name="Freeze a split")
    expect(panel).to_contain_text("3 images whose review is done")
    panel.get_by_label("Name").fill("Harbour")
    panel.get_by_label("Minimum length, px").fill("50")
    page.keyboard.press("Enter")
    expect(page.get_by_role("heading", name="Harbour")).to_be_visible()
    expect(page).to_have_url(f"{streets.address}/splits/harbour")
    expect(page.get_by_role("heading", name="Nothing scored yet")).to_be_visible()
    split = streets.ask("/splits/harbour")
    assert (split["version"]["images"], split["min_length"]) == (3, 50)
    page.get_by_role("link", name="Leaderboards").first.click()
    expect(page.get_by_role("link", name="Harbour")).to_be_visible()


def test_a_dataset_that_came_labelled_says_so(page: Page, streets: Any) -> None:
    page.goto(streets.address)
    card = page.get_by_role("listitem").filter(has=page.get_by_role("link", name="streets"))
    expect(card).to_contain_text("3 images · 12 labels")
    expect(card.get_by_text("Labelled", exact=True)).to_be_visible()
    page.goto(f"{streets.address}/datasets/streets")
    expect(page.get_by_role("main")).to_contain_text("3 images · 12 labels")
    expect(page.get_by_role("list", name="Images").get_by_role("link").first).to_have_accessible_name(
        re.compile("^alley, .*, 4 labels$")
    )


def test_results_are_checked_scored_and_looked_at(page: Page, board: Any) -> None:
    page.goto(f"{board.address}/submissions/{submissions(board)['Sharp']['id']}")
    expect(page.get_by_role("heading", name="Sharp")).to_be_visible()
    expect(page.locator(".headline")).to_contain_text("1.000")
    expect(page.get_by_role("heading", name="All metrics")).to_be_visible()
    page.get_by_role("link", name="Log").click()
    expect(page.get_by_role("heading", name="Log")).to_be_visible()
    expect(page.locator("main ol").get_by_role("listitem").first).to_contain_text("results.zip")


def test_what_is_wrong_with_files_is_all_said_and_nothing_is_stored(page: Page, streets: Any) -> None:
    before = streets.ask("/splits/old-town/submissions?mine=true")["total"]
    page.goto(f"{streets.address}/splits/old-town/submit")
    points = [[100, 100], [100, "Infinity"]]
    broken = json.dumps({"segments": [{"points": points}]}).encode()
    stranger = json.dumps({"segments": []}).encode()
    choose(
        page,
        [
            {"name": "alley.json", "mimeType": "application/json", "buffer": broken},
            {"name": "nowhere.json", "mimeType": "application/json", "buffer": stranger},
        ],
    )
    wrong = page.get_by_role("alert", name="What is wrong")
    expect(wrong).to_be_visible(timeout=SCORED)
    expect(wrong).to_contain_text("alley.json")
    expect(wrong).to_contain_text("nowhere.json")
    page.get_by_label("Method").fill("Broken")
    expect(page.get_by_role("button", name=re.compile("^Submit"))).to_be_disabled()
    assert streets.ask("/splits/old-town/submissions?mine=true")["total"] == before

    page.get_by_role("button", name="Choose other files").click()
    choose(page, zipped(PERFECT))
    expect(page.get_by_role("heading", name="Valid")).to_be_visible(timeout=SCORED)
    expect(page.get_by_label("Result of the check")).to_contain_text("3 images, 12 segments")


def test_the_board_is_sorted_in_its_address(page: Page, board: Any) -> None:
    page.goto(f"{board.address}/splits/old-town")
    expect(rows(page)).to_have_count(2)
    expect(rows(page).first).to_contain_text("Sharp")
    expect(rows(page).first).to_contain_text("1.000")
    head = page.get_by_role("columnheader", name="F1, 95 % interval")
    head.get_by_role("button").click()
    expect(page).to_have_url(re.compile(r"sort=-f1$"))
    head.get_by_role("button").click()
    expect(head).to_have_attribute("aria-sort", "ascending")
    expect(rows(page).first).to_contain_text("Dull")
    page.reload()
    expect(rows(page).first).to_contain_text("Dull")


def test_the_points_of_the_scatter_are_reached_by_keys(page: Page, board: Any) -> None:
    page.goto(f"{board.address}/splits/old-town")
    figure = page.get_by_role("figure")
    points = figure.get_by_role("link")
    expect(points).to_have_count(2)
    points.first.focus()
    page.keyboard.press("ArrowRight")
    focused = figure.locator("a:focus")
    expect(focused).to_have_accessible_name(re.compile("Dull: precision"))
    expect(rows(page).filter(has_text="Dull")).to_have_attribute("data-current", "true")
    page.keyboard.press("Enter")
    expect(page).to_have_url(f"{board.address}/submissions/{submissions(board)['Dull']['id']}")


def test_the_board_is_served_as_csv(page: Page, board: Any) -> None:
    page.goto(f"{board.address}/splits/old-town")
    page.get_by_role("button", name="Download").click()
    with page.expect_download() as download:
        page.get_by_role("link", name="Board as CSV").click()
    lines = Path(download.value.path()).read_text().splitlines()
    assert len(lines) == 3
    assert {"Sharp", "Dull"} <= set(re.split("[,\n]", "\n".join(lines)))


def test_images_are_sorted_by_any_number_and_the_address_can_be_shared(page: Page, board: Any) -> None:
    dull = submissions(board)["Dull"]["id"]
    page.goto(f"{board.address}/submissions/{dull}?tab=images")
    images = page.get_by_role("list", name="Images").get_by_role("link")
    expect(images).to_have_count(3)
    expect(images.first).to_have_accessible_name(re.compile("^bridge: .* 1 found, 2 wrong, 3 missed$"))
    page.get_by_role("button", name="Sort by Wrong").click()
    expect(page).to_have_url(re.compile("sort=-fp"))
    page.get_by_role("button", name=re.compile("Sort by Image")).click()
    expect(images.first).to_have_accessible_name(re.compile("^alley"))
    page.reload()
    expect(images.first).to_have_accessible_name(re.compile("^alley"))
    page.get_by_label("Search images").fill("corn")
    expect(images).to_have_count(1)
    images.first.press("Enter")
    expect(page).to_have_url(re.compile(rf"/submissions/{dull}/images/\d+\?sort=name&search=corn"))
    page.go_back()
    expect(page.get_by_label("Search images")).to_have_value("corn")


def test_two_submissions_are_compared_on_the_same_images(page: Page, board: Any) -> None:
    found = submissions(board)
    page.goto(f"{board.address}/submissions/{found['Sharp']['id']}?tab=compare")
    page.get_by_label("With").select_option(str(found["Dull"]["id"]))
    recall = page.get_by_role("row").filter(has=page.get_by_role("rowheader", name="Recall", exact=True)).first
    expect(recall).to_contain_text("this is better")
    expect(page.get_by_text("This one has the higher F1 on 3 images")).to_be_visible()
    page.reload()
    expect(recall).to_contain_text("this is better")


def test_what_is_withdrawn_comes_back_by_undo(page: Page, board: Any) -> None:
    dull = submissions(board)["Dull"]["id"]
    page.goto(f"{board.address}/splits/old-town/submit")
    page.get_by_role("button", name=f"More for Dull, submission {dull}").click()
    page.get_by_role("button", name="Withdraw").click()
    expect(page.get_by_text("Dull withdrawn")).to_be_visible()
    assert board.ask(f"/submissions/{dull}")["status"] == "withdrawn"
    page.get_by_role("button", name="Undo").click()
    expect(page.get_by_text("The submission is back.")).to_be_visible()
    assert board.ask(f"/submissions/{dull}")["status"] == "scored"


def test_a_method_is_described_by_its_owner(page: Page, board: Any) -> None:
    page.goto(f"{board.address}/methods/dull")
    page.get_by_role("button", name="Edit").click()
    page.get_by_label("Description").fill("Half of the lines")
    page.get_by_label("Code").fill("https://example.org/dull")
    page.get_by_role("button", name="Save").click()
    expect(page.get_by_text("Half of the lines")).to_be_visible()
    expect(page.get_by_role("link", name="Code")).to_have_attribute("href", "https://example.org/dull")


def test_a_dataset_has_a_card(page: Page, board: Any) -> None:
    page.goto(f"{board.address}/datasets/streets/card")
    expect(page.get_by_role("heading", name="Images by source")).to_be_visible()
    page.get_by_role("button", name="Edit").click()
    page.get_by_role("textbox", name="Licence").fill("CC BY 4.0")
    page.get_by_role("button", name="Save").click()
    expect(page.get_by_role("region", name="Licence and citation")).to_contain_text("CC BY 4.0")
    assert board.ask("/datasets/streets/card")["licence"] == "CC BY 4.0"


def test_a_figure_that_fails_can_be_asked_for_again(page: Page, board: Any) -> None:
    page.route("**/card.png", lambda route: route.abort(), times=1)
    page.goto(f"{board.address}/datasets/streets/card")
    expect(page.get_by_role("alert")).to_contain_text("The figure can't be shown")
    page.get_by_role("button", name="Try again").click()
    expect(page.get_by_role("figure").get_by_role("img")).to_be_visible()
    expect(page.get_by_role("alert")).to_have_count(0)


def test_a_narrow_board_is_scrolled_by_keyboard(page: Page, board: Any) -> None:
    page.set_viewport_size({"width": 700, "height": 700})
    page.goto(f"{board.address}/splits/old-town")
    table = page.get_by_role("region", name="Leaderboard")
    name = table.get_by_role("rowheader").first
    before = name.bounding_box()
    table.focus()
    for _ in range(4):
        page.keyboard.press("ArrowRight")
    page.wait_for_function("() => document.querySelector('.table-scroll__region').scrollLeft > 60")
    after = name.bounding_box()
    assert before
    assert after
    # It stays in view, at the edge at most.
    assert before["x"] - 20 <= after["x"] <= before["x"]


def test_a_reader_looks_at_everything_and_is_offered_no_change(
    page: Page, streets: Any, create_token: Callable[..., str]
) -> None:
    page.request.post(f"{streets.address}/api/session", data={"token": create_token(streets, "rita", "reader")})
    page.goto(streets.address)
    expect(page.get_by_role("button", name="rita, reader")).to_be_visible()
    expect(page.get_by_role("link", name="streets")).to_be_visible()
    for name in ("New dataset", "More for streets"):
        expect(page.get_by_role("button", name=name)).to_have_count(0)
    page.get_by_role("link", name="streets").click()
    expect(page.get_by_role("button", name="Export")).to_be_visible()
    for name in ("Pre-label", "Add images", "streets"):
        expect(page.get_by_role("button", name=name)).to_have_count(0)
    expect(page.get_by_role("checkbox", name="Select alley")).to_have_count(0)
    page.get_by_role("button", name="View images").click()
    expect(page).to_have_url(re.compile(r"/images/\d+"))
    verdicts = page.get_by_role("group", name="Verdict on the selected candidate")
    expect(verdicts.get_by_role("button", name="Reject")).to_be_disabled()
    expect(page.get_by_role("button", name="Reopen")).to_have_count(0)
    page.keyboard.press("x")
    expect(page.locator(".toaster").get_by_text("Judging needs the role annotator")).to_be_visible()
    page.get_by_role("button", name="Next image").click()
    expect(page.get_by_role("heading", name="Image 2 of 3")).to_be_visible()
    image = streets.ask("/datasets/streets/images")["items"][0]
    assert image["verdicts"]["reject"] == 0


def test_a_token_signs_in_and_out(page: Page, board: Any, create_token: Callable[..., str]) -> None:
    token = create_token(board, "ada", "submitter")
    page.goto(f"{board.address}/datasets/streets?tab=splits")
    expect(page.get_by_role("button", name="Freeze a split")).to_be_visible()
    page.get_by_role("button", name="Not signed in, owner").click()
    page.get_by_label("Token").fill("cl_wrong")
    page.keyboard.press("Enter")
    expect(page.get_by_role("alert")).to_be_visible()
    page.get_by_label("Token").fill(token)
    page.keyboard.press("Enter")
    expect(page.get_by_role("button", name="ada, submitter")).to_be_visible()
    expect(page.get_by_role("link", name="Old town")).to_be_visible()
    expect(page.get_by_role("button", name="Freeze a split")).to_have_count(0)
    page.get_by_role("button", name="ada, submitter").click()
    page.get_by_role("button", name="Sign out").click()
    expect(page.get_by_role("button", name="Freeze a split")).to_be_visible()


def test_unknown_splits_and_submissions_lead_back(page: Page, streets: Any) -> None:
    for path, title in (("splits/nowhere", "split"), ("submissions/99999", "submission"), ("methods/none", "method")):
        page.goto(f"{streets.address}/{path}")
        expect(page.get_by_role("heading", name=f"There is no such {title}")).to_be_visible()
        page.get_by_role("link", name="All leaderboards").click()
        expect(page).to_have_url(f"{streets.address}/splits")
