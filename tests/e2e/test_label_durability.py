"""Two hundred fast verdicts, the server killed in the middle, the tab closed twice: both sides compared row by row."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any
from uuid import uuid4

import cv2
import numpy as np
import pytest
from playwright.sync_api import BrowserContext, Page, expect

from app.formats.label_npy import write_label_npy
from app.vision.segments import Segments

LINES = 200
IN_A_HURRY = 50
"""Verdicts in the tab that is closed right after them."""
RECORDER = """
(() => {
  const add = IDBObjectStore.prototype.add;
  IDBObjectStore.prototype.add = function (entry, ...rest) {
    const { client_id, segment_id, verdict } = entry.decision ?? {};
    if (client_id !== undefined) {
      const row = [client_id, segment_id, verdict];
      window.recorded("asked", row);
      this.transaction.addEventListener("complete", () => window.recorded("kept", row));
    }
    return add.call(this, entry, ...rest);
  };
})();
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A dataset of one image with as many lines as verdicts are given."""
    folder = tmp_path / "images"
    for part in ("images", "labels"):
        (folder / part).mkdir(parents=True)
    lines = [np.linspace((4 + 3 * x, 20), (4 + 3 * x, 300), 12, dtype=np.float32) for x in range(LINES)]
    cv2.imwrite(str(folder / "images" / "fence.png"), np.full((320, 3 * LINES + 8), 90, np.uint8))
    (folder / "labels" / "fence_edge_segments_filtered.npy").write_bytes(write_label_npy(Segments.from_list(lines)))
    return folder


def make_undecided(server: Any, image: int) -> int:
    """Take all imported verdicts back; return how many rows the history has then."""
    segments = server.ask(f"/images/{image}/segments")["segments"]
    rows = [
        {"client_id": str(uuid4()), "group_id": str(uuid4()), "segment_id": segment["id"], "verdict": "undecided"}
        for segment in segments
    ]
    server.ask(f"/images/{image}/decisions", {"decisions": rows})
    return len(server.ask(f"/images/{image}/decisions")["decisions"])


def open_tab(context: BrowserContext, address: str) -> Page:
    page = context.new_page()
    page.goto(address)
    page.locator("[role=application][aria-busy=false]").wait_for()
    return page


def judge(page: Page, times: int) -> None:
    """Give verdicts as fast as keys can be pressed."""
    for step in range(times):
        page.keyboard.press("kxa"[step % 3])


def test_every_verdict_arrives_once_and_in_order(
    page: Page, serve: Callable[..., Any], import_dataset: Callable[..., None], folder: Path
) -> None:
    recorded: dict[str, list[tuple[str, int, str]]] = {"asked": [], "kept": []}
    page.context.expose_function("recorded", lambda when, row: recorded[when].append(tuple(row)))
    page.context.add_init_script(RECORDER)
    server = serve()
    import_dataset(server, folder, "fence")
    image = server.ask("/datasets/fence/images")["items"][0]["id"]
    before = make_undecided(server, image)
    address = f"{server.address}/datasets/fence/images/{image}"

    first = open_tab(page.context, address)
    judge(first, 60)
    server.kill()  # while some are under way
    judge(first, 40)
    expect(first.locator("button.save-indicator--offline")).to_contain_text("kept here")
    first.close()

    server = serve(port=int(server.address.rpartition(":")[2]))
    second = open_tab(page.context, address)
    judge(second, IN_A_HURRY)
    second.close()  # whatever the browser has taken by now mustn't be lost

    third = open_tab(page.context, address)
    left = third.get_by_label("Progress").locator(".panel-progress")
    expect(third.get_by_text("All saved")).to_be_visible(timeout=30_000)
    while (done := int(left.inner_text().split()[0])) < LINES:
        judge(third, LINES - done)
    expect(left).to_have_text(f"{LINES} of {LINES} judged")
    expect(third.get_by_text("All saved")).to_be_visible(timeout=30_000)

    history = server.ask(f"/images/{image}/decisions")["decisions"][before:]
    arrived = [(row["client_id"], row["segment_id"], row["verdict"]) for row in history]
    assert len(set(arrived)) == len(arrived) >= LINES
    # a tab that is closed takes along what the recorder was about to tell of its last rows
    asked = set(recorded["asked"])
    assert [row for row in arrived if row in asked] == [row for row in recorded["asked"] if row in set(arrived)]
    assert len(asked) >= LINES - IN_A_HURRY
    assert set(recorded["kept"]) <= set(arrived)
    last = {segment: verdict for _, segment, verdict in arrived}
    segments = server.ask(f"/images/{image}/segments")["segments"]
    assert {segment["id"]: segment["verdict"] for segment in segments} == last
