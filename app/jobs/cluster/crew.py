"""The workers of a cluster behind the same seam as those of a pool."""

from __future__ import annotations

import asyncio
import threading
import uuid
from collections.abc import Callable, Sequence
from concurrent.futures import Executor, Future
from typing import Any

import dask.config

from app.jobs.cluster.connection import RECONNECT_PAUSE, Connection
from app.jobs.cluster.members import Order
from app.jobs.cluster.notes import ClusterNotes
from app.jobs.cluster.tasks import packed
from app.jobs.cluster.workforce import BEGIN_SECONDS
from app.jobs.crew_status import CrewStatus

STOP_SECONDS = 20.0


class ClusterCrew(Executor):
    """The workers of a Dask scheduler; the executor is the crew itself.

    Args:
        address: Of the scheduler, ``tcp://HOST:PORT`` or ``tls://HOST:PORT``.
        megabytes: A worker that holds more after a task is replaced.
        task_seconds: A worker that is busy with somebody else's work for so long is restarted.
        pause: Seconds between two attempts to reach the scheduler.
        begin_seconds: A worker that hasn't begun a task for so long is asked why.
    """

    shares_fate = False

    def __init__(
        self,
        address: str,
        *,
        megabytes: int | None,
        task_seconds: float,
        pause: float = RECONNECT_PAUSE,
        begin_seconds: float = BEGIN_SECONDS,
    ) -> None:
        self._name = uuid.uuid4().hex
        self._on_change: Callable[[], None] = lambda: None
        self._connection = Connection(
            address,
            megabytes=megabytes,
            task_seconds=task_seconds,
            on_change=lambda: self._on_change(),
            pause=pause,
            begin_seconds=begin_seconds,
        )
        self._loop: asyncio.AbstractEventLoop | None = None
        self._stop: asyncio.Event | None = None
        self._thread: threading.Thread | None = None

    @property
    def size(self) -> int:
        """See ``Crew``."""
        return sum(worker.accepted for worker in self._connection.status.workers)

    @property
    def reachable(self) -> bool:
        """See ``Crew``."""
        return self._connection.status.reachable

    @property
    def notes(self) -> ClusterCrew:
        """See ``Crew``."""
        return self

    def of(self, name: str) -> ClusterNotes:
        """See ``NoteBoard``; another server on the same cluster may have a calibration of the same number."""
        return ClusterNotes(f"{self._name}-{name}", self._connection.workforce.progress, self._broadcast)

    def start(self, on_change: Callable[[], None]) -> None:
        """See ``Crew``."""
        if self._thread is None:
            self._on_change = on_change
            self._loop, self._stop = asyncio.new_event_loop(), asyncio.Event()
            self._thread = threading.Thread(
                target=self._run, args=(self._loop, self._stop), name="cluster", daemon=True
            )
            self._thread.start()

    def executor(self) -> Executor:
        """See ``Crew``."""
        return self

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Send a task to a worker that has nothing to do, or as soon as one hasn't.

        Returns:
            A future that fails with ``WorkerDied`` or ``WorkerLeft`` where the worker is gone before it answers.
        """
        order = Order(f"clearlines-{uuid.uuid4().hex}", packed(fn, args, kwargs))
        self._call(self._connection.workforce.take, order)
        return order.future

    def executing(self, futures: Sequence[Future[Any]]) -> Sequence[Future[Any]]:
        """See ``Crew``."""
        return [future for future in futures if future.running()]

    def end_hung(self, future: Future[Any]) -> None:
        """See ``Crew``."""
        self._call(self._connection.workforce.end_hung, future)

    def outgrown(self) -> bool:
        """See ``Crew``: such a worker is replaced by itself, without the others."""
        return False

    def dismiss(self) -> None:
        """See ``Crew``; workers end what they have begun, and nobody hears of it."""
        if self._loop is not None:
            self._call(self._connection.workforce.dismiss)

    def stop(self) -> None:
        """See ``Crew``."""
        if self._thread is not None and self._stop is not None:
            self.dismiss()
            self._call(self._stop.set)
            self._thread.join(STOP_SECONDS)
            self._thread = self._loop = self._stop = None

    def status(self) -> CrewStatus:
        """See ``Crew``."""
        return self._connection.status

    def _broadcast(self, function: Callable[..., None], name: str) -> None:
        self._call(self._connection.workforce.broadcast, function, name)

    def _call(self, function: Callable[..., None], *arguments: Any) -> None:
        if self._loop is None:
            raise RuntimeError("the crew isn't started")
        self._loop.call_soon_threadsafe(function, *arguments)

    def _run(self, loop: asyncio.AbstractEventLoop, stop: asyncio.Event) -> None:
        asyncio.set_event_loop(loop)
        # a task carries its image's file along, however large, and that is meant
        with dask.config.set({"distributed.admin.large-graph-warning-threshold": "1TB"}):
            try:
                loop.run_until_complete(self._connection.stay(stop))
            finally:
                loop.close()
