"""A task that takes too much is stopped, and its worker goes on."""

from __future__ import annotations

import importlib
import io
import signal
import sys
import time
import zipfile
from collections.abc import Iterator
from concurrent.futures import BrokenExecutor, Executor, Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import psutil
import pytest

from app.errors import Unavailable
from app.formats.submission_files import ExpectedImage
from app.formats.submission_limits import SubmissionLimits
from app.formats.submission_problems import InvalidSubmission
from app.jobs.executor import end_executor, make_executor
from app.jobs.limits import TaskLimits, TookTooLong, bounded
from app.jobs.scoring_tasks import Validated
from app.jobs.validations import Validations

IMAGES = [ExpectedImage("a", 100, 100)]


@pytest.fixture
def worker(monkeypatch: pytest.MonkeyPatch) -> Iterator[Executor]:
    monkeypatch.syspath_prepend(str(Path(__file__).parent))
    executor = make_executor(1)
    yield executor
    end_executor(executor)


def task(name: str) -> Any:
    return getattr(importlib.import_module("bounded_tasks"), name)


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="memory is bounded on Linux only")
def test_memory_and_time_are_bounded_and_the_worker_goes_on(worker: Executor) -> None:
    with pytest.raises(MemoryError):
        worker.submit(task("take_memory"), 600, 300).result()
    assert worker.submit(task("take_memory"), 200, 300).result() == 200
    with pytest.raises(TookTooLong, match=r"counting took longer than 0\.2 s"):
        worker.submit(task("take_time"), 60.0, 0.2).result()
    assert worker.submit(task("take_time"), 0.3, 60.0).result() == "in time"


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="there are no alarms here")
def test_time_is_bounded_in_a_thread_that_can_have_no_alarm() -> None:
    def count(seconds: float, bound: float) -> str:
        with bounded(TaskLimits(bound, 4096), "counting"):
            end = time.monotonic() + seconds
            while time.monotonic() < end:
                pass
        return "in time"

    with ThreadPoolExecutor(1) as threads:
        with pytest.raises(TookTooLong, match=r"counting took longer than 0\.2 s"):
            threads.submit(count, 60.0, 0.2).result(60)
        assert threads.submit(count, 0.1, 60.0).result(60) == "in time"


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="there are no alarms here")
def test_a_task_that_never_comes_back_is_ended_with_its_process(worker: Executor) -> None:
    with pytest.raises(BrokenExecutor):
        worker.submit(task("never_come_back")).result(60)


def upload() -> bytes:
    stream, npz = io.BytesIO(), io.BytesIO()
    np.savez(npz, points=np.array([[1.0, 2], [50, 60]]), offsets=np.array([0, 2]))
    with zipfile.ZipFile(stream, "w") as archive:
        archive.writestr("a.npz", npz.getvalue())
    return stream.getvalue()


def test_checks_go_on_after_their_worker_was_killed() -> None:
    before = set(psutil.Process().children())
    validations = Validations(SubmissionLimits(), TaskLimits(), 60.0)

    def checked() -> Validated | None:
        try:
            return validations.validate(upload(), "a.zip", IMAGES)
        except Unavailable:
            return None

    try:
        assert (found := checked()) is not None
        assert (found.segments, found.images) == (1, 1)
        with pytest.raises(InvalidSubmission):
            validations.validate(b"rubbish", "a.zip", IMAGES)
        workers = [
            child
            for child in psutil.Process().children()
            if child not in before and "spawn_main" in " ".join(child.cmdline())
        ]
        for child in workers:
            child.kill()
        assert workers
        deadline = time.monotonic() + 60
        while checked() is None:
            assert time.monotonic() < deadline
    finally:
        validations.stop()


class Idle(Executor):
    """An executor that never begins anything."""

    def __init__(self) -> None:
        self.futures: list[Future[Any]] = []

    def submit(self, *arguments: Any, **named: Any) -> Future[Any]:
        del arguments, named
        self.futures.append(Future())
        return self.futures[-1]


def test_a_check_whose_sender_waited_too_long_is_not_kept() -> None:
    idle = Idle()
    validations = Validations(SubmissionLimits(), TaskLimits(), 0.01, executors=lambda workers: idle)
    for _ in range(3):
        with pytest.raises(Unavailable, match="takes long"):
            validations.validate(b"", "a.zip", [])
    assert [future.cancelled() for future in idle.futures] == [True] * 3
