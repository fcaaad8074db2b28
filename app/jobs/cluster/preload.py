"""What Dask runs in a worker process before its first task; it looks for ``dask_setup`` by name."""

from __future__ import annotations

import cv2
from distributed import Worker

from app.jobs.cluster.notes import CalledOff


async def dask_setup(worker: Worker) -> None:
    """Make a worker what the dispatcher expects: one core's work, and a memory of what was called off."""
    # one process per core is enough: threads inside would only fight for them
    cv2.setNumThreads(1)
    await worker.plugin_add(CalledOff(), name=CalledOff.name, catch_errors=False)
