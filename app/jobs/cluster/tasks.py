"""What happens in a cluster's worker around a task, and what the server asks of a worker."""

from __future__ import annotations

import pickle
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import psutil
from distributed import Worker, get_worker

from app.errors import ClearLinesError
from app.jobs.cluster.versions import installed_versions

BEGUN = "clearlines-begun"
"""Topic of the events that say that a worker has begun a task, by its key."""
LEAVING = "clearlines-leaving"
"""Topic of the events that say that a worker is told to stop, by its address."""
MEBIBYTE = 2**20


@dataclass(frozen=True, eq=False)
class Answer:
    """What a task gave.

    Attributes:
        result: Of the task.
        megabytes: Memory that the worker holds after it.
    """

    result: Any
    megabytes: float


def run_task(key: str, call: bytes) -> Answer:
    """Run a task.

    Args:
        key: Of the task; told to whoever listens that it has begun.
        call: What ``packed`` gave.

    Raises:
        Exception: What the task raises.
    """
    get_worker().log_event(BEGUN, {"key": key})
    task, arguments, options = pickle.loads(call)  # noqa: S301  Dask's own messages from that peer are pickled too
    try:
        result = task(*arguments, **options)
    except ClearLinesError as error:
        # Dask pickles what an error came of along with it, which not every library's errors survive
        error.__cause__ = error.__context__ = None
        raise
    return Answer(result, held_megabytes())


def packed(task: Callable[..., Any], arguments: Sequence[Any], options: Mapping[str, Any]) -> bytes:
    """Return a call as bytes: Dask looks for tasks inside whatever it is given, and would walk through every list.

    Args:
        task: A module-level function.
        arguments: By place.
        options: By name.
    """
    return pickle.dumps((task, tuple(arguments), dict(options)), protocol=pickle.HIGHEST_PROTOCOL)


def held_megabytes() -> float:
    """Return the memory that this process holds."""
    return psutil.Process().memory_info().rss / MEBIBYTE


def introduce(dask_worker: Worker) -> dict[str, Any]:
    """Return what the server needs to know of a worker before it gives it work.

    Returns:
        Its ``name``, ``versions``, ``threads``, how many tasks are ``executing``, ``megabytes`` held, and the ``limit``
        at which its nanny ends it.
    """
    limit = dask_worker.memory_manager.memory_limit
    return {
        "name": str(dask_worker.name),
        "versions": installed_versions(),
        "threads": dask_worker.state.nthreads,
        # those too that were cancelled: nobody can stop a thread
        "executing": len(dask_worker.state.all_running_tasks),
        "megabytes": held_megabytes(),
        "limit": None if not limit else limit / MEBIBYTE,
    }
