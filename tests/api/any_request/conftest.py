"""A small world in which every address of the API names something, and that is put back after each operation."""

from __future__ import annotations

import copy
import io
import json
import shutil
import sqlite3
import time
import zipfile
from collections.abc import Iterator
from contextlib import closing
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from fastapi.testclient import TestClient
from sqlalchemy import make_url

from app.api.application import create_application
from app.clock import utc_now
from app.services.tokens import create_token
from app.settings import Settings

ADDRESS = "http://127.0.0.1:8765"
SIZE = (320, 240)
PROTOCOLS = ["clearlines-v2", "official-v1", "official-v1-fixed"]


def lines(seed: int, count: int = 12) -> list[list[list[float]]]:
    """Lines across the image, a little bent: enough of them calibrate a camera."""
    random = np.random.default_rng(seed)
    found: list[list[list[float]]] = []
    while len(found) < count:
        ends = random.uniform((3, 3), (SIZE[0] - 4, SIZE[1] - 4), (2, 2))
        if np.hypot(*(ends[0] - ends[1])) > 90:
            found.append(np.linspace(ends[0], ends[1], 40).round(3).tolist())
    return found


def picture(seed: int) -> bytes:
    pixels = np.full((SIZE[1], SIZE[0]), 80 + seed, np.uint8)
    for points in lines(seed):
        cv2.polylines(pixels, [np.rint(points).astype(np.int32)], isClosed=False, color=220, thickness=2)
    return cv2.imencode(".png", pixels)[1].tobytes()


def labels(seed: int, *verdicts: str) -> bytes:
    """A label file whose segments have the verdicts, one after the other and again from the first."""
    segments = [
        {"points": points, "verdict": verdicts[place % len(verdicts)]} for place, points in enumerate(lines(seed))
    ]
    return json.dumps({"segments": segments}).encode()


def predictions(*names: str) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for seed, name in enumerate(names):
            segments = [{"points": points, "score": 0.5} for points in lines(seed + 1)[:5]]
            archive.writestr(f"{name}.json", json.dumps({"segments": segments}))
    return stream.getvalue()


@dataclass
class World:
    """A running server and what is in it.

    Attributes:
        application: The ASGI application; its life is the fixture's.
        database: The file of its database.
        kept: A copy of it, as it was when all was made.
        document: The OpenAPI document, in which ids may also be those that exist.
        known: By name of a path's part, of a query or of a body's field: values that exist.
    """

    client: TestClient
    application: Any
    database: Path
    kept: Path
    document: dict[str, Any] = field(default_factory=dict)
    known: dict[str, list[Any]] = field(default_factory=dict)

    def made(self, method: str, address: str, **given: Any) -> Any:
        answer = self.client.request(method, address, **given)
        assert answer.status_code < 300, f"{method} {address}: {answer.text}"
        return answer.json()

    def until(self, address: str, *ends: str) -> None:
        """Wait until work is at its end; the events of a submission, and runs, tell by their status."""
        deadline = time.monotonic() + 60
        while (state := self.made("GET", address))["status"] not in ends:
            assert time.monotonic() < deadline, state
            time.sleep(0.02)

    def restore(self) -> None:
        """Put all rows back as they were."""
        with closing(sqlite3.connect(self.kept)) as kept, closing(sqlite3.connect(self.database)) as live:
            kept.backup(live)


@pytest.fixture(scope="module")
def world(tmp_path_factory: pytest.TempPathFactory, sqlite_template: Path) -> Iterator[World]:
    folder = tmp_path_factory.mktemp("any")
    settings = Settings(
        data_dir=folder,
        workers=1,
        validation_seconds=0.01,
        request_limit="1000000/second",
        upload_limit="1000000/second",
        sign_in_limit="1000000/second",
    )
    database = Path(str(make_url(str(settings.database_address)).database))
    shutil.copy(sqlite_template, database)
    application = create_application(settings)
    with TestClient(application, base_url=ADDRESS) as client:
        world = World(client, application, database, folder / "kept.sqlite3")
        fill(world)
        # what requests put into the queue from now on stays there: the next test takes it back
        application.state.server.dispatcher.stop()
        with closing(sqlite3.connect(database)) as live, closing(sqlite3.connect(world.kept)) as kept:
            live.backup(kept)
        world.document = with_known(client.get("/api/openapi.json").json(), world.known)
        yield world


def upload(world: World, slug: str, files: dict[str, bytes]) -> list[int]:
    world.made("POST", "/api/datasets", json={"name": slug})
    parts = [("files", (name, content)) for name, content in files.items()]
    return [image["id"] for image in world.made("POST", f"/api/datasets/{slug}/images", files=parts)["added"]]


