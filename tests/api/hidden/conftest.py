"""A server with a hidden split whose labels carry marks, and the means to look for these marks in any answer."""

from __future__ import annotations

import gzip
import io
import json
import re
import struct
import time
import zipfile
import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

import cv2
import numpy as np
import pytest
from fastapi.testclient import TestClient

from app.api.application import create_application
from app.clock import utc_now
from app.services.access import ROLES
from app.services.tokens import create_token
from app.settings import Settings

MARKS = (412.4567, 137.8142, 268.6393, 91.3379, 337.2718, 173.5429)
"""x and y of the first kept label, the ambiguous one and a line rejected with a reason; nothing else here has these."""

LABELS = 223
"""Number of kept labels, which no other count here comes to."""

HIDDEN_SIZE = (651, 227)
OPEN_SIZE = (180, 240)
NUMBER = re.compile(rb"-?\d+\.\d+(?:[eE][+-]?\d+)?")


def grey(seed: int, size: tuple[int, int]) -> bytes:
    """A PNG without any colour."""
    width, height = size
    pixels = np.full((height, width), 100, np.uint8)
    pixels[20:160, 30 + 7 * seed : 80 + 7 * seed] = 180
    return cv2.imencode(".png", pixels)[1].tobytes()


def other_line(row: int) -> list[list[float]]:
    """A label without a mark, which anyone may find by looking at the image."""
    return [[5 + 3 * row, 5 + row / 2], [50 + 3 * row, 6 + row / 2]]


def traced(first: list[float], last: list[float], count: int = 12) -> list[list[float]]:
    """Points along a line."""
    return np.linspace(first, last, count).tolist()


def label_file(*, marked: bool) -> bytes:
    """Labels as a file: with the marks, or harmless ones."""
    x, y, u, v, s, t = MARKS if marked else (20.0, 30.0, 40.0, 50.0, 60.0, 70.0)
    count = LABELS if marked else 3
    lines = [
        *(traced([x, y + step], [x + 60, y + step + 1]) for step in range(3)),  # calibrations read no pair of points
        *([[5 + row, 5 + row / 2], [50 + row, 6 + row / 2]] for row in range(count - 3)),
    ]
    segments = [{"points": points, "verdict": "keep"} for points in lines]
    segments.append({"points": [[s, t], [s + 60, t + 1]], "verdict": "reject", "reason": "shadow"})
    segments.append({"points": [[u, v], [u + 60, v + 1]], "verdict": "ambiguous"})
    return json.dumps({"segments": segments}).encode()


def predictions(*names: str) -> bytes:
    """A zip of harmless predictions: some of the labels without a mark, and a line that is no label."""
    lines = [[[20, 200], [120, 201]], *(other_line(20 * row) for row in range(7))]
    content = json.dumps({"segments": [{"points": line} for line in lines]})
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for name in names:
            archive.writestr(f"{name}.json", content)
    return stream.getvalue()


@dataclass
class World:
    """The server and what is in it.

    Attributes:
        document: The OpenAPI document.
        headers: What each role sends with its requests; ``reader`` sends nothing.
        ids: By name of a path's part or of a query: values that lead to hidden things, then harmless ones.
    """

    client: TestClient
    document: dict[str, Any]
    headers: dict[str, dict[str, str]]
    ids: dict[str, list[Any]] = field(default_factory=dict)

    def ask(self, role: str, method: str, address: str, **given: Any) -> Any:
        return self.client.request(method, address, headers=self.headers[role], **given)

    def made(self, method: str, address: str, *, role: str = "maintainer", **given: Any) -> Any:
        answer = self.ask(role, method, address, **given)
        assert answer.status_code < 300, f"{method} {address}: {answer.text}"
        return answer.json()

    def operations(self) -> Iterator[tuple[str, str, dict[str, Any]]]:
        """Method, template and description of every operation of the OpenAPI document."""
        for template, path in sorted(self.document["paths"].items()):
            for method, operation in path.items():
                yield method.upper(), template, operation


