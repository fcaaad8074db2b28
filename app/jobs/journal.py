"""What became of each piece of work, for the log and for whoever counts: when it was begun, how it ended, how long."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Hashable
from contextlib import AbstractContextManager
from typing import Any, Literal

from structlog.contextvars import bound_contextvars

from app.jobs.work import Work

Outcome = Literal["done", "failed", "lost"]
OnWork = Callable[[str, str, float], None]

logger = logging.getLogger(__name__)


class Journal:
    """Notes what is begun and what ends; used by one thread.

    Args:
        on_work: Told kind, outcome and seconds of work that has ended.
        seconds: Of a clock that doesn't jump.
    """

    def __init__(
        self,
        on_work: OnWork = lambda _kind, _outcome, _seconds: None,
        *,
        seconds: Callable[[], float] = time.monotonic,
    ) -> None:
        self._on_work = on_work
        self._seconds = seconds
        self._begun: dict[Hashable, float] = {}

    def about(self, work: Work) -> AbstractContextManager[Any]:
        """Have whatever is logged inside say which work it is about."""
        return bound_contextvars(job=job_of(work), attempt=work.attempts)

    def begun(self, work: Work) -> None:
        """Note that work was sent to a worker."""
        self._begun[work.key] = self._seconds()
        with self.about(work):
            logger.debug("work begun")

    def ended(self, work: Work, outcome: Outcome, error: dict[str, Any] | None = None) -> None:
        """Note how work ended: ``lost`` where its worker went with it."""
        seconds = self._seconds() - self._begun.pop(work.key, self._seconds())
        self._on_work(kind_of(work), outcome, seconds)
        facts: dict[str, Any] = {"ms": round(seconds * 1000, 1)}
        if error is not None:
            facts["error"] = error.get("message")
        with self.about(work):
            logger.log(logging.WARNING if outcome == "lost" else logging.INFO, "work %s", outcome, extra=facts)

    def left(self) -> None:
        """Forget what was begun: it was put back, or another dispatcher has it."""
        self._begun.clear()


def kind_of(work: Work) -> str:
    """Return the kind of work: ``detect``, ``score``..."""
    key = work.key
    return str(key[0]) if isinstance(key, tuple) else type(work).__name__


def job_of(work: Work) -> str:
    """Return what a piece of work is called: its kind and the ids of its rows, ``detect 12``."""
    key = work.key
    if not isinstance(key, tuple):
        return str(key)
    kind, *ids = key
    return f"{kind} {'/'.join(','.join(map(str, part)) if isinstance(part, tuple) else str(part) for part in ids)}"
