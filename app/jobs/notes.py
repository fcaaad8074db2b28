"""Notes between a dispatcher and the worker of a long task: how far it is, and that nobody wants it any more.

Where workers run on the server's machine they are files in a folder, since a worker has no database; those of a
cluster are in ``app.jobs.cluster.notes``. A note that is lost costs nothing but a progress bar.
"""

from __future__ import annotations

import contextlib
import json
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

from app.errors import Cancelled

PAUSE = 0.2
"""Seconds between two notes of a worker."""


class WorkerNotes(Protocol):
    """What the worker of a task sees of its notes."""

    def note(self, stage: str, done: int, total: int) -> None:
        """Note how far the task is."""
        ...

    def is_called_off(self) -> bool:
        """Whether the worker is to stop."""
        ...


class Notes(Protocol):
    """What the dispatcher sees of the notes of one attempt at one task."""

    def for_worker(self) -> WorkerNotes:
        """Return what is sent along with the task."""
        ...

    def prepare(self) -> None:
        """Remove what an attempt of that name left."""
        ...

    def progress(self) -> dict[str, Any] | None:
        """Return what the worker noted last: ``stage``, ``done`` and ``total``; ``None`` where it hasn't yet."""
        ...

    def call_off(self) -> None:
        """Tell the worker to stop; may be said again and again."""
        ...

    def discard(self) -> None:
        """Remove them."""
        ...


class NoteBoard(Protocol):
    """Where notes are."""

    def of(self, name: str) -> Notes:
        """Return the notes of one attempt at one task.

        Args:
            name: Of the attempt: a file name without ending.
        """
        ...


@dataclass(frozen=True)
class NoteFolder:
    """Notes as files.

    Attributes:
        path: Of the folder; made when needed.
    """

    path: Path

    def of(self, name: str) -> TaskNotes:
        """See ``NoteBoard``."""
        return TaskNotes(self.path / name)


@dataclass(frozen=True)
class TaskNotes:
    """The notes of one attempt at one task.

    Attributes:
        path: Without ending.
    """

    path: Path

    def for_worker(self) -> TaskNotes:
        """See ``Notes``: it finds the same files."""
        return self

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
    notes: WorkerNotes, *, clock: Callable[[], float] = time.monotonic, pause: float = PAUSE
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
