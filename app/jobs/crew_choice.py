"""Which workers a server has, by its settings."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import Executor

from app.jobs.cluster.addresses import require_cluster
from app.jobs.crew import Crew, PoolCrew
from app.settings import Settings


def crew_of(settings: Settings, executors: Callable[[int], Executor]) -> Crew:
    """Return the workers of ``settings.cluster``, or processes on this machine; none is started yet.

    Args:
        settings: ``cluster``, ``workers``, ``worker_megabytes``, ``task_seconds``.
        executors: Makes an executor of so many workers on this machine.

    Raises:
        InvalidInput: When the cluster's address can't be read, or what a cluster needs isn't installed.
    """
    if settings.cluster is None:
        workers = settings.workers or os.cpu_count() or 1
        return PoolCrew(workers, executors, settings.data_dir / "notes", megabytes=settings.worker_megabytes)
    require_cluster(settings.cluster)
    from app.jobs.cluster.crew import ClusterCrew

    return ClusterCrew(settings.cluster, megabytes=settings.worker_megabytes, task_seconds=settings.task_seconds)
