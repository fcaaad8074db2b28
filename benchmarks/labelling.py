"""How fast the label page is with 2,000 candidates of 600,000 points, in a real browser on a real server.

First paint is told twice: in a window that is being opened, whose own parts (Chromium's address line is a page, too)
need a second of processor time at the same moment, and in one that has been open for a while, as whoever goes through
images has it. Own work per frame is the time in the page's own callbacks between two display frames, while the image is
dragged and zoomed; a frame counts as dropped when it comes later than one and a half intervals. Key to paint runs from
the key event's time stamp to the end of the frame that shows the verdict. Memory is measured while 30 other images are
gone through, forth and back.
"""

from __future__ import annotations

import subprocess
import sys
import time
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from playwright.sync_api import Browser, Page, Request, sync_playwright
from shared.dense_images import POINTS, write_images
from shared.label_server import label_server, request
from shared.renderer_memory import renderer_megabytes
from shared.reporting import Target, arguments, finish, show_table

ROOT = Path(__file__).resolve().parent.parent
IMAGES = 3
CANDIDATES = 2_000
WALKED_IMAGES = 30
WALKED_CANDIDATES = 400
SCREEN = {"width": 1440, "height": 900}
MOVES = 90
KEYS = 40
OPENINGS = 7
SWITCHES = 8
WINDOW_PAUSE = 2_500
"""What a new window gets for its own parts before an image is opened in it, ms."""
AFTERWARDS = 2_000
"""What a page gets for all that it asks for after its first paint, so that the next one isn't served beside it, ms."""
LATE = 25.0
"""From this interval on a frame has been dropped, ms."""
PROBE = Path(__file__).with_name("labelling_probe.js")
TARGETS = (
    Target("first_paint_ms", 1_000),
    Target("first_paint_open_window_ms", 1_000),
    Target("frame_work_p95_ms", 8),
    Target("frame_interval_p95_ms", 17.5),
    Target("dropped_share", 0.01),
    Target("key_to_paint_p95_ms", 50),
    Target("switch_ms", 100),
    Target("requests_per_verdict", 1),
    Target("bytes_per_verdict", 1_000),
    Target("walk_growth_mb", 500),
)


def open_image(browser: Browser, address: str, dataset: str, number: int, *, pause: float = 0) -> Page:
    """Open an image in a new window that has nothing in its cache, once the window has had a pause (ms)."""
    image = request(f"{address}/api/datasets/{dataset}/images")["items"][number]
    page = browser.new_context(viewport=SCREEN).new_page()  # type: ignore[arg-type]
    page.add_init_script(path=PROBE)
    page.wait_for_timeout(pause)
    page.goto(f"{address}/datasets/{dataset}/images/{image['id']}")
    wait_for_probe(page, "painted")
    return page


def first_paints(browser: Browser, address: str, pause: float) -> list[float]:
    """Open the same image several times; return when image and candidates were seen, ms since it was asked for."""
    paints: list[float] = []
    for _ in range(OPENINGS):
        page = open_image(browser, address, "dense", 0, pause=pause)
        paints.append(wait_for_probe(page, "painted"))
        page.wait_for_timeout(AFTERWARDS)
        page.context.close()
    return paints


def wait_for_probe(page: Page, name: str) -> float:
    """Wait until the probe knows a time, ms, and return it."""
    deadline = time.monotonic() + 30
    while (value := page.evaluate(f"window.__probe.{name}")) is None:
        if time.monotonic() > deadline:
            raise TimeoutError(f"the page shows nothing: {name}")
        page.wait_for_timeout(20)
    return value


def move(page: Page) -> tuple[list[float], list[float]]:
    """Drag and zoom; return own work per frame and the intervals between frames, ms."""
    page.mouse.move(560, 450)
    page.evaluate("window.__probe.frames = []")
    page.mouse.down()
    for step in range(MOVES):
        page.mouse.move(560 + 3 * (step % 60), 450 + 2 * (step % 45))
        page.wait_for_timeout(12)
    page.mouse.up()
    for step in range(MOVES):
        page.mouse.wheel(0, -60 if step < MOVES / 2 else 60)
        page.wait_for_timeout(12)
    frames = np.array(page.evaluate("window.__probe.frames"))
    return frames[1:, 1].tolist(), np.diff(frames[:, 0]).tolist()


