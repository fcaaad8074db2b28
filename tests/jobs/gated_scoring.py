"""Scoring tasks that misbehave in a worker process, by the name of the first image they are given."""

from __future__ import annotations

import os
import signal
import time
from pathlib import Path
from typing import Any

from app.jobs.scoring_tasks import score_task, validate_task


def gated_score(images: Any, *rest: Any) -> Any:
    """Parts that begin with an image named ``held...`` say which process works on them and wait for the gate."""
    gate, name = Path(os.environ["TEST_GATE"]), images[0].info.name
    if name.startswith("held"):
        (gate / f"{name}.pid").write_text(str(os.getpid()))
        deadline = time.monotonic() + 90
        while not (gate / "open").exists() and time.monotonic() < deadline:
            time.sleep(0.01)
    return score_task(images, *rest)


def deadly_score(images: Any, *rest: Any) -> Any:
    """Parts that begin with an image named ``deadly...`` kill the process that works on them."""
    if images[0].info.name.startswith("deadly"):
        os.kill(os.getpid(), signal.SIGKILL)
    return score_task(images, *rest)


def gated_validate(upload: bytes, name: str, *rest: Any) -> Any:
    """Uploads named ``held...`` wait for the gate."""
    gate = Path(os.environ["TEST_GATE"])
    if name.startswith("held"):
        (gate / f"{name}.pid").write_text(str(os.getpid()))
        deadline = time.monotonic() + 90
        while not (gate / "open").exists() and time.monotonic() < deadline:
            time.sleep(0.01)
    return validate_task(upload, name, *rest)


def slow_score(images: Any, *rest: Any) -> Any:
    """Takes longer than any limit, in Python code."""
    from app.jobs.limits import TaskLimits, bounded

    with bounded(TaskLimits(0.2, 512), "scoring these images"):
        deadline = time.monotonic() + 60
        while time.monotonic() < deadline:
            sum(range(1000))
    return score_task(images, *rest)
