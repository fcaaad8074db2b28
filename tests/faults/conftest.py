"""A server in a process of its own, asked by several at once while things go wrong around it."""

from __future__ import annotations

import hashlib
import json
import os
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from uuid import uuid4

import cv2
import httpx2 as httpx
import numpy as np
import psutil
import pytest

CLEARLINES = Path(sys.executable).with_name("clearlines")
UNLIMITED = "1000000/second"
DEADLINE = 80.0  # s
PAUSE = 0.05  # s, between two requests of one person: the server has other work too


def eventually(condition: Callable[[], Any], what: str, *, seconds: float = DEADLINE) -> Any:
    """Ask until the condition holds and return what it gave; fail at the deadline."""
    deadline = time.monotonic() + seconds
    while not (value := condition()):
        assert time.monotonic() < deadline, f"not within {seconds:g} s: {what}"
        time.sleep(0.02)
    return value


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def picture(seed: int, size: tuple[int, int] = (160, 120)) -> bytes:
    """A PNG with a few long edges."""
    width, height = size
    pixels = np.full((height, width), 40 + seed % 150, np.uint8)
    for row in (20, 55, 90):
        pixels[row : row + 14, 6 + seed % 9 : width - 8] = 210
    pixels[0, :8] = [(seed >> bit & 1) * 255 for bit in range(8)]
    return cv2.imencode(".png", pixels)[1].tobytes()


def label_file(count: int) -> bytes:
    """Lines that nobody has judged yet."""
    segments = [
        {"points": [[5, 3 + 0.4 * row], [150, 3.5 + 0.4 * row]], "verdict": "undecided"} for row in range(count)
    ]
    return json.dumps({"segments": segments}).encode()


@dataclass
class Site:
    """An installation, and the server that runs it.

    Attributes:
        data: Its data folder.
        port: Where it is served, the same after each start.
        environment: What else the server is told.
        prefix: A command that starts the server's command, such as ``unshare -m``.
    """

    data: Path
    port: int = field(default_factory=free_port)
    environment: Mapping[str, str] = field(default_factory=dict)
    prefix: tuple[str, ...] = ()
    process: subprocess.Popen[bytes] | None = None

    @property
    def log(self) -> Path:
        return self.data.parent / "server.log"

    def start(self, *, wait: bool = True) -> None:
        command = [*self.prefix, str(CLEARLINES), "serve", "--data", str(self.data), "--port", str(self.port)]
        limits = {f"CLEARLINES_{name}_LIMIT": UNLIMITED for name in ("REQUEST", "UPLOAD", "SIGN_IN")}
        with self.log.open("ab") as log:
            self.process = subprocess.Popen(
                [*command, "--no-browser"],
                stdout=log,
                stderr=log,
                env={**os.environ, "CLEARLINES_WORKERS": "1", **limits, **self.environment},
            )
        if wait:
            eventually(self.answers, "the server answers")

    def answers(self) -> bool:
        assert self.process is not None
        assert self.process.poll() is None, self.log.read_text()
        try:
            with self.client(timeout=5) as client:
                return client.get("/health").status_code == 200
        except httpx.HTTPError:
            return False

    def client(self, **options: Any) -> httpx.Client:
        return httpx.Client(base_url=f"http://127.0.0.1:{self.port}/api", **{"timeout": 60, "verify": False, **options})

    def ask(self, method: str, address: str, *, status: int | None = None, **given: Any) -> Any:
        """Return what is answered, which must be good, or have the status."""
        with self.client() as client:
            answer = client.request(method, address, **given)
        good = answer.status_code == status if status else answer.is_success
        assert good, f"{method} {address}: {answer.status_code} {answer.text}\n{self.log.read_text()[-3000:]}"
        return answer.json() if answer.content else None

    def kill(self) -> None:
        """Kill the server as a crash would: no handler runs, no file is closed."""
        assert self.process is not None
        self.process.send_signal(signal.SIGKILL)
        self.process.wait()

    def stop(self) -> None:
        if self.process is None or self.process.poll() is not None:
            return
        self.process.send_signal(signal.SIGINT)
        try:
            self.process.wait(20)
        except subprocess.TimeoutExpired:
            children = psutil.Process(self.process.pid).children(recursive=True)
            self.kill()
            for child in children:
                child.kill()
            pytest.fail(f"the server didn't end: {self.log.read_text()[-3000:]}")

    def items(self, address: str, **query: Any) -> list[dict[str, Any]]:
        """Return all items of a list, page by page."""
        found: list[dict[str, Any]] = []
        cursor: str | None = None
        while True:
            page = self.ask("GET", address, params={**query, "limit": 200, **({"cursor": cursor} if cursor else {})})
            found += page["items"]
            cursor = page["next_cursor"]
            if cursor is None:
                return found

    def make_dataset(self, name: str, files: Mapping[str, bytes]) -> list[int]:
        self.ask("POST", "/datasets", json={"name": name})
        parts = [("files", part) for part in files.items()]
        return [image["id"] for image in self.ask("POST", f"/datasets/{name}/images", files=parts)["added"]]


@dataclass
class Sent:
    """What one of those who ask has sent, and what of it was answered.

    Attributes:
        sent: Each thing, in order.
        answered: Those whose answer was good.
        refused: Status and body of other answers.
    """

    sent: list[Any] = field(default_factory=list)
    answered: list[Any] = field(default_factory=list)
    refused: list[tuple[int, Any]] = field(default_factory=list)


