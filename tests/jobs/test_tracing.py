"""Tracing on request: the worker remembers edges, and a worker that dies is told of."""

from __future__ import annotations

from concurrent.futures import Executor, Future, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest

from app.errors import InvalidImage, NoEdge, Unavailable
from app.jobs import tracing
from app.jobs.tracing import Tracer, Wanted, trace_task
from app.storage import LocalBlobs
from app.vision.distortion import estimate_distortion
from app.vision.segments import Segments


def wall(level: int = 180) -> bytes:
    image = np.full((120, 300), 80, np.uint8)
    image[60:] = level
    return cv2.imencode(".png", image)[1].tobytes()


def wanted(sha256: str = "", how: str = "edge", **fields: Any) -> Wanted:
    points = np.array([[20.0, 62.0], [280.0, 57.0]])
    return Wanted(
        **{"sha256": sha256, "image_name": "wall", "distortion": None, "points": points, "how": how, **fields}, reach=8
    )


@pytest.fixture
def blobs(tmp_path: Path) -> LocalBlobs:
    return LocalBlobs(tmp_path / "blobs")


def test_an_image_is_read_once_for_many_traces(blobs: LocalBlobs, monkeypatch: pytest.MonkeyPatch) -> None:
    read: list[int] = []

    def decode(content: bytes, **options: Any) -> Any:
        read.append(len(content))
        return np.asarray(cv2.imdecode(np.frombuffer(content, np.uint8), cv2.IMREAD_GRAYSCALE))

    monkeypatch.setattr(tracing, "decode_gray", decode)
    content = wall(181)
    tracer = Tracer(blobs, 10**6, executors=ThreadPoolExecutor)
    sha256 = blobs.put(content)
    for _ in range(3):
        assert tracer.trace(wanted(sha256)).points[:, 1] == pytest.approx(59.5, abs=0.05)
    tracer.stop()
    assert len(read) == 1


def test_each_way_of_tracing() -> None:
    content = wall()
    edge = trace_task(content, wanted(), max_pixels=10**6)
    assert edge.points[:, 1] == pytest.approx(59.5, abs=0.05)
    drawn = trace_task(content, wanted(how="straight"), max_pixels=10**6)
    assert drawn.points[[0, -1]].tolist() == [[20, 62], [280, 57]]
    extended = trace_task(content, wanted(how="extend", points=edge.points[60:160]), max_pixels=10**6)
    assert extended.length > 290


def test_a_lens_that_was_refused_bends_nothing() -> None:
    refused = estimate_distortion([Segments.empty()], (300, 120)).as_dict()
    drawn = trace_task(wall(), wanted(how="straight", distortion=refused), max_pixels=10**6)
    assert np.diff(drawn.points[:, 1], n=2) == pytest.approx(0, abs=1e-4)


def test_errors_name_the_image_or_the_place() -> None:
    with pytest.raises(InvalidImage) as broken:
        trace_task(b"no image", wanted(), max_pixels=10**6)
    assert broken.value.where == "wall"
    with pytest.raises(NoEdge) as nothing:
        trace_task(wall(), wanted(points=np.array([[20.0, 20.0], [280.0, 30.0]])), max_pixels=10**6)
    assert "(20, 20)" in str(nothing.value)


def test_a_worker_that_dies_is_told_of(blobs: LocalBlobs) -> None:
    class Dying(ThreadPoolExecutor):
        def submit(self, *_: Any, **__: Any) -> Future[Any]:
            future: Future[Any] = Future()
            future.set_exception(BrokenProcessPool("killed"))
            return future

    def executors(workers: int) -> Executor:
        return Dying(workers)

    with pytest.raises(Unavailable, match="killed"):
        Tracer(blobs, 10**6, executors=executors).trace(wanted(blobs.put(wall(182))))


def test_who_comes_when_many_wait_is_sent_away_and_what_nobody_waits_for_is_not_begun(
    blobs: LocalBlobs, monkeypatch: pytest.MonkeyPatch
) -> None:
    futures: list[Future[Any]] = []

    class Idle(ThreadPoolExecutor):
        def submit(self, *_: Any, **__: Any) -> Future[Any]:
            futures.append(Future())
            return futures[-1]

    tracer, sha256 = Tracer(blobs, 10**6, executors=Idle), blobs.put(wall(183))
    with ThreadPoolExecutor(tracing.MOST_WAITING) as people:
        waiting = [people.submit(tracer.trace, wanted(sha256)) for _ in range(tracing.MOST_WAITING)]
        while len(futures) < tracing.MOST_WAITING:
            pass
        with pytest.raises(Unavailable, match="other edges"):
            tracer.trace(wanted(sha256))
        for future in futures:
            future.set_result("traced")
        assert {each.result() for each in waiting} == {"traced"}
    monkeypatch.setattr(tracing, "LONGEST_WAIT", 0)
    with pytest.raises(Unavailable, match="long"):
        tracer.trace(wanted(sha256))
    assert futures[-1].cancelled()
