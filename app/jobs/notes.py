"""Notes between a dispatcher and the worker of a long task: how far it is, and that nobody wants it any more.

They are files in a folder of the server's, since a worker has no database. A note that is lost costs nothing but a
progress bar; where workers run on another machine there are none.
"""

from __future__ import annotations

import contextlib
import json
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from app.errors import Cancelled

PAUSE = 0.2
"""Seconds between two notes of a worker."""


@dataclass(frozen=True)
class TaskNotes:
    """The notes of one attempt at one task.

    Attributes:
        path: Without ending.
    """

    path: Path

    def progress(self) -> dict[str, Any] | None:
        """Return what the worker noted last: ``stage``, ``done`` and ``total``; ``None`` where it hasn't yet."""
        try:
            return json.loads(self._progress.read_text())
        except (OSError, ValueError):
            return None

    def note(self, stage: str, done: int, total: int) -> None:
        """Note how far the task is; whoever reads sees a whole note. Where the folder isn't there, nothing is noted."""
        written = self.path.with_suffix(".new")
        with contextlib.suppress(OSError):
            written.write_text(json.dumps({"stage": stage, "done": done, "total": total}))
            written.replace(self._progress)

    def prepare(self) -> None:
        """Make the folder, and remove what an attempt of that name left."""
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self.discard()

    def call_off(self) -> None:
        """Tell the worker to stop."""
        self._called_off.touch()

    def is_called_off(self) -> bool:
        """Whether the worker is to stop."""
        return self._called_off.exists()

    def discard(self) -> None:
        """Remove them."""
        for path in (self._progress, self._called_off, self.path.with_suffix(".new")):
            path.unlink(missing_ok=True)

    @property
    def _progress(self) -> Path:
        return self.path.with_suffix(".progress")

    @property
    def _called_off(self) -> Path:
        return self.path.with_suffix(".cancel")


def watch_through(
    notes: TaskNotes, *, clock: Callable[[], float] = time.monotonic, pause: float = PAUSE
) -> Callable[[str, int, int], None]:
    """Return what a task is to call now and then with stage, done and total.

    Args:
        notes: Where it is noted.
        clock: Gives seconds.
        pause: Seconds between two notes of one stage; a new stage is noted at once.

    Returns:
        A function that raises ``Cancelled`` once the task was called off.
    """
    last: dict[str, Any] = {"stage": None, "time": 0.0}

    def watch(stage: str, done: int, total: int) -> None:
        if stage == last["stage"] and clock() - last["time"] < pause:
            return
        last.update(stage=stage, time=clock())
        if notes.is_called_off():
            raise Cancelled("the work was called off")
        notes.note(stage, done, total)

    return watch
