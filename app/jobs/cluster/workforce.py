"""The workers of a cluster and the tasks for them: one at a time for each, and only for those that may work.

The scheduler isn't asked to choose a worker, nor to try a task again elsewhere: a task is bound to one worker which has
nothing else to do. So it is known whose task a worker died of, and that only workers of the same version get any.
"""

from __future__ import annotations

import asyncio
import logging
from collections import deque
from collections.abc import Callable, Coroutine
from concurrent.futures import Future
from contextlib import suppress
from typing import Any

from distributed import Client
from distributed.comm.core import CommClosedError

from app.jobs.cluster.admission import BUSY, Admission, introduced
from app.jobs.cluster.carrying import CONNECT_SECONDS, carry, fail, workers_of
from app.jobs.cluster.members import Member, Order
from app.jobs.cluster.notes import PROGRESS
from app.jobs.cluster.tasks import BEGUN, LEAVING
from app.jobs.crew_status import WorkerStatus
from app.jobs.losses import WorkerDied, WorkerLeft

logger = logging.getLogger(__name__)

ADMIT_PAUSE = 1.0
"""Seconds until a worker that can't be given work yet is asked again."""
BEGIN_SECONDS = 10.0
"""A worker that hasn't begun a task for so long is asked why."""
RESTART_SECONDS = 30.0


