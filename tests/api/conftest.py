"""The whole application in this process, on a real database, with real workers."""

from __future__ import annotations

import io
import shutil
import time
import zipfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from fastapi.testclient import TestClient
from numpy.typing import NDArray
from sqlalchemy import make_url

from app.api.application import create_application
from app.settings import Settings


def draw_lines(seed: int, *, width: int = 200, height: int = 150) -> NDArray[np.uint8]:
    """Draw a picture with a few long edges: bars of random grey, anti-aliased."""
    rng = np.random.default_rng(seed)
    image = np.full((height, width), 90, np.uint8)
    for x in rng.integers(15, width - 40, 3):
        cv2.rectangle(image, (int(x), 10), (int(x) + 14, height - 12), int(rng.integers(150, 255)), -1, cv2.LINE_AA)
    cv2.line(image, (5, 20), (width - 8, height - 30), 20, 3, cv2.LINE_AA)
    return image


def png(image: NDArray[Any]) -> bytes:
    """Return the picture as a PNG file."""
    return cv2.imencode(".png", image)[1].tobytes()


def zip_of(members: dict[str, bytes]) -> bytes:
    """Return a zip of path: content."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for path, content in members.items():
            archive.writestr(path, content)
    return stream.getvalue()


def wait_until(condition: Callable[[], Any], *, seconds: float = 60.0) -> Any:
    """Ask until the condition holds and return what it gave; fail at the deadline."""
    deadline = time.monotonic() + seconds
    while not (value := condition()):
        if time.monotonic() > deadline:
            pytest.fail(f"it didn't happen within {seconds} s")
        time.sleep(0.02)
    return value


@pytest.fixture
def settings(tmp_path: Path, sqlite_template: Path) -> Settings:
    """Of a server that finds its tables made: that takes longer than most tests."""
    settings = Settings(data_dir=tmp_path / "data", workers=1)
    settings.data_dir.mkdir()
    shutil.copy(sqlite_template, str(make_url(settings.database_address).database))
    return settings


@pytest.fixture
def client(settings: Settings) -> Iterator[TestClient]:
    with TestClient(create_application(settings), base_url="http://127.0.0.1:8765") as client:
        yield client


@pytest.fixture
def picture() -> Callable[[int], bytes]:
    """Return a PNG with a few long edges, by seed."""
    return lambda seed: png(draw_lines(seed))


@pytest.fixture
def upload(client: TestClient) -> Callable[..., dict[str, Any]]:
    """Upload files given as name: content, into a dataset that is made for it; returns the report."""

    def upload(slug: str, files: dict[str, bytes], *, status: int = 201) -> dict[str, Any]:
        if client.get(f"/api/datasets/{slug}").status_code == 404:
            assert client.post("/api/datasets", json={"name": slug}).status_code == 201
        parts = [("files", (name, content)) for name, content in files.items()]
        answer = client.post(f"/api/datasets/{slug}/images", files=parts)
        assert answer.status_code == status, answer.text
        return answer.json()

    return upload


@pytest.fixture
def finish_run(client: TestClient) -> Callable[[int], dict[str, Any]]:
    """Wait for a run and return it."""

    def finish_run(run: int) -> dict[str, Any]:
        return wait_until(
            lambda: (state := client.get(f"/api/runs/{run}").json())["status"] in ("done", "failed") and state
        )

    return finish_run


@pytest.fixture
def prelabelled(
    client: TestClient, upload: Callable[..., dict[str, Any]], finish_run: Callable[[int], dict[str, Any]]
) -> list[int]:
    """A dataset `street` of two images with candidates; returns the images' ids."""
    report = upload("street", {"a/one.png": png(draw_lines(1)), "a/two.png": png(draw_lines(2))})
    started = client.post("/api/datasets/street/runs", json={"min_length": 30})
    assert started.status_code == 202, started.text
    assert finish_run(started.json()["id"])["status"] == "done"
    return [image["id"] for image in report["added"]]
