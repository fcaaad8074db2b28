"""Calibration tasks that wait, or misbehave, in a worker process."""

from __future__ import annotations

import os
import signal
import time
from pathlib import Path
from typing import Any

from app.jobs.notes import watch_through


def gated_calibrate(*arguments: Any, **options: Any) -> Any:
    """Say which process works on it, note how far it is, and wait until the gate is open."""
    gate, watch = Path(os.environ["TEST_GATE"]), watch_through(options["notes"], pause=0.0)
    (gate / "calibration.pid").write_text(str(os.getpid()))
    deadline = time.monotonic() + 90
    while not (gate / "open").exists() and time.monotonic() < deadline:
        watch("waiting at the gate", 1, 3)
        time.sleep(0.01)
    from app.jobs.calibration_tasks import calibrate_task  # takes longer than all else here; not before the gate

    return calibrate_task(*arguments, **options)


def deadly_calibrate(*_arguments: Any, **_options: Any) -> None:
    """Kill the process that works on it."""
    os.kill(os.getpid(), signal.SIGKILL)