class Workforce:
    """What a connection's event loop knows of the workers; to be used there alone.

    Args:
        admission: What is asked of workers.
        task_seconds: A worker that is busy with somebody else's work for so long is restarted.
        begin_seconds: A worker that hasn't begun a task for so long is asked why.
        on_change: Called when something is different about the workers.
    """

    def __init__(
        self, admission: Admission, *, task_seconds: float, begin_seconds: float, on_change: Callable[[], None]
    ) -> None:
        self.progress: dict[str, dict[str, Any]] = {}
        self._admission = admission
        self._task_seconds = task_seconds
        self._begin_seconds = begin_seconds
        self._changed = on_change
        self._client: Client | None = None
        self._members: dict[str, Member] = {}
        self._orders: deque[Order] = deque()
        self._under_way: set[asyncio.Task[None]] = set()

    @property
    def is_reachable(self) -> bool:
        """Whether tasks can be sent."""
        return self._client is not None

    def status(self) -> tuple[WorkerStatus, ...]:
        """Return what is told of the workers."""
        return tuple(member.status() for member in self._members.values())

    async def join(self, client: Client) -> None:
        """Begin to work with a scheduler's workers, those that come later too.

        Args:
            client: Connected to the scheduler.
        """
        client.subscribe_topic("all", self._on_member)
        client.subscribe_topic(BEGUN, self._on_begun)
        client.subscribe_topic(PROGRESS, self._on_progress)
        client.subscribe_topic(LEAVING, self._on_leaving)
        self._client = client
        for address in await workers_of(client):
            self._meet(address)

    async def part(self) -> None:
        """Forget the workers; all tasks fail with ``WorkerLeft``."""
        self._client = None
        for member in self._members.values():
            member.leave(WorkerLeft("the scheduler is out of reach"))
        self._members.clear()
        while self._orders:
            fail(self._orders.popleft(), WorkerLeft("the scheduler is out of reach"))
        if self._under_way:
            await asyncio.wait(self._under_way, timeout=CONNECT_SECONDS)

    def take(self, order: Order) -> None:
        """Take a task in; it fails with ``WorkerLeft`` while the scheduler is away."""
        if self._client is None:
            fail(order, WorkerLeft("the scheduler is out of reach"))
        else:
            self._orders.append(order)
            self._assign()

    def end_hung(self, future: Future[Any]) -> None:
        """Restart the worker that has this."""
        for member in self._members.values():
            if member.order is not None and member.order.future is future:
                member.leave(WorkerDied("it hung"))
                self._restart(member, "it hung, and is restarted")

    def dismiss(self) -> None:
        """Let go of all tasks."""
        while self._orders:
            self._orders.popleft().future.cancel()
        for member in self._members.values():
            if member.order is not None:
                member.let_go.set()

    def broadcast(self, function: Callable[..., None], name: str) -> None:
        """Call a function in all workers that are given work; nobody waits for it."""
        client, addresses = self._client, [member.address for member in self._members.values() if member.is_accepted]
        if client is not None and addresses:
            self._begin(self._tell(client, function, name, addresses))

    def look_after_unbegun(self) -> None:
        """Take work back from workers that don't begin it: they may be busy with what an ended server gave them."""
        client = self._client
        now = asyncio.get_running_loop().time()
        for member in self._members.values():
            if (
                client is not None
                and member.order is not None
                and not member.begun
                and now - member.asked_at > self._begin_seconds
            ):
                member.asked_at = now
                self._begin(self._look_into(client, member, member.order))

    def _on_member(self, event: tuple[float, Any]) -> None:
        message = event[1] if isinstance(event[1], dict) else {}
        if message.get("action") == "add-worker":
            self._meet(message["worker"])
        elif message.get("action") == "remove-worker":
            member = self._members.pop(message["worker"], None)
            if member is not None:
                expected = bool(message.get("expected"))
                logger.info("worker %s of the cluster %s", member.name, "left" if expected else "died")
                member.leave(WorkerLeft("it left") if expected else WorkerDied("the worker died"))
                self._changed()

    def _on_leaving(self, event: tuple[float, Any]) -> None:
        member = self._members.get(event[1].get("worker"))
        if member is not None:
            member.reason = "it was told to stop"
            member.leave(WorkerLeft(member.reason))
            self._changed()

    def _on_begun(self, event: tuple[float, Any]) -> None:
        for member in self._members.values():
            if member.order is not None and member.order.key == event[1].get("key"):
                member.begun = member.order.future.set_running_or_notify_cancel()
                self._changed()

    def _on_progress(self, event: tuple[float, Any]) -> None:
        told = event[1]
        if told.get("name") in self.progress:  # what isn't asked for is another server's
            self.progress[told["name"]] = {part: told[part] for part in ("stage", "done", "total")}

    def _meet(self, address: str) -> None:
        if address not in self._members and self._client is not None:
            member = Member(address, address, asyncio.get_running_loop().create_future())
            self._members[address] = member
            self._begin(self._admit(self._client, member))

    async def _admit(self, client: Client, member: Member) -> None:
        """Give a worker work once nothing stands in its way; for good if its version does."""
        began = asyncio.get_running_loop().time()
        while await self._admission.examine(client, member):
            self._changed()
            if asyncio.get_running_loop().time() - began > self._task_seconds:
                self._restart(member, "it is busy for too long, and is restarted")
                return
            await asyncio.wait({member.gone}, timeout=ADMIT_PAUSE)
            if member.gone.done():
                return
        if member.reason is None:
            logger.info("worker %s of the cluster joined", member.name)
        elif self._members.get(member.address) is member:
            logger.warning("worker %s of the cluster is refused: %s", member.name, member.reason)
        self._assign()

    def _assign(self) -> None:
        free = sorted((member for member in self._members.values() if member.is_free), key=lambda each: each.sent_at)
        for member in free:
            while self._orders and member.order is None:
                order = self._orders.popleft()
                if not order.future.cancelled() and self._client is not None:
                    member.take(order, asyncio.get_running_loop().time())
                    self._begin(self._carry(self._client, member, order))
        self._changed()

    async def _carry(self, client: Client, member: Member, order: Order) -> None:
        try:
            await carry(client, member, order)
        except Exception as error:  # the client was closed a moment ago
            fail(order, WorkerLeft(str(error)))
        finally:
            member.order = None
            if member.has_outgrown and member.is_accepted and not member.gone.done():
                self._restart(member, f"it holds {member.megabytes:.0f} MB, and is replaced")
            self._assign()

    async def _look_into(self, client: Client, member: Member, order: Order) -> None:
        try:
            executing = (await introduced(client, member.address))["executing"]
        except (OSError, CommClosedError, KeyError):
            executing = True  # it hangs, or is on its way out
        if executing and member.order is order and not member.begun:
            member.reason = BUSY
            self._changed()
            fail(order, WorkerLeft("it was busy"))
            member.let_go.set()
            await self._admit(client, member)

    def _restart(self, member: Member, reason: str) -> None:
        if self._client is not None:
            logger.warning("worker %s of the cluster: %s", member.name, reason)
            member.reason = reason
            self._begin(self._restarted(self._client, member))
            self._changed()

    async def _restarted(self, client: Client, member: Member) -> None:
        try:
            await client.restart_workers([member.address], timeout=RESTART_SECONDS, raise_for_error=False)
        except Exception as error:  # it stays without work, and the status tells why
            member.reason = f"{member.reason}; that failed: {error}"
            logger.warning("worker %s of the cluster can't be restarted: %s", member.name, error)
        self._changed()

    async def _tell(self, client: Client, function: Callable[..., None], name: str, addresses: list[str]) -> None:
        with suppress(Exception):  # it is told again as long as the work goes on
            await client.run(function, name, workers=addresses, on_error="ignore")

    def _begin(self, work: Coroutine[Any, Any, None]) -> None:
        task = asyncio.get_running_loop().create_task(work)
        self._under_way.add(task)
        task.add_done_callback(self._under_way.discard)
