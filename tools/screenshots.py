"""Make the pictures of the documentation: the demo, served for real, in a real browser."""

from __future__ import annotations

import json
import re
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request
from pathlib import Path
from random import Random
from typing import Any
from uuid import uuid4

from playwright.sync_api import Browser, Page, sync_playwright

ROOT = Path(__file__).resolve().parent.parent
PICTURES = ROOT / "docs" / "pictures"
PORT = 8799
ADDRESS = f"http://127.0.0.1:{PORT}"
SPLIT = "demo-streets"
WIDE = (1440, 900)
NARROW = (900, 700)
LONGEST = 20
GUIDELINES = "Edges of buildings, kerbs, poles and markings count. Cars, reflections and plants do not."


def ask(method: str, path: str, body: object = None, *, person: str = "owner") -> Any:
    headers = {"Content-Type": "application/json", "X-ClearLines-Person": person}
    content = None if body is None else json.dumps(body).encode()
    request = urllib.request.Request(f"{ADDRESS}/api{path}", content, headers, method=method)
    with urllib.request.urlopen(request, timeout=30) as answer:
        return json.load(answer)


def get(path: str) -> Any:
    return ask("GET", path)


def wait_for_candidates(server: subprocess.Popen[bytes], slug: str) -> None:
    """Wait until the server answers and the demo's run is done."""
    deadline = time.monotonic() + 300
    while time.monotonic() < deadline and server.poll() is None:
        try:
            if get(f"/datasets/{slug}")["latest_run"]["status"] == "done":
                return
        except (urllib.error.URLError, OSError, TypeError):
            pass
        time.sleep(0.5)
    raise SystemExit("the demo didn't get ready")


def submit_results(images: Path, found: Path, clearlines: Path) -> int:
    """Hand the pipeline's surer segments in as a method of one's own, and return the submission, scored."""
    subprocess.run([clearlines, "prelabel", images, "--output", found, "--operating-point", "precise"], check=True)
    method = ["--method", "My detector", "--label", "v1"]
    subprocess.run([clearlines, "submit", found, "--server", ADDRESS, "--split", SPLIT, *method], check=True)
    rows = {row["method"]["name"]: row for row in get(f"/splits/{SPLIT}/board")["rows"]}
    return rows["My detector"]["submission_id"]


def open_page(browser: Browser, path: str, *, size: tuple[int, int] = WIDE, dark: bool = False) -> Page:
    scheme = "dark" if dark else "light"
    page = browser.new_page(viewport={"width": size[0], "height": size[1]}, color_scheme=scheme)
    page.goto(ADDRESS + path)
    page.wait_for_load_state("networkidle")
    page.wait_for_timeout(800)
    return page


def take(page: Page, name: str) -> None:
    PICTURES.mkdir(parents=True, exist_ok=True)
    page.wait_for_timeout(300)
    page.screenshot(path=PICTURES / f"{name}.png")
    page.close()
    print(PICTURES / f"{name}.png")


def take_all(browser: Browser, slug: str) -> None:
    images = get(f"/datasets/{slug}/images")["items"]
    label = f"/datasets/{slug}/images"
    page = open_page(browser, f"{label}/{images[0]['id']}")
    wait_for_suggestions(page)
    for key in "kkxkkakkkxkk":  # so that every verdict is seen, beside what is suggested
        page.keyboard.press(key)
    take(page, "label")
    page = open_page(browser, f"{label}/{images[3]['id']}")
    wait_for_suggestions(page)
    page.keyboard.press("s")
    with page.expect_response("**/display?view=undistorted"):
        page.keyboard.press("v")
    take(page, "label-straight")
    take_history(browser, f"{label}/{images[1]['id']}", images[1]["id"])
    page = open_page(browser, f"{label}/{images[5]['id']}", dark=True)
    page.keyboard.press("k")
    page.keyboard.press("Shift+?")
    take(page, "label-keys-dark")
    take(open_page(browser, f"{label}/{images[8]['id']}", size=NARROW), "label-narrow")
    take(open_page(browser, "/"), "datasets")
    take(open_page(browser, f"/datasets/{slug}"), "dataset")
    take(open_page(browser, f"/datasets/{slug}?tab=runs"), "runs")
    take(open_page(browser, f"/datasets/{slug}?tab=cameras"), "cameras")
    take(open_page(browser, "/docs/api"), "api")
    review_twice(slug, images[6:10])
    take(open_page(browser, f"/datasets/{slug}?tab=team"), "team")
    take_camera(browser, slug)


