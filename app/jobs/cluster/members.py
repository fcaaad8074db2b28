"""The workers of a cluster as one server sees them; used by the connection's event loop alone."""

from __future__ import annotations

import asyncio
from concurrent.futures import Future
from dataclasses import dataclass, field
from typing import Any

from app.jobs.crew_status import WorkerStatus


@dataclass(eq=False)
class Order:
    """A task on its way.

    Attributes:
        key: Of the task on the cluster.
        call: What the worker is to do, packed.
        future: What is given to whoever submitted it; running once a worker has begun.
    """

    key: str
    call: bytes
    future: Future[Any] = field(default_factory=Future)


@dataclass(eq=False)
class Member:
    """One worker.

    Attributes:
        address: Of it.
        name: What it calls itself.
        reason: Why it isn't given work; ``None`` when it is.
        megabytes: Memory that it held when last seen.
        most_megabytes: With more it is replaced; ``None`` for no bound.
        order: What it has to do.
        let_go: Set when nobody wants that any more.
        sent_at: When that was sent, on the loop's clock.
        asked_at: When it was last asked why it hasn't begun.
        begun: Whether it has begun.
        gone: Fails with a ``BrokenExecutor`` when the worker is.
    """

    address: str
    name: str
    gone: asyncio.Future[None]
    reason: str | None = "it hasn't told its version yet"
    megabytes: float | None = None
    most_megabytes: float | None = None
    order: Order | None = None
    let_go: asyncio.Event = field(default_factory=asyncio.Event)
    sent_at: float = 0.0
    asked_at: float = 0.0
    begun: bool = False

    @property
    def is_accepted(self) -> bool:
        """Whether it is given work."""
        return self.reason is None

    @property
    def is_free(self) -> bool:
        """Whether it can be given work now."""
        return self.reason is None and self.order is None

    @property
    def has_outgrown(self) -> bool:
        """Whether it holds more memory than it may."""
        return self.most_megabytes is not None and (self.megabytes or 0.0) > self.most_megabytes

    def take(self, order: Order, now: float) -> None:
        """Give it something to do.

        Args:
            order: What.
            now: On the loop's clock, s.
        """
        self.order, self.sent_at, self.asked_at, self.begun, self.let_go = order, now, now, False, asyncio.Event()

    def leave(self, error: Exception) -> None:
        """Let whoever waits for it know that it is gone, and why."""
        if not self.gone.done():
            self.gone.set_exception(error)
            self.gone.exception()  # looked at, whether or not somebody waits for it

    def status(self) -> WorkerStatus:
        """Return what is told of it."""
        return WorkerStatus(
            self.name, self.address, self.reason is None, self.reason, self.megabytes, self.order is not None
        )
