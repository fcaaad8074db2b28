"""A worker beside those of the runs, for what somebody waits for: nobody waits behind a thousand images."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Executor, Future
from threading import Lock
from typing import TypeVar

from app.jobs.executor import end_executor, make_executor

Result = TypeVar("Result")


class OnDemandWorker:
    """One worker, started when it is first needed and again after it died. Safe to use from several threads.

    Args:
        executors: Makes an executor of so many workers; called again when one broke.
    """

    def __init__(self, executors: Callable[[int], Executor] = make_executor) -> None:
        self._executors = executors
        self._executor: Executor | None = None
        self._lock = Lock()

    def submit(self, task: Callable[..., Result], *arguments: object, **options: object) -> Future[Result]:
        """Have the worker do something."""
        with self._lock:
            try:
                return self._running().submit(task, *arguments, **options)
            except BrokenExecutor:  # it died while it had nothing to do
                self._end()
                return self._running().submit(task, *arguments, **options)

    def stop(self) -> None:
        """End the worker at once; whoever waits is told that it was killed."""
        with self._lock:
            self._end()

    def _running(self) -> Executor:
        self._executor = self._executor or self._executors(1)
        return self._executor

    def _end(self) -> None:
        if self._executor is not None:
            end_executor(self._executor)
            self._executor = None
