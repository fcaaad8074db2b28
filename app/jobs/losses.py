"""Why work came back from a worker without an answer. Each is a ``BrokenExecutor``, as is a pool that broke."""

from __future__ import annotations

from concurrent.futures import BrokenExecutor


class WorkerLeft(BrokenExecutor):
    """The worker was told to leave, or is out of reach; the work had no part in that, and isn't charged."""


class WorkerDied(BrokenExecutor):
    """The worker died while it did this work and nothing else: the work is charged."""