def take_camera(browser: Browser, slug: str) -> None:
    """Calibrate the camera with the most images from what was kept of them."""
    camera = max(get(f"/datasets/{slug}/cameras"), key=lambda each: each["images"])["id"]
    calibration = ask("POST", f"/cameras/{camera}/calibrations", {"source": "labels"})["id"]
    deadline = time.monotonic() + 300
    while (status := get(f"/calibrations/{calibration}")["status"]) in {"queued", "running"}:
        if time.monotonic() > deadline:
            raise SystemExit("the calibration didn't get ready")
        time.sleep(0.5)
    if status != "done":
        raise SystemExit(f"the calibration is {status}")
    path = f"/datasets/{slug}/cameras/{camera}"
    take(open_page(browser, path), "camera")
    take(open_page(browser, f"{path}?tab=maps"), "camera-maps")


def review_twice(slug: str, images: list[dict[str, Any]]) -> None:
    """Let two people judge the same images, who differ now and then."""
    random = Random(0)
    people = ["Mara", "Jon"]
    ask("PATCH", f"/datasets/{slug}", {"guidelines": GUIDELINES, "rules": {"second_share": 1.0, "ask_recall": False}})
    for image in images:
        address = f"/images/{image['id']}"
        segments = get(f"{address}/segments")["segments"]
        verdicts = {each["id"]: "keep" if each["score"] > 0.45 and each["straight"] else "reject" for each in segments}
        ask("POST", f"{address}/decisions", {"decisions": decisions(verdicts, random)}, person=people[0])
        ask("PUT", f"{address}/review", {"status": "done"}, person=people[0])
        second = f"/second-reviews/{ask('POST', f'{address}/second-review', person=people[1])['id']}"
        for segment in random.sample(sorted(verdicts), len(verdicts) // 12):
            verdicts[segment] = "reject" if verdicts[segment] == "keep" else "keep"
        ask("POST", f"{second}/decisions", {"decisions": decisions(verdicts, random)}, person=people[1])
        ask("PUT", f"{second}/review", {"status": "done"}, person=people[1])
    ask("POST", f"/datasets/{slug}/assign", {"people": people, "mode": "shares"})


def decisions(verdicts: dict[int, str], random: Random) -> list[dict[str, Any]]:
    return [
        {
            "client_id": str(uuid4()),
            "group_id": str(uuid4()),
            "segment_id": segment,
            "verdict": verdict,
            "elapsed_ms": round(1000 * random.lognormvariate(-0.2, 0.6)),
        }
        for segment, verdict in verdicts.items()
    ]


def wait_for_suggestions(page: Page) -> None:
    page.get_by_role("button", name=re.compile(r"^Keep \d+, reject")).wait_for()


def take_history(browser: Browser, path: str, image: int) -> None:
    """Take the long candidate that was merged from the most pieces, with how it was found."""
    segments = get(f"/images/{image}/segments")["segments"]
    longest = sorted(segments, key=lambda segment: -segment["length"])[:LONGEST]
    merged = max(longest, key=lambda segment: len(get(f"/segments/{segment['id']}/history")["pieces"]))
    page = open_page(browser, f"{path}?segment={merged['id']}")
    page.keyboard.press("i")
    page.locator(".stages__content[aria-busy=false]").wait_for()
    page.mouse.move(WIDE[0] - 100, 150)
    page.mouse.wheel(0, WIDE[1])  # the panel's end
    take(page, "label-history")


def take_leaderboard(browser: Browser, submission: int) -> None:
    take(open_page(browser, f"/splits/{SPLIT}"), "leaderboard")
    take(open_page(browser, f"/submissions/{submission}"), "submission")
    worst = get(f"/submissions/{submission}/images?sort=f1&limit=1")["items"][0]["image_id"]
    page = open_page(browser, f"/submissions/{submission}/images/{worst}")
    page.keyboard.press("j")
    take(page, "viewer")


def take_status(browser: Browser) -> None:
    page = open_page(browser, "/status")
    page.get_by_role("heading", name="Workers").wait_for()
    take(page, "status")


def main() -> None:
    found = subprocess.run([sys.executable, ROOT / "tools" / "browser.py"], check=True, capture_output=True, text=True)
    clearlines = Path(sys.executable).with_name("clearlines")
    with tempfile.TemporaryDirectory() as folder:
        command = [clearlines, "demo", "--data", folder, "--port", str(PORT), "--no-browser"]
        server = subprocess.Popen(command, stdout=subprocess.DEVNULL)
        try:
            wait_for_candidates(server, "demo-streets")
            submission = submit_results(Path(folder) / "streets" / "images", Path(folder) / "found", clearlines)
            with sync_playwright() as playwright:
                browser = playwright.chromium.launch(
                    executable_path=found.stdout.strip(), args=["--no-sandbox", "--disable-background-networking"]
                )
                take_all(browser, "demo-streets")
                take_leaderboard(browser, submission)
                take_status(browser)
                browser.close()
        finally:
            server.terminate()
            server.wait()


if __name__ == "__main__":
    main()
