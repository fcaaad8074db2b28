"""Those who do the work: worker processes on this machine, or those of a cluster."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Executor, Future
from pathlib import Path
from typing import Any, Protocol

from app.jobs.crew_status import CrewStatus, WorkerStatus
from app.jobs.executor import WorkerPool, end_executor
from app.jobs.notes import NoteBoard, NoteFolder


class Crew(Protocol):
    """Workers behind an executor; all but ``status`` and ``on_change`` is used by one thread."""

    @property
    def size(self) -> int:
        """How many can work now."""
        ...

    @property
    def reachable(self) -> bool:
        """Whether work can be sent."""
        ...

    @property
    def shares_fate(self) -> bool:
        """Whether a worker that dies takes the others along, so that nobody can tell whose work did it."""
        ...

    @property
    def notes(self) -> NoteBoard:
        """Notes between the dispatcher and the worker of a long task."""
        ...

    def start(self, on_change: Callable[[], None]) -> None:
        """Begin to look for workers.

        Args:
            on_change: Called, from any thread, when there are more or fewer.
        """
        ...

    def executor(self) -> Executor:
        """Return what work is submitted to; another one after it broke."""
        ...

    def executing(self, futures: Sequence[Future[Any]]) -> Sequence[Future[Any]]:
        """Return those that a worker has begun, of all futures that aren't done, in the order of submission."""
        ...

    def end_hung(self, future: Future[Any]) -> None:
        """End the worker that has this, whatever becomes of the future."""
        ...

    def outgrown(self) -> bool:
        """Whether workers hold more memory than they may, and end when they have nothing to do."""
        ...

    def dismiss(self) -> None:
        """Let go of all work at once; ``executor`` makes workers again."""
        ...

    def stop(self) -> None:
        """Let go of all work and workers."""
        ...

    def status(self) -> CrewStatus:
        """Return what is known of the workers; from any thread."""
        ...


class PoolCrew:
    """Processes on this machine.

    Args:
        workers: How many.
        executors: Makes an executor of so many workers; called again when one broke.
        notes: Folder of the notes.
        megabytes: A pool is replaced once a worker holds more; Linux alone tells.
    """

    shares_fate = True
    reachable = True

    def __init__(
        self, workers: int, executors: Callable[[int], Executor], notes: Path, *, megabytes: int | None = None
    ) -> None:
        self.size = workers
        self.notes: NoteBoard = NoteFolder(notes)
        self._executors = executors
        self._megabytes = megabytes
        self._executor: Executor | None = None

    def start(self, on_change: Callable[[], None]) -> None:
        """Nothing to do: processes are started when there is work."""

    def executor(self) -> Executor:
        """See ``Crew``."""
        self._executor = self._executor or self._executors(self.size)
        return self._executor

    def executing(self, futures: Sequence[Future[Any]]) -> Sequence[Future[Any]]:
        """See ``Crew``: the oldest, as a pool works first come, first served."""
        return futures[: self.size]

    def end_hung(self, future: Future[Any]) -> None:
        """End all workers: a pool doesn't tell which one has it."""
        if not future.done():
            self.dismiss()

    def outgrown(self) -> bool:
        """See ``Crew``."""
        if self._megabytes is None or not isinstance(self._executor, WorkerPool):
            return False
        return any((held or 0.0) > self._megabytes for held in self._executor.megabytes().values())

    def dismiss(self) -> None:
        """See ``Crew``."""
        if self._executor is not None:
            end_executor(self._executor)
            self._executor = None

    def stop(self) -> None:
        """See ``Crew``."""
        self.dismiss()

    def status(self) -> CrewStatus:
        """See ``Crew``."""
        executor = self._executor
        held = executor.megabytes() if isinstance(executor, WorkerPool) else {}
        workers = [
            WorkerStatus(f"worker {place}", str(process_id), True, None, megabytes, False)
            for place, (process_id, megabytes) in enumerate(held.items(), start=1)
        ]
        return CrewStatus("pool", None, True, None, tuple(workers))