def judge(page: Page) -> tuple[list[float], list[int]]:
    """Give many verdicts; return the times from key to paint, ms, and the bytes of each request that stored them."""
    sizes: list[int] = []

    def count(sent: Request) -> None:
        if sent.method == "POST" and sent.url.endswith("/decisions"):
            sizes.append(len(sent.post_data_buffer or b""))

    page.keyboard.press("f")
    page.wait_for_timeout(500)
    page.on("request", count)
    page.evaluate("window.__probe.keys = []")
    for step in range(KEYS):
        page.keyboard.press("kxa"[step % 3])
        page.wait_for_timeout(60)
    page.get_by_text("All saved").wait_for()
    page.remove_listener("request", count)
    return page.evaluate("window.__probe.keys"), sizes


def switch(page: Page, times: int, pause: float, keys: str = "np") -> list[float]:
    """Go to other images; return the times from key to the next image with its candidates, ms."""
    waits: list[float] = []
    for step in range(times):
        page.wait_for_timeout(pause)
        page.keyboard.press(keys[step % len(keys)])
        waits.append(wait_for_probe(page, "switched"))
    return waits


def walk(browser: Browser, address: str) -> dict[str, float | None]:
    """Go through all images forth and back; return the page's memory before and after, MB."""
    page = open_image(browser, address, "walked", 0)
    before = renderer_megabytes(page)
    switch(page, WALKED_IMAGES - 1, 400, "n")
    middle = renderer_megabytes(page)
    switch(page, WALKED_IMAGES - 1, 400, "p")
    after = renderer_megabytes(page)
    page.context.close()
    grown = None if before.process is None or after.process is None else after.process - before.process
    return {
        "walk_heap_before_mb": before.heap,
        "walk_heap_mb": after.heap,
        "walk_process_before_mb": before.process,
        "walk_process_half_way_mb": middle.process,
        "walk_process_mb": after.process,
        "walk_growth_mb": grown,
    }


def measure(browser: Browser, address: str) -> dict[str, float | None]:
    """Return all figures."""
    paints = first_paints(browser, address, 0)
    paints_open_window = first_paints(browser, address, WINDOW_PAUSE)
    page = open_image(browser, address, "dense", 0)
    page.wait_for_timeout(2_000)
    work, intervals = move(page)
    keys, sizes = judge(page)
    switches = switch(page, SWITCHES, 3_000)  # nobody is done with an image sooner
    page.context.close()
    return {
        "first_paint_ms": float(np.median(paints)),
        "first_paint_best_ms": min(paints),
        "first_paint_open_window_ms": float(np.median(paints_open_window)),
        "first_paint_open_window_best_ms": min(paints_open_window),
        "frame_work_p95_ms": float(np.percentile(work, 95)),
        "frame_interval_p95_ms": float(np.percentile(intervals, 95)),
        "dropped_share": float(np.mean(np.array(intervals) > LATE)),
        "key_to_paint_p95_ms": float(np.percentile(keys, 95)),
        "key_to_paint_median_ms": float(np.median(keys)),
        "switch_ms": float(np.median(switches)),
        "switch_worst_ms": max(switches),
        "requests_per_verdict": len(sizes) / KEYS,
        "bytes_per_verdict": sum(sizes) / KEYS,
        **walk(browser, address),
    }


def main() -> None:
    options = arguments(str(__doc__))
    finder = [sys.executable, str(ROOT / "tools" / "browser.py")]
    found = subprocess.run(finder, check=True, capture_output=True, text=True).stdout.strip()
    datasets: dict[str, Any] = {
        "dense": partial(write_images, images=IMAGES, candidates=CANDIDATES),
        "walked": partial(write_images, images=WALKED_IMAGES, candidates=WALKED_CANDIDATES, quick=True),
    }
    with label_server(datasets) as address, sync_playwright() as playwright:
        flags = ["--no-sandbox", "--disable-gpu", "--enable-precise-memory-info"]
        browser = playwright.chromium.launch(executable_path=found, args=flags)
        figures = measure(browser, address)
        browser.close()
    rows = [
        [name.replace("_", " "), "" if value is None else f"{value:.3g}" if value < 1 else f"{value:.1f}"]
        for name, value in figures.items()
    ]
    show_table(f"Label page, {CANDIDATES} candidates of {CANDIDATES * POINTS} points", ["figure", "value"], rows)
    finish(figures, TARGETS, as_json=options.json)


if __name__ == "__main__":
    main()
