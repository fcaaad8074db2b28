"""Work in the dispatcher's hand: waiting for a worker, running in one, or suspected of having killed one.

A worker that is killed breaks its whole pool, and nobody can tell which work did it. So whatever was in flight becomes
suspect and runs again one at a time in a new pool. Only work that kills its worker while alone is the culprit.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Executor, Future
from typing import Any

from app.jobs.executor import end_executor
from app.jobs.work import Work

IN_FLIGHT_PER_WORKER = 2  # one being worked on, one waiting beside it


class Flight:
    """Work in hand and the executor it runs in; used by one thread.

    Args:
        workers: Number of processes.
        executors: Makes an executor of so many workers; called again when a pool broke.
        on_arrival: Called, from any thread, when a result has come.
    """

    def __init__(self, workers: int, executors: Callable[[int], Executor], on_arrival: Callable[[], None]) -> None:
        self._workers = workers
        self._executors = executors
        self._on_arrival = on_arrival
        self._executor: Executor | None = None
        self._waiting: deque[Work] = deque()
        self._suspects: deque[Work] = deque()
        self._running: dict[Future[Any], Work] = {}

    @property
    def work(self) -> list[Work]:
        """All work in hand."""
        return [*self._running.values(), *self._waiting, *self._suspects]

    @property
    def room(self) -> int:
        """How much more work may be taken in hand; none while there are suspects."""
        return 0 if self._suspects else max(self.places - len(self.work), 0)

    @property
    def places(self) -> int:
        """How much work may be in hand at once."""
        return IN_FLIGHT_PER_WORKER * self._workers

    def add(self, work: Work, *, suspect: bool = False) -> None:
        """Take work in hand; a suspect runs alone."""
        (self._suspects if suspect else self._waiting).append(work)

    def next(self) -> Work | None:
        """Return the work to be sent next, if any may be."""
        if self._suspects:
            return None if self._running else self._suspects[0]
        return self._waiting[0] if self._waiting else None

    def send(self, work: Work, begin: Callable[[Executor], Future[Any]]) -> None:
        """Send the next work to a worker.

        Args:
            work: What ``next`` gave; it stays next when ``begin`` fails.
            begin: Submits it.

        Raises:
            BrokenExecutor: When the pool broke while it had nothing to do; the next call makes another one.
        """
        self._executor = self._executor or self._executors(self._workers)
        try:
            future = begin(self._executor)
        except BrokenExecutor:
            if not self._running:
                self._end_executor()
            raise
        self.drop(work)
        self._running[future] = work
        future.add_done_callback(lambda _: self._on_arrival())

    def arrived(self) -> list[tuple[Future[Any], Work]]:
        """Return what workers have answered; each stays in hand until it is dropped."""
        return [(future, work) for future, work in self._running.items() if future.done() and not _is_lost(future)]

    def drop(self, work: Work) -> None:
        """Let go of work."""
        for queue in (self._waiting, self._suspects):
            if work in queue:
                queue.remove(work)
        self._running = {future: other for future, other in self._running.items() if other is not work}

    def replace(self, suspect: Work, by: Work) -> None:
        """Let another attempt take the place of a suspect."""
        self._suspects[self._suspects.index(suspect)] = by

    def recover(self) -> Work | None:
        """Suspect all work of a pool that broke; return the culprit if it was alone. It stays among the suspects."""
        if not any(future.done() and _is_lost(future) for future in self._running):
            return None
        self._end_executor()
        lost = {future: work for future, work in self._running.items() if not future.done() or _is_lost(future)}
        for future, work in lost.items():
            self._suspects.append(work)
            del self._running[future]
        return self._suspects[-1] if len(lost) == 1 else None

    def clear(self) -> None:
        """Let go of everything and end the workers."""
        self._end_executor()
        self._running.clear()
        self._waiting.clear()
        self._suspects.clear()

    def _end_executor(self) -> None:
        if self._executor is not None:
            end_executor(self._executor)
            self._executor = None


def _is_lost(future: Future[Any]) -> bool:
    return future.cancelled() or isinstance(future.exception(), BrokenExecutor)