def fill(world: World) -> None:
    """Make one of everything: in use, at its end, and deleted."""
    street = upload(
        world,
        "street",
        {
            **{f"images/a/{seed}.png": picture(seed) for seed in (1, 2, 3, 4)},
            **{f"labels/a/{seed}.json": labels(seed, "keep", "keep", "reject") for seed in (1, 2)},
            "labels/a/3.json": labels(3, "undecided"),
        },
    )
    secret = upload(
        world, "secret", {"images/b/7.png": picture(7), "labels/b/7.json": labels(7, "keep", "ambiguous", "keep")}
    )
    upload(world, "gone", {"8.png": picture(8)})
    world.made("DELETE", "/api/datasets/gone")
    world.made("DELETE", f"/api/images/{street[3]}")
    world.made("POST", "/api/datasets/street/splits", json={"name": "Open", "image_ids": street[:2]})
    world.made("POST", "/api/datasets/secret/splits", json={"name": "Hidden", "visibility": "hidden"})
    runs = [
        world.made("POST", "/api/datasets/street/runs", json={"image_ids": ids})["id"]
        for ids in (street[:1], street[2:3])
    ]
    world.made("POST", f"/api/runs/{runs[0]}/cancel")
    world.until(f"/api/runs/{runs[1]}", "done")
    cameras = [
        camera["id"] for slug in ("street", "secret") for camera in world.made("GET", f"/api/datasets/{slug}/cameras")
    ]
    calibrations = [calibrate(world, cameras[0], family) for family in ("division", "brown")]
    # by a second person: the one who brought the labels can't be it
    with world.application.state.server.database.write() as session:
        token = create_token(session, "anna", "annotator", utc_now(), person=None).text
    anna = {"Authorization": f"Bearer {token}"}
    reviews = [world.made("POST", f"/api/images/{image}/second-review", headers=anna)["id"] for image in street[:2]]
    submissions = [hand_in(world, split, method) for split, method in (("open", "First"), ("hidden", "Second"))]
    split_images = [
        image["id"]
        for split in ("open", "hidden")
        for image in world.made("GET", f"/api/splits/{split}/images")["items"]
    ]
    segments = [
        segment["id"]
        for image in (*street[:3], *secret)
        for segment in world.made("GET", f"/api/images/{image}/segments")["segments"][:3]
    ]
    world.known = {
        "slug": ["street", "secret", "gone"],
        "dataset": ["street", "secret"],
        "split": ["open", "hidden"],
        "image_id": [*street, *secret],
        "image_ids": [*street, *secret],
        "ids": [*street, *secret],
        "segment_id": segments,
        "replaces": segments,
        "run_id": runs,
        "second_review_id": reviews,
        "camera_id": cameras,
        "camera": cameras,
        "calibration_id": calibrations,
        "split_image_id": split_images,
        "submission_id": submissions,
        "other": submissions,
        "method": ["first", "second", "First"],
        "version": [1],
        "protocol": PROTOCOLS,
        "format": ["npz", "json", "coco", "csv", "clearlines", "ros", "opencv", "colmap", "lensfun"],
        "people": ["owner", "anna"],
    }


def calibrate(world: World, camera: int, family: str) -> int:
    number = world.made("POST", f"/api/cameras/{camera}/calibrations", json={"family": family})["id"]
    world.until(f"/api/calibrations/{number}", "done")
    return number


def hand_in(world: World, split: str, method: str) -> int:
    names = [image["name"] for image in world.made("GET", f"/api/splits/{split}/images")["items"]]
    files = [("files", ("predictions.zip", predictions(*names)))]
    number = world.made("POST", f"/api/splits/{split}/submissions", files=files, data={"method": method})["id"]
    world.until(f"/api/submissions/{number}", "scored")
    return number


def with_known(document: dict[str, Any], known: dict[str, list[Any]]) -> dict[str, Any]:
    """Return the document in which what is asked with may also be what exists: ids made up find nothing."""
    document = copy.deepcopy(document)
    for path in document["paths"].values():
        for operation in path.values():
            for parameter in operation.get("parameters", ()):
                if parameter["name"] in known:
                    parameter["schema"] = either(parameter["schema"], known[parameter["name"]])
    for schema in document["components"]["schemas"].values():
        for name, given in schema.get("properties", {}).items():
            if name in known:
                place = next((part for part in (given, *given.get("anyOf", ())) if part.get("type") == "array"), None)
                if place is not None and place.get("items", {}).get("type") in ("integer", "string"):
                    place["items"] = either(place["items"], known[name])
                elif given.get("type") in ("integer", "string"):
                    schema["properties"][name] = either(given, known[name])
    return document


def either(schema: dict[str, Any], values: list[Any]) -> dict[str, Any]:
    return {"anyOf": [{"enum": values}, schema]}
