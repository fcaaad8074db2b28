"""How candidates were found, by a worker on request."""

from __future__ import annotations

import importlib
import os
import signal
import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import psutil
import pytest
from sqlalchemy import select

from app.db.models import Segment
from app.errors import InvalidImage, NoHistory, NotFound, Unavailable
from app.jobs import histories as module
from app.jobs.executor import WorkerPool, make_executor
from app.jobs.histories import MOST_IMAGES, Histories
from app.jobs.tasks import ImageHistory, history_task
from app.services.segment_history import Found, detection_behind
from app.storage import LocalBlobs

MAX_PIXELS = 1_000_000


class Counting:
    """Stands before the real task and notes for which image it was asked; may hold it up."""

    def __init__(self) -> None:
        self.names: list[str] = []
        self.gate = threading.Event()
        self.gate.set()

    def __call__(self, content: bytes, name: str, parameters: dict[str, Any], **options: Any) -> ImageHistory:
        self.names.append(name)
        assert self.gate.wait(60)
        return history_task(content, name, parameters, **options)


class SlowBlobs(LocalBlobs):
    """Blobs whose reading may be held up."""

    def __init__(self, root: Path) -> None:
        super().__init__(root)
        self.gate, self.reading = threading.Event(), threading.Event()
        self.gate.set()

    def read(self, sha256: str) -> bytes:
        self.reading.set()
        assert self.gate.wait(60)
        return super().read(sha256)


@pytest.fixture
def counting() -> Counting:
    return Counting()


@pytest.fixture
def in_thread(small_yard, counting: Counting) -> Iterator[Histories]:
    """Histories whose worker is a thread of this process."""
    histories = Histories(small_yard.blobs, MAX_PIXELS, executors=ThreadPoolExecutor, task=counting)
    yield histories
    counting.gate.set()
    histories.stop()


def prelabelled(yard, *names: str) -> list[Found]:
    """Pre-label new images; return their candidates."""
    yard.add(*names)
    yard.start()
    yard.dispatcher(executors=ThreadPoolExecutor).run_until_idle()
    with yard.database.read() as session:
        return [detection_behind(session, each) for each in session.scalars(select(Segment.id).order_by(Segment.id))]


def one_of_each(candidates: list[Found]) -> list[Found]:
    """One candidate of each image, in the order the images were added, whichever worker was done first."""
    return [each for _, each in sorted({each.image_id: each for each in candidates}.items())]


def test_every_candidate_of_a_run_has_a_history(small_yard) -> None:
    candidates = prelabelled(small_yard, "a", "b")
    histories = Histories(small_yard.blobs, MAX_PIXELS)
    try:
        for found in candidates:
            told = histories.tell(found)
            points = np.frombuffer(found.points, "<f4").reshape(-1, 2)
            assert (told.segment_id, told.image_id) == (found.segment_id, found.image_id)
            assert len(told.pieces) == len(told.joins) + 1
            assert min(np.hypot(*(points - told.pieces[0].start).T)) < 3
            assert min(np.hypot(*(points - told.pieces[-1].end).T)) < 3
            evidence = told.intercept + sum(part.weight * part.value for part in told.score_parts)
            assert told.score == pytest.approx(1 / (1 + np.exp(-evidence)))
        assert len({found.image_id for found in candidates}) == 2
    finally:
        histories.stop()


def test_an_image_is_looked_into_once(small_yard, in_thread: Histories, counting: Counting) -> None:
    candidates = prelabelled(small_yard, "a")
    assert len(candidates) > 1
    assert [in_thread.tell(found).segment_id for found in candidates] == [found.segment_id for found in candidates]
    assert counting.names == ["a"]
    # with other parameters it is another detection
    in_thread.tell(replace(candidates[0], parameters={**candidates[0].parameters, "operating_point": "recall"}))
    assert counting.names == ["a", "a"]


def test_those_who_ask_at_once_share_one_detection(small_yard, in_thread: Histories, counting: Counting) -> None:
    candidates = prelabelled(small_yard, "a")[:4]
    counting.gate.clear()
    with ThreadPoolExecutor(len(candidates)) as askers:
        answers = [askers.submit(in_thread.tell, found) for found in candidates]
        counting.gate.set()
        assert [answer.result(60).segment_id for answer in answers] == [found.segment_id for found in candidates]
    assert counting.names == ["a"]


def test_what_is_known_is_told_while_another_image_is_read(small_yard, counting: Counting) -> None:
    known, other = one_of_each(prelabelled(small_yard, "a", "b"))
    blobs = SlowBlobs(small_yard.blobs.root)
    histories = Histories(blobs, MAX_PIXELS, executors=ThreadPoolExecutor, task=counting)
    with ThreadPoolExecutor(1) as askers:
        histories.tell(known)
        blobs.gate.clear()
        blobs.reading.clear()
        answer = askers.submit(histories.tell, other)
        try:
            assert blobs.reading.wait(60)
            assert histories.tell(known).segment_id == known.segment_id
            assert not answer.done()
        finally:
            blobs.gate.set()
        assert answer.result(60).segment_id == other.segment_id
    histories.stop()


