"""Work in the dispatcher's hand: waiting for a worker, running in one, or suspected of having killed one.

Where a worker that is killed takes the others along, as in a pool, nobody can tell which work did it. So whatever was
in flight becomes suspect and runs again one at a time in new workers. Only work that kills its worker while alone is
the culprit. On a cluster a worker has one piece of work and dies alone: its work is the culprit at once.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Executor, Future
from typing import Any

from app.jobs.crew import Crew
from app.jobs.losses import WorkerDied, WorkerLeft
from app.jobs.work import Work

IN_FLIGHT_PER_WORKER = 2  # one being worked on, one waiting beside it


class Flight:
    """Work in hand and those who do it; used by one thread, but for ``counts``.

    Args:
        crew: The workers.
        on_arrival: Called, from any thread, when a result has come.
    """

    def __init__(self, crew: Crew, on_arrival: Callable[[], None]) -> None:
        self._crew = crew
        self._on_arrival = on_arrival
        self._waiting: deque[Work] = deque()
        self._suspects: deque[Work] = deque()
        self._running: dict[Future[Any], Work] = {}
        self._begun: dict[Future[Any], float] = {}

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
        return IN_FLIGHT_PER_WORKER * self._crew.size

    def counts(self) -> tuple[int, int]:
        """Return how much is running, and how much is in hand beside that; from any thread."""
        return len(self._running), len(self._waiting) + len(self._suspects)

    def add(self, work: Work, *, suspect: bool = False) -> None:
        """Take work in hand; a suspect runs alone, unless each worker does so anyway."""
        (self._suspects if suspect and self._crew.shares_fate else self._waiting).append(work)

    def next(self) -> Work | None:
        """Return the work to be sent next, if any may be."""
        if self._running and self._crew.outgrown():
            return None
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
        if not self._running and self._crew.outgrown():
            self._crew.dismiss()
        try:
            future = begin(self._crew.executor())
        except BrokenExecutor:
            if not self._running:
                self._crew.dismiss()
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

    def replace(self, culprit: Work, by: Work) -> None:
        """Let another attempt take the place of a culprit."""
        for queue in (self._waiting, self._suspects):
            if culprit in queue:
                queue[queue.index(culprit)] = by

    def end_hung(self, now: float, longest: Callable[[Work], float]) -> list[Work]:
        """End the workers of work that takes longer than it may.

        Args:
            now: Seconds of any clock that doesn't jump.
            longest: How many seconds a piece of work may take.

        Returns:
            That work; it stays in hand, to be charged. Work that was ended along with it waits again.
        """
        running = [future for future in self._running if not future.done()]
        executing = self._crew.executing(running)
        self._begun = {future: self._begun.get(future, now) for future in executing}
        hung = [future for future in executing if now - self._begun[future] > longest(self._running[future])]
        culprits = [self._running[future] for future in hung]
        for future in hung:
            self._crew.end_hung(future)
        if hung and self._crew.shares_fate:  # all were ended, and it is known whose fault that is
            hung = running
        for future in hung:
            self._queue_again(future)
        return culprits

    def recover(self) -> list[Work]:
        """Take back the work of workers that are gone.

        Returns:
            What killed its worker for certain; it stays in hand, to be charged. What may have is suspect from now on.
        """
        culprits: list[Work] = []
        for future, error in [(future, _loss_of(future)) for future in self._running]:
            if isinstance(error, WorkerDied):
                culprits.append(self._queue_again(future))
            elif isinstance(error, WorkerLeft):
                self._queue_again(future)
        if any(_is_lost(future) for future in self._running):
            culprits += self._suspect_all()
        return culprits

    def release(self) -> list[Work]:
        """Let go of everything, and return it; the workers stay."""
        left = self.work
        self._crew.dismiss()
        self._running.clear()
        self._waiting.clear()
        self._suspects.clear()
        self._begun.clear()
        return left

    def _suspect_all(self) -> list[Work]:
        """Suspect all work of a pool that broke; return the culprit if it was alone."""
        self._crew.dismiss()
        lost = {future: work for future, work in self._running.items() if not future.done() or _is_lost(future)}
        for future, work in lost.items():
            self._suspects.append(work)
            del self._running[future]
        return [self._suspects[-1]] if len(lost) == 1 else []

    def _queue_again(self, future: Future[Any]) -> Work:
        work = self._running.pop(future)
        self._waiting.appendleft(work)
        return work


def _loss_of(future: Future[Any]) -> BaseException | None:
    return future.exception() if future.done() and not future.cancelled() else None


def _is_lost(future: Future[Any]) -> bool:
    return future.done() and (future.cancelled() or isinstance(future.exception(), BrokenExecutor))
