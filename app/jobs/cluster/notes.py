"""Notes between a dispatcher and the worker of a long task, over a cluster: they travel as Dask's own messages.

Progress is an event that the worker logs and the dispatcher has subscribed to. That a task is called off is told to all
workers, each of which remembers it: a worker of the cluster is one process with one task at a time.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from distributed import Worker, WorkerPlugin, get_worker

PROGRESS = "clearlines-progress"
"""Topic of the events that say how far a task is."""
PLUGIN = "clearlines-called-off"


class CalledOff(WorkerPlugin):
    """What a worker remembers: the names of what was called off; a few bytes each, until it ends."""

    name = PLUGIN

    def __init__(self) -> None:
        self.names: set[str] = set()


@dataclass(frozen=True)
class ClusterWorkerNotes:
    """What a cluster's worker sees of the notes of its task.

    Attributes:
        name: Of the attempt.
    """

    name: str

    def note(self, stage: str, done: int, total: int) -> None:
        """See ``WorkerNotes``."""
        get_worker().log_event(PROGRESS, {"name": self.name, "stage": stage, "done": done, "total": total})

    def is_called_off(self) -> bool:
        """See ``WorkerNotes``."""
        plugin = get_worker().plugins.get(PLUGIN)
        return isinstance(plugin, CalledOff) and self.name in plugin.names


@dataclass(frozen=True)
class ClusterNotes:
    """What the dispatcher sees of them.

    Attributes:
        name: Of the attempt.
        known: Progress by name; kept up to date by whoever hears the events.
        broadcast: Calls a function of ``call_off`` 's kind in all workers.
    """

    name: str
    known: dict[str, dict[str, Any]] = field(repr=False)
    broadcast: Callable[[Callable[..., None], str], None] = field(repr=False)

    def for_worker(self) -> ClusterWorkerNotes:
        """See ``Notes``."""
        return ClusterWorkerNotes(self.name)

    def prepare(self) -> None:
        """See ``Notes``."""
        self.known[self.name] = {}

    def progress(self) -> dict[str, Any] | None:
        """See ``Notes``."""
        return self.known.get(self.name) or None

    def call_off(self) -> None:
        """See ``Notes``."""
        self.broadcast(call_off, self.name)

    def discard(self) -> None:
        """See ``Notes``."""
        self.known.pop(self.name, None)


def call_off(name: str, dask_worker: Worker) -> None:
    """Remember in a worker that a task was called off."""
    plugin = dask_worker.plugins.get(PLUGIN)
    if isinstance(plugin, CalledOff):
        plugin.names.add(name)