def test_the_oldest_image_is_forgotten(small_yard, in_thread: Histories, counting: Counting) -> None:
    names = [f"image-{number}" for number in range(MOST_IMAGES + 1)]
    candidates = one_of_each(prelabelled(small_yard, *names))
    for found in candidates:
        in_thread.tell(found)
    in_thread.tell(candidates[-1])
    assert counting.names == names
    in_thread.tell(candidates[0])
    assert counting.names == [*names, names[0]]


def test_too_much_at_once_is_refused(small_yard, in_thread: Histories, counting: Counting, eventually) -> None:
    candidates = one_of_each(prelabelled(small_yard, *(f"image-{number}" for number in range(MOST_IMAGES + 1))))
    counting.gate.clear()
    with ThreadPoolExecutor(MOST_IMAGES) as askers:
        answers = [askers.submit(in_thread.tell, found) for found in candidates[:MOST_IMAGES]]

        def refused() -> bool:
            try:
                in_thread._begin(candidates[MOST_IMAGES])
            except Unavailable:
                return True
            return False

        eventually(lambda: len(in_thread._latest) == MOST_IMAGES, "all are under way")
        assert refused()
        counting.gate.set()
        for answer in answers:
            answer.result(60)
    assert in_thread.tell(candidates[MOST_IMAGES]).segment_id == candidates[MOST_IMAGES].segment_id


def test_other_points_mean_another_version(small_yard, in_thread: Histories) -> None:
    found = prelabelled(small_yard, "a")[0]
    moved = np.frombuffer(found.points, "<f4").copy()
    moved[0] = np.nextafter(moved[0], np.float32(np.inf))
    with pytest.raises(NoHistory) as caught:
        in_thread.tell(replace(found, points=moved.tobytes()))
    assert (caught.value.status, caught.value.code) == (404, "no-history")
    assert caught.value.details == {"run_id": found.run_id, "code_version": found.code_version}


def test_a_broken_image_says_so_each_time_and_a_missing_one_too(small_yard, in_thread: Histories) -> None:
    found = prelabelled(small_yard, "a")[0]
    broken = replace(found, sha256=small_yard.blobs.put(b"no image"))
    for _ in range(2):
        with pytest.raises(InvalidImage):
            in_thread.tell(broken)
    with pytest.raises(NotFound):
        in_thread.tell(replace(found, sha256="0" * 64))
    assert in_thread.tell(found).segment_id == found.segment_id


def test_a_killed_worker_is_replaced(small_yard) -> None:
    found = prelabelled(small_yard, "a")[0]
    deadly = importlib.import_module("gated_tasks").deadly_history
    histories = Histories(small_yard.blobs, MAX_PIXELS, task=deadly)
    try:
        with pytest.raises(Unavailable, match="killed") as caught:
            histories.tell(replace(found, image_name="deadly", parameters={**found.parameters, "sigma": 0.6}))
        assert caught.value.hint
        assert histories.tell(found).segment_id == found.segment_id
    finally:
        histories.stop()


def test_a_worker_that_dies_while_idle_is_replaced(small_yard, eventually) -> None:
    pools: list[WorkerPool] = []

    def executors(workers: int) -> WorkerPool:
        pool = make_executor(workers)
        assert isinstance(pool, WorkerPool)
        pools.append(pool)
        return pool

    first, second = one_of_each(prelabelled(small_yard, "a", "b"))
    histories = Histories(small_yard.blobs, MAX_PIXELS, executors=executors)
    try:
        histories.tell(first)
        worker = pools[0].submit(os.getpid).result(60)
        os.kill(worker, signal.SIGKILL)
        eventually(lambda: not psutil.pid_exists(worker), "the worker is gone")
        assert histories.tell(first).segment_id == first.segment_id
        eventually(lambda: tells(histories, second), "another worker does it")
        assert len(pools) == 2
    finally:
        histories.stop()


def tells(histories: Histories, found: Found) -> bool:
    """Whether the worker answers; one that is just being missed doesn't."""
    try:
        return histories.tell(found).segment_id == found.segment_id
    except Unavailable:
        return False


def test_what_takes_too_long_is_worked_on_all_the_same(
    small_yard, in_thread: Histories, counting: Counting, monkeypatch, eventually
) -> None:
    found = prelabelled(small_yard, "a")[0]
    monkeypatch.setattr(module, "LONGEST_WAIT", 0.01)
    counting.gate.clear()
    with pytest.raises(Unavailable, match="long"):
        in_thread.tell(found)
    counting.gate.set()
    eventually(lambda: in_thread._latest and all(each.done() for each in in_thread._latest.values()), "it is done")
    assert in_thread.tell(found).segment_id == found.segment_id
    assert counting.names == ["a"]
