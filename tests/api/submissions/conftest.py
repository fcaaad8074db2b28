"""A split of drawn images whose labels are known, and uploads for it."""

from __future__ import annotations

import io
import itertools
import json
import zipfile
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
import pytest
from fastapi.testclient import TestClient
from numpy.typing import NDArray

from app.api.application import create_application
from app.formats.labelled import LabelledSegments
from app.formats.npz import write_npz
from app.settings import Settings
from app.vision.segments import Segments

WIDTH, HEIGHT = 320, 240
NAMES = ("a/one", "a/two", "b/three", "b/four", "b/five")


def line(x0: float, y0: float, x1: float, y1: float, points: int = 60) -> NDArray[np.float32]:
    """A straight segment."""
    share = np.linspace(0, 1, points)[:, None]
    return (np.array([x0, y0]) * (1 - share) + np.array([x1, y1]) * share).astype(np.float32)


def labels_of(place: int) -> list[NDArray[np.float32]]:
    """Four labels of an image, all at least 150 px long."""
    return [line(20, 30 + 45 * row + place, 200 + 20 * row, 36 + 45 * row + place) for row in range(4)]


def picture(place: int) -> bytes:
    image = np.full((HEIGHT, WIDTH), 60 + place, np.uint8)
    for polyline in labels_of(place):
        cv2.polylines(image, [np.rint(polyline).astype(np.int32)], isClosed=False, color=220, thickness=2)
    return cv2.imencode(".png", image)[1].tobytes()


def npz(lines: list[NDArray[np.float32]], scores: list[float] | None = None) -> bytes:
    return write_npz(LabelledSegments(Segments.from_list(lines, scores)))


def zip_of(members: Mapping[str, bytes]) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for path, content in members.items():
            archive.writestr(path, content)
    return stream.getvalue()


def perfect() -> bytes:
    """A zip that finds every label."""
    return zip_of({f"{name}.npz": npz(labels_of(place)) for place, name in enumerate(NAMES)})


def half() -> bytes:
    """A zip that finds two of four labels and has one line that is none."""
    return zip_of(
        {f"{name}.npz": npz([*labels_of(place)[:2], line(10, 215, 300, 230)]) for place, name in enumerate(NAMES)}
    )


@dataclass(frozen=True)
class Field:
    """A split and how to submit to it."""

    client: TestClient
    split: str
    images: list[int]

    def submit(
        self, content: bytes, name: str = "results.zip", *, status: int = 202, headers: Any = None, **fields: Any
    ) -> dict[str, Any]:
        answer = self.client.post(
            f"/api/splits/{self.split}/submissions",
            files=[("files", (name, content))],
            data={"method": "Lines", **fields},
            headers=headers,
        )
        assert answer.status_code == status, answer.text
        return answer.json()

    def finished(self, submission: int) -> dict[str, Any]:
        """Follow the events of a submission to its end."""
        found: dict[str, Any] = {}
        with self.client.stream("GET", f"/api/submissions/{submission}/events") as events:
            assert events.headers["content-type"].startswith("text/event-stream")
            for text in events.iter_lines():
                if text.startswith("data: "):
                    found = json.loads(text[6:])
        return found

    def scored(self, content: bytes, **fields: Any) -> dict[str, Any]:
        done = self.finished(self.submit(content, **fields)["id"])
        assert done["status"] == "scored", done
        return done


@pytest.fixture(scope="module")
def settings(tmp_path_factory: pytest.TempPathFactory) -> Settings:
    """Of one server for all tests of a file: starting workers is what takes long."""
    return Settings(data_dir=tmp_path_factory.mktemp("server"), workers=1, max_submission_segments=200_000)


@pytest.fixture(scope="module")
def client(settings: Settings) -> Iterator[TestClient]:
    with TestClient(create_application(settings), base_url="http://127.0.0.1:8765") as client:
        yield client


@pytest.fixture(scope="module")
def make_field(client: TestClient) -> Callable[..., Field]:
    """Upload images, label them, freeze them; each time another dataset."""
    count = itertools.count(1)

    def make(visibility: str = "open", **split: Any) -> Field:
        # images of hidden splits may not be in open ones
        first, dataset = (100 if visibility == "hidden" else 0), f"street-{next(count)}"
        files: dict[str, bytes] = {}
        for place, name in enumerate(NAMES):
            files[f"images/{name}.png"] = picture(place + first)
            stream = io.BytesIO()
            array = np.empty(4, dtype=object)
            for index, polyline in enumerate(labels_of(place)):
                array[index] = polyline.astype(np.float64).reshape(-1, 1, 2)
            np.save(stream, array, allow_pickle=True)
            files[f"labels/{name}_edge_segments_filtered.npy"] = stream.getvalue()
        assert client.post("/api/datasets", json={"name": dataset}).status_code == 201
        zipped = [("files", ("street.zip", zip_of(files)))]
        report = client.post(f"/api/datasets/{dataset}/images", files=zipped).json()
        assert report["labels"] == len(NAMES), report
        given = {"name": dataset, "visibility": visibility, **split}
        answer = client.post(f"/api/datasets/{dataset}/splits", json=given)
        assert answer.status_code == 201, answer.text
        return Field(client, answer.json()["slug"], [image["id"] for image in report["added"]])

    return make


@pytest.fixture
def field(make_field: Callable[..., Field]) -> Field:
    return make_field()


@pytest.fixture
def perfect_results() -> bytes:
    return perfect()


@pytest.fixture
def half_results() -> bytes:
    return half()


@pytest.fixture
def one_image() -> bytes:
    return zip_of({"results/a/one_edge_segments_filtered.npz": npz(labels_of(0)), "readme.txt": b"hello"})


@pytest.fixture
def loose_files() -> list[tuple[str, tuple[str, bytes]]]:
    return [("files", (f"{name}.npz", npz(labels_of(place)))) for place, name in enumerate(NAMES)]
