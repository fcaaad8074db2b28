"""How long work may take before it is taken for hung."""

from __future__ import annotations

from typing import Any

from app.errors import ClearLinesError
from app.jobs.calibration_tasks import LIMITS
from app.jobs.calibration_work import CalibrationWork
from app.jobs.scoring_steps import SUBMISSION_WORK
from app.jobs.stores import Stores
from app.jobs.work import Work

TIMES_GRACE = 2
"""Where a task bounds itself it has so many times its grace beside that before its worker is ended from outside."""


def longest_seconds(work: Work, stores: Stores, task_seconds: float) -> float:
    """Return how many seconds work may take.

    Args:
        work: The work.
        stores: What bounds tasks of submissions.
        task_seconds: The least bound; work whose task bounds itself may take as long as that bound, and a little more.
    """
    if isinstance(work, CalibrationWork):
        return max(task_seconds, LIMITS.seconds + TIMES_GRACE * LIMITS.grace)
    if isinstance(work, SUBMISSION_WORK):
        limits = stores.task_limits
        return max(task_seconds, limits.seconds + TIMES_GRACE * limits.grace)
    return task_seconds


def hung_worker_error(attempts: int, seconds: float) -> dict[str, Any]:
    """Return the reason of work that was taken for hung too often."""
    times = "time" if attempts == 1 else "times"
    return ClearLinesError(
        f"it took longer than {seconds:g} s, {attempts} {times}",
        hint="is the image far larger than the others? CLEARLINES_TASK_SECONDS says how long it may take",
    ).as_dict() | {"code": "worker-hung"}
