"""Worker processes: alive as long as whoever made them wants them."""

from __future__ import annotations

import os
import signal
from concurrent.futures import BrokenExecutor, ThreadPoolExecutor

import psutil
import pytest

from app.jobs.executor import BACKGROUND, WorkerPool, end_executor, make_background_executor, make_executor


def test_workers_ignore_ctrl_c_and_end_when_told(eventually) -> None:
    executor = make_executor(1)
    assert isinstance(executor, WorkerPool)
    try:
        worker = executor.submit(os.getpid).result(60)
        assert worker != os.getpid()
        os.kill(worker, signal.SIGINT)
        assert executor.submit(os.getpid).result(60) == worker
    finally:
        end_executor(executor)
        end_executor(executor)
    eventually(lambda: not psutil.pid_exists(worker), "the worker has ended")
    with pytest.raises(RuntimeError):
        executor.submit(os.getpid)


def test_ending_breaks_work_off(eventually) -> None:
    executor = make_executor(1)
    worker = executor.submit(os.getpid).result(60)
    endless = executor.submit(signal.pause)
    eventually(endless.running, "the work runs")
    end_executor(executor)
    assert isinstance(endless.exception(60), BrokenExecutor)
    eventually(lambda: not psutil.pid_exists(worker), "the worker has ended")


@pytest.mark.skipif(not hasattr(os, "nice"), reason="the system knows no niceness")
def test_work_in_the_background_steps_back() -> None:
    executor = make_background_executor(1)
    try:
        assert executor.submit(os.nice, 0).result(60) == min(19, os.nice(0) + BACKGROUND)
    finally:
        end_executor(executor)


def test_other_executors_are_shut_down() -> None:
    executor = ThreadPoolExecutor(1)
    end_executor(executor)
    with pytest.raises(RuntimeError):
        executor.submit(os.getpid)