@dataclass
class Crowd:
    """People who ask a server again and again, each in a thread, until told to stop."""

    site: Site
    stopping: threading.Event = field(default_factory=threading.Event)
    threads: list[threading.Thread] = field(default_factory=list)

    def add(self, ask: Callable[[httpx.Client, int], tuple[Any, httpx.Response]]) -> Sent:
        """Let somebody ask; the function sends one thing, by its number, and returns it with the answer.

        What gets no answer stays in ``sent`` alone, as in a page that was cut off.
        """
        record = Sent()

        def run() -> None:
            with self.site.client(timeout=30) as client:
                number = 0
                while not self.stopping.is_set():
                    number += 1
                    try:
                        thing, answer = ask(client, number)
                    except httpx.HTTPError:
                        self.stopping.wait(PAUSE)
                        continue
                    record.sent.append(thing)
                    if answer.is_success:
                        record.answered.append(thing)
                    else:
                        record.refused.append((answer.status_code, answer.json()))
                    self.stopping.wait(PAUSE)

        thread = threading.Thread(target=run, daemon=True)
        self.threads.append(thread)
        thread.start()
        return record

    def stop(self) -> None:
        self.stopping.set()
        for thread in self.threads:
            thread.join(60)


def decide_on(image: int, segments: list[int]) -> Callable[[httpx.Client, int], tuple[Any, httpx.Response]]:
    """Return what sends one verdict after the other on an image's segments, over and over."""

    def ask(client: httpx.Client, number: int) -> tuple[Any, httpx.Response]:
        row = {
            "client_id": str(uuid4()),
            "group_id": str(uuid4()),
            "segment_id": segments[number % len(segments)],
            "verdict": ("keep", "reject", "ambiguous")[number % 3],
        }
        answer = client.post(f"/images/{image}/decisions", json={"decisions": [row]})
        return (row["client_id"], row["segment_id"], row["verdict"]), answer

    return ask


def upload_to(dataset: str) -> Callable[[httpx.Client, int], tuple[Any, httpx.Response]]:
    """Return what uploads one new image after the other."""

    def ask(client: httpx.Client, number: int) -> tuple[Any, httpx.Response]:
        files = [("files", (f"new/{number}.png", picture(number)))]
        return number, client.post(f"/datasets/{dataset}/images", files=files)

    return ask


def check_verdicts(site: Site, image: int, verdicts: Sent) -> None:
    """Each one that was answered is there once, in order; the page shows the last of each segment."""
    stored = [
        (row["client_id"], row["segment_id"], row["verdict"])
        for row in site.ask("GET", f"/images/{image}/decisions")["decisions"]
    ]
    assert len(set(stored)) == len(stored)
    answered = set(verdicts.answered)
    assert [row for row in stored if row in answered] == verdicts.answered
    last = {segment: verdict for _, segment, verdict in stored}
    shown = site.ask("GET", f"/images/{image}/segments")["segments"]
    assert {row["id"]: row["verdict"] for row in shown if row["verdict"] != "undecided"} == last


def check_images(site: Site, dataset: str, images: Sent) -> None:
    """Each one that was answered is there once, whole; of the others either nothing or all of it."""
    stored = {row["name"]: row["id"] for row in site.items(f"/datasets/{dataset}/images")}
    assert {f"new/{number}" for number in images.answered} <= stored.keys()
    assert site.ask("GET", f"/datasets/{dataset}")["images"] == len(stored)
    with site.client() as client:
        for name, image in stored.items():
            content = client.get(f"/images/{image}/original").content
            assert hashlib.sha256(content).digest() == hashlib.sha256(picture(int(name[4:]))).digest(), name


def check_run(site: Site, run: int) -> None:
    """Every image is done after one attempt, or two if it was in a worker's hands; its candidates are there once."""
    eventually(lambda: site.ask("GET", f"/runs/{run}")["status"] == "done", "the run is finished")
    rows = site.items(f"/runs/{run}/images")
    assert [row["status"] for row in rows] == ["done"] * len(rows)
    assert rows
    assert all(row["attempts"] <= 2 for row in rows)
    for row in rows:
        found = site.ask("GET", f"/images/{row['image']['id']}/segments")["segments"]
        assert len({segment["id"] for segment in found}) == len(found) > 0
        assert [segment["ordinal"] for segment in found] == list(range(len(found)))


@pytest.fixture
def make_site(tmp_path: Path) -> Iterator[Callable[..., Site]]:
    """Make sites; their servers are stopped at the end."""
    sites: list[Site] = []

    def make(**options: Any) -> Site:
        site = Site(**{"data": tmp_path / "data", **options})
        sites.append(site)
        return site

    yield make
    for site in sites:
        site.stop()


@pytest.fixture
def make_crowd() -> Iterator[Callable[[Site], Crowd]]:
    """Make crowds; all are told to stop at the end."""
    crowds: list[Crowd] = []

    def make(site: Site) -> Crowd:
        crowds.append(Crowd(site))
        return crowds[-1]

    yield make
    for crowd in crowds:
        crowd.stop()


@dataclass(frozen=True)
class Tools:
    """The functions above, for tests: their files can't import from each other."""

    eventually: Callable[..., Any] = eventually
    picture: Callable[..., bytes] = picture
    label_file: Callable[[int], bytes] = label_file
    decide_on: Callable[..., Any] = decide_on
    upload_to: Callable[..., Any] = upload_to
    check_verdicts: Callable[..., None] = check_verdicts
    check_images: Callable[..., None] = check_images
    check_run: Callable[..., None] = check_run


@pytest.fixture(scope="session")
def tools() -> Tools:
    return Tools()
