"""A server's connection to a Dask scheduler: it comes back by itself."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable
from contextlib import suppress

from distributed import Client

from app.jobs.cluster.admission import Admission
from app.jobs.cluster.carrying import CONNECT_SECONDS, knock
from app.jobs.cluster.versions import installed_versions
from app.jobs.cluster.workforce import BEGIN_SECONDS, Workforce
from app.jobs.crew_status import CrewStatus
from app.jobs.losses import WorkerLeft

logger = logging.getLogger(__name__)

RECONNECT_PAUSE = 2.0
"""Seconds between two attempts to reach the scheduler."""
LOOK_PAUSE = 0.5
"""Seconds between two looks whether the scheduler is still there."""


class Connection:
    """The event loop's side: all of it is to be called there, but for ``status``.

    Args:
        address: Of the scheduler.
        megabytes: A worker that holds more after a task is replaced; the nanny's bound alone counts where left out.
        task_seconds: A worker that is busy with somebody else's work for so long is restarted.
        on_change: Called when there are more or fewer workers, or the scheduler comes or goes.
        pause: Seconds between two attempts to reach the scheduler.
        begin_seconds: A worker that hasn't begun a task for so long is asked why.

    Attributes:
        status: What is known at the moment; always whole, from any thread.
        workforce: The workers.
    """

    def __init__(
        self,
        address: str,
        *,
        megabytes: int | None,
        task_seconds: float,
        on_change: Callable[[], None],
        pause: float = RECONNECT_PAUSE,
        begin_seconds: float = BEGIN_SECONDS,
    ) -> None:
        self.status = CrewStatus("cluster", address, False, "the scheduler hasn't answered yet", ())
        self.workforce = Workforce(
            Admission(installed_versions(), megabytes),
            task_seconds=task_seconds,
            begin_seconds=begin_seconds,
            on_change=self._changed,
        )
        self._address = address
        self._on_change = on_change
        self._pause = pause
        self._problem = self.status.problem

    async def stay(self, stop: asyncio.Event) -> None:
        """Be connected, again and again, until told to stop."""
        while not stop.is_set():
            try:
                await self._visit(stop)
            except Exception as error:  # whatever a scheduler answers: the server goes on without it
                self._tell_problem(f"the scheduler is out of reach: {error}")
            await _wait(stop, self._pause)

    async def _visit(self, stop: asyncio.Event) -> None:
        """Be connected until the scheduler goes away."""
        await knock(self._address)
        client = Client(self._address, asynchronous=True, timeout=CONNECT_SECONDS, set_as_default=False)
        try:
            await client
            stream = client.scheduler_comm
            await self.workforce.join(client)
            self._tell_problem(None)
            # Dask would reconnect by itself, and then neither tell of its workers nor send any events
            while not stop.is_set() and client.status == "running" and client.scheduler_comm is stream:
                self.workforce.look_after_unbegun()
                await _wait(stop, LOOK_PAUSE)
            if not stop.is_set():
                raise WorkerLeft("the connection broke")
        finally:
            await self.workforce.part()
            with suppress(Exception):  # whatever is wrong with it: it isn't used any more
                await asyncio.wait_for(client._close(fast=True), CONNECT_SECONDS)

    def _tell_problem(self, problem: str | None) -> None:
        if problem != self._problem:
            if problem is None:
                logger.info("the scheduler %s answers", self._address)
            else:
                logger.warning("%s (%s); tried again every %g s", problem, self._address, self._pause)
        self._problem = problem
        self._changed()

    def _changed(self) -> None:
        problem, workers = self._problem, self.workforce.status()
        if problem is None and not any(worker.accepted for worker in workers):
            problem = "no worker is there, or none that may work"
        self.status = CrewStatus("cluster", self._address, self.workforce.is_reachable, problem, workers)
        self._on_change()


async def _wait(event: asyncio.Event, seconds: float) -> None:
    with suppress(TimeoutError):
        async with asyncio.timeout(seconds):
            await event.wait()