def upload(world: World, slug: str, files: dict[str, bytes]) -> list[int]:
    world.made("POST", "/api/datasets", json={"name": slug})
    parts = [("files", (name, content)) for name, content in files.items()]
    return [image["id"] for image in world.made("POST", f"/api/datasets/{slug}/images", files=parts)["added"]]


def submit(world: World, split: str, method: str, *, role: str = "submitter") -> int:
    """Hand in harmless predictions and wait for their score."""
    names = [image["name"] for image in world.made("GET", f"/api/splits/{split}/images")["items"]]
    files = [("files", ("predictions.zip", predictions(*names)))]
    address = f"/api/splits/{split}/submissions"
    number = world.made("POST", address, role=role, files=files, data={"method": method})["id"]
    deadline = time.monotonic() + 60
    while (state := world.made("GET", f"/api/submissions/{number}", role=role))["status"] != "scored":
        assert state["status"] not in ("invalid", "failed"), state
        assert time.monotonic() < deadline, state
        time.sleep(0.05)
    return number


def calibrate(world: World, camera: int) -> int:
    """Have a camera calibrated and wait for it."""
    number = world.made("POST", f"/api/cameras/{camera}/calibrations", json={"family": "brown"})["id"]
    deadline = time.monotonic() + 60
    while (state := world.made("GET", f"/api/calibrations/{number}"))["status"] != "done":
        assert state["status"] in ("queued", "running"), state
        assert time.monotonic() < deadline, state
        time.sleep(0.05)
    return number


@pytest.fixture(scope="module")
def world(tmp_path_factory: pytest.TempPathFactory) -> Iterator[World]:
    """Datasets `secret` (hidden split), `copy` (the same image, no labels), `street` (open split), and submissions."""
    settings = Settings(data_dir=tmp_path_factory.mktemp("hidden"), workers=1, anonymous_role="reader")
    application = create_application(settings)
    with TestClient(application, base_url="http://127.0.0.1:8765") as client:
        database = application.state.server.database
        with database.write() as session:
            tokens = {role: create_token(session, role, role, utc_now(), person=None).text for role in ROLES[1:]}
        headers = {role: {"Authorization": f"Bearer {token}"} for role, token in tokens.items()}
        world = World(client, client.get("/api/openapi.json").json(), {"reader": {}, **headers})
        fill(world)
        yield world


def fill(world: World) -> None:
    hidden, beside = grey(1, HIDDEN_SIZE), grey(2, HIDDEN_SIZE)
    secret = upload(
        world,
        "secret",
        {
            "images/a/one.png": hidden,
            "labels/a/one.json": label_file(marked=True),
            "images/a/two.png": beside,
        },
    )
    street = upload(
        world, "street", {"images/b/one.png": grey(3, OPEN_SIZE), "labels/b/one.json": label_file(marked=False)}
    )
    freeze = {"name": "Hidden", "visibility": "hidden", "image_ids": secret[:1]}
    world.made("POST", "/api/datasets/secret/splits", json=freeze)
    world.made("POST", "/api/datasets/street/splits", json={"name": "Open"})
    copy = upload(world, "copy", {"a/other.png": hidden})
    run = world.made("POST", "/api/datasets/secret/runs", json={"image_ids": secret[1:]})["id"]
    world.made("POST", f"/api/runs/{run}/cancel")
    segments = world.made("GET", f"/api/images/{secret[0]}/segments")["segments"]
    cameras = [
        camera["id"] for slug in ("secret", "street") for camera in world.made("GET", f"/api/datasets/{slug}/cameras")
    ]
    calibrations = [calibrate(world, camera) for camera in cameras]
    split_images = [
        image["id"] for slug in ("hidden", "open") for image in world.made("GET", f"/api/splits/{slug}/images")["items"]
    ]
    # by the owner: the maintainer, who brought the labels, may not be the second person
    second_reviews = [
        world.made("POST", f"/api/images/{image}/second-review", role="admin")["id"] for image in (secret[0], street[0])
    ]
    submissions = [submit(world, "hidden", "first"), submit(world, "hidden", "second"), submit(world, "open", "first")]
    world.ids = {
        "slug": ["secret", "copy", "street"],
        "dataset": ["secret", "street"],
        "split": ["hidden", "open"],
        "image_id": [*secret, *copy, *street],
        "segment_id": [segments[0]["id"], segments[-1]["id"]],
        "run_id": [run],
        "second_review_id": second_reviews,
        "camera_id": cameras,
        "camera": cameras,
        "calibration_id": calibrations,
        "split_image_id": split_images,
        "submission_id": submissions,
        "other": submissions,
        "method": ["first", "second"],
        "version": [1],
        "status": ["done", "scored"],
        "search": ["one"],
        "format": ["npz", "json", "clearlines", "coco", "cvat", "datumaro", "labelme", "geojson", "csv", "ros"],
        "sort": ["name", "-name", "f1", "-f1", "fn", "tp"],
        "protocol": ["clearlines-v2", "official-v1", "official-v1-fixed"],
        "source": ["a"],
        "limit": [1],
        "size": [640],
        **{name: [1] for name in ("user_id", "session_id", "token_id", "invitation_id", "identity_id")},
    }


