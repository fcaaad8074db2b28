"""Tasks that take more than they may."""

from __future__ import annotations

import signal
import time

import numpy as np

from app.jobs.limits import TaskLimits, bounded


def take_memory(megabytes: int, limit: int) -> int:
    """Take so much memory under a limit, and return how much was taken."""
    with bounded(TaskLimits(60, limit), "taking memory"):
        return int(np.ones(megabytes * 2**20, np.uint8).sum() // 2**20)


def take_time(seconds: float, limit: float) -> str:
    """Take so long under a limit."""
    with bounded(TaskLimits(limit, 512), "counting"):
        until = time.monotonic() + seconds
        while time.monotonic() < until:
            pass
    return "in time"


def never_come_back() -> None:
    """As code does that never returns to Python: no alarm reaches it."""
    with bounded(TaskLimits(0.1, 512, grace=0.2), "nothing"):
        signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGALRM])
        time.sleep(600)
