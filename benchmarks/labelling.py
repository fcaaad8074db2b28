"""How fast the label page is with 2,000 candidates of 600,000 points, in a real browser on a real server.

Own work per frame is the time in the page's own callbacks between two display frames, while the image is dragged and
zoomed. Key to paint runs from the key event's time stamp to the end of the frame that shows the verdict.
"""

from __future__ import annotations

import json
import socket
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from uuid import uuid4

import cv2
import numpy as np
from numpy.typing import NDArray
from playwright.sync_api import Browser, Page, sync_playwright
from shared.reporting import Target, arguments, finish, show_table

from app.formats.dataset import write_dataset
from app.formats.labelled import LabelledSegments
from app.formats.labelled_image import LabelledImage
from app.vision.segments import Segments

ROOT = Path(__file__).resolve().parent.parent
WIDTH, HEIGHT = 2048, 1536
IMAGES = 3
CANDIDATES = 2_000
POINTS = 300
SCREEN = {"width": 1440, "height": 900}
MOVES = 90
KEYS = 40
OPENINGS = 5
SWITCHES = 8
PROBE = Path(__file__).with_name("labelling_probe.js")


def picture(seed: int) -> NDArray[np.uint8]:
    """A picture with structure at several scales, so that decoding it costs what a photo costs."""
    rng = np.random.default_rng(seed)
    image = np.zeros((HEIGHT, WIDTH, 3), np.float32)
    for size in (8, 64, 512):
        coarse = rng.uniform(0, 80, (HEIGHT // size + 1, WIDTH // size + 1, 3)).astype(np.float32)
        image += cv2.resize(coarse, (WIDTH, HEIGHT), interpolation=cv2.INTER_CUBIC)
    return np.clip(image, 0, 255).astype(np.uint8)


def segments(seed: int) -> Segments:
    """Slightly curved lines of 100 to 400 px everywhere, with noise like that of edge points."""
    rng = np.random.default_rng(seed)
    along = np.linspace(-0.5, 0.5, POINTS)
    angle = rng.uniform(0, np.pi, (CANDIDATES, 1))
    length = rng.uniform(100, 400, (CANDIDATES, 1))
    across = 0.01 * length * (4 * along**2 - 1) + rng.normal(0, 0.1, (CANDIDATES, POINTS))
    x = rng.uniform(200, WIDTH - 200, (CANDIDATES, 1)) + length * along * np.cos(angle) - across * np.sin(angle)
    y = rng.uniform(200, HEIGHT - 200, (CANDIDATES, 1)) + length * along * np.sin(angle) + across * np.cos(angle)
    return Segments.from_list(list(np.stack([x, y], axis=2).astype(np.float32)))


def write_images(folder: Path) -> None:
    """Write the dataset in the layout that `clearlines import` reads."""

    def image(seed: int) -> LabelledImage:
        content = cv2.imencode(".png", picture(seed))[1].tobytes()
        labelled = LabelledSegments(segments(seed))
        return LabelledImage(f"{seed:03}", f"{seed:03}.png", WIDTH, HEIGHT, labelled, content=lambda: content)

    for path, content in write_dataset(image(seed) for seed in range(IMAGES)):
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_bytes(content)


def request(address: str, body: object = None) -> Any:
    data = None if body is None else json.dumps(body).encode()
    call = urllib.request.Request(address, data, {"Content-Type": "application/json"})
    with urllib.request.urlopen(call, timeout=60) as answer:
        return json.load(answer)


@contextmanager
def server() -> Iterator[str]:
    """A server of its own with the images, their candidates undecided; gives the address of the dataset's images."""
    clearlines = Path(sys.executable).with_name("clearlines")
    with socket.socket() as probe, tempfile.TemporaryDirectory() as folder:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
        probe.close()
        write_images(Path(folder) / "images")
        data = Path(folder) / "data"
        import_command = [clearlines, "import", Path(folder) / "images", "--dataset", "dense", "--data", data]
        subprocess.run(import_command, check=True, capture_output=True)
        command = [clearlines, "serve", "--data", data, "--port", str(port), "--no-browser"]
        quiet = subprocess.DEVNULL
        process = subprocess.Popen(command, stdout=quiet, stderr=quiet)
        try:
            address = f"http://127.0.0.1:{port}"
            wait_for(f"{address}/api/health")
            for image in request(f"{address}/api/datasets/dense/images")["items"]:
                make_undecided(f"{address}/api/images/{image['id']}")
            yield address
        finally:
            process.terminate()
            process.wait()


def wait_for(address: str) -> None:
    deadline = time.monotonic() + 60
    while True:
        try:
            request(address)
        except (urllib.error.URLError, OSError):
            if time.monotonic() > deadline:
                raise
            time.sleep(0.1)
        else:
            return


def make_undecided(address: str) -> None:
    group = str(uuid4())
    decisions = [
        {"client_id": str(uuid4()), "group_id": group, "segment_id": entry["id"], "verdict": "undecided"}
        for entry in request(f"{address}/segments")["segments"]
    ]
    request(f"{address}/decisions", {"decisions": decisions})


def open_image(browser: Browser, address: str, number: int) -> Page:
    """Open an image in a browser that has nothing in its cache."""
    image = request(f"{address}/api/datasets/dense/images")["items"][number]
    page = browser.new_context(viewport=SCREEN).new_page()  # type: ignore[arg-type]
    page.add_init_script(path=PROBE)
    page.goto(f"{address}/datasets/dense/images/{image['id']}")
    wait_for_probe(page, "painted")
    return page


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


def judge(page: Page) -> list[float]:
    """Return the times from key to paint of many verdicts, ms."""
    page.keyboard.press("f")
    page.wait_for_timeout(500)
    page.evaluate("window.__probe.keys = []")
    for step in range(KEYS):
        page.keyboard.press("kxa"[step % 3])
        page.wait_for_timeout(60)
    return page.evaluate("window.__probe.keys")


def switch(page: Page) -> list[float]:
    """Return the times from key to the next image with its candidates, ms."""
    times: list[float] = []
    for step in range(SWITCHES):
        page.wait_for_timeout(3_000)  # nobody is done with an image sooner
        page.keyboard.press("np"[step % 2])
        times.append(wait_for_probe(page, "switched"))
    return times


def measure(browser: Browser, address: str) -> dict[str, float | None]:
    paints: list[float] = []
    for _ in range(OPENINGS):
        page = open_image(browser, address, 0)
        paints.append(wait_for_probe(page, "painted"))
        page.context.close()
    page = open_image(browser, address, 0)
    page.wait_for_timeout(2_000)
    work, intervals = move(page)
    keys = judge(page)
    switches = switch(page)
    heap = page.evaluate("performance.memory.usedJSHeapSize / 1e6")
    page.context.close()
    return {
        "first_paint_ms": float(np.median(paints)),
        "frame_work_p95_ms": float(np.percentile(work, 95)),
        "frame_interval_p95_ms": float(np.percentile(intervals, 95)),
        "key_to_paint_p95_ms": float(np.percentile(keys, 95)),
        "switch_ms": float(np.median(switches)),
        "switch_worst_ms": max(switches),
        "heap_mb": heap,
    }


def main() -> None:
    options = arguments(str(__doc__))
    finder = [sys.executable, str(ROOT / "tools" / "browser.py")]
    found = subprocess.run(finder, check=True, capture_output=True, text=True).stdout.strip()
    with server() as address, sync_playwright() as playwright:
        flags = ["--no-sandbox", "--disable-gpu", "--enable-precise-memory-info"]
        browser = playwright.chromium.launch(executable_path=found, args=flags)
        figures = measure(browser, address)
        browser.close()
    rows = [[name.replace("_", " "), f"{value:.1f}"] for name, value in figures.items()]
    show_table(f"Label page, {CANDIDATES} candidates of {CANDIDATES * POINTS} points", ["figure", "value"], rows)
    targets = [
        Target("first_paint_ms", 1_000),
        Target("frame_work_p95_ms", 8),
        Target("key_to_paint_p95_ms", 50),
        Target("switch_ms", 100),
    ]
    finish(figures, targets, as_json=options.json)


if __name__ == "__main__":
    main()