@pytest.fixture(scope="session")
def leaks_in() -> Callable[[Any], list[str]]:
    """Return what of the hidden labels is in an answer: marks as text or bytes, packed or not, colours, the count."""

    def leaks_in(answer: Any) -> list[str]:
        head = "\n".join(f"{name}: {value}" for name, value in answer.headers.items()).encode()
        return [*_marks(head), *(leak for content in _unpacked(answer.content) for leak in _leaks(content))]

    return leaks_in


def _leaks(content: bytes) -> list[str]:
    return [*_marks(content), *_counts(content), *_colours(content)]


def _marks(content: bytes) -> list[str]:
    numbers = np.array([float(number) for number in NUMBER.findall(content)])
    found = [f"{mark} as text" for mark in MARKS if len(numbers) and np.abs(numbers - mark).min() < 0.006]
    for mark in MARKS:
        # doubles of the label file, and of the float32 that is stored of it
        exact = (mark, float(np.float32(mark)))
        forms = [struct.pack(order + "f", mark) for order in "<>"]
        forms += [struct.pack(order + "d", value) for order in "<>" for value in exact]
        if any(form in content for form in forms):
            found.append(f"{mark} as bytes")
    return found


def _counts(content: bytes) -> list[str]:
    try:
        text = content.decode()
    except UnicodeDecodeError:
        return []
    return ["number of labels"] if re.search(rf"(?<![\w.-]){LABELS}(?![\w.-])", text) else []


def _colours(content: bytes) -> list[str]:
    if not content.startswith((b"\x89PNG", b"\xff\xd8\xff", b"RIFF")):
        return []
    pixels = cv2.imdecode(np.frombuffer(content, np.uint8), cv2.IMREAD_COLOR)
    if pixels is None or pixels.shape[1] < HIDDEN_SIZE[0] / 4:
        return []
    spread = pixels.max(axis=2).astype(int) - pixels.min(axis=2)
    of_hidden = (
        pixels.shape[1] >= HIDDEN_SIZE[0]
        or abs(pixels.shape[1] / pixels.shape[0] - HIDDEN_SIZE[0] / HIDDEN_SIZE[1]) < 0.1
    )
    return ["lines drawn on the image"] if of_hidden and int((spread > 40).sum()) > 20 else []


def _unpacked(content: bytes, depth: int = 0) -> Iterator[bytes]:
    yield content
    if depth > 3:
        return
    if content.startswith(b"PK"):
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            for name in archive.namelist():
                yield name.encode()
                yield from _unpacked(archive.read(name), depth + 1)
    elif content.startswith(b"\x1f\x8b"):
        yield from _unpacked(gzip.decompress(content), depth + 1)
    elif content.startswith(b"x\x9c"):
        yield from _unpacked(zlib.decompress(content), depth + 1)
