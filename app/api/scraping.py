"""What Prometheus reads: what was counted, and how the queue, the workers, the disks and the database are."""

from __future__ import annotations

import hmac
import threading
import time
from collections.abc import Callable, Iterable

from prometheus_client.core import GaugeMetricFamily, Metric
from prometheus_client.registry import Collector
from starlette.concurrency import run_in_threadpool
from starlette.datastructures import Headers
from starlette.responses import Response
from starlette.types import ASGIApp, Receive, Scope, Send

from app.api.deps import Server
from app.api.disks import disks_of
from app.api.metrics import MEDIA_TYPE, Metrics
from app.api.policy import PREFIX
from app.errors import ClearLinesError
from app.services.database_status import connection_counts
from app.services.failures import latest_failures
from app.services.queue_status import QueueStanding, queue_standings

PATHS = frozenset({"/metrics", f"{PREFIX}/metrics"})
GOOD_FOR = 5.0
"""Seconds for which the queue's state is told again without asking the database."""


class Scraping:
    """ASGI middleware outside the gate: whoever sends the token of the settings reads the metrics, and nothing else.

    Everybody else needs to be an admin. ``/metrics`` is another name of ``/api/metrics``.
    """

    def __init__(self, app: ASGIApp, *, metrics: Metrics, token: str | None) -> None:
        self.app = app
        self.metrics = metrics
        self.expected = None if token is None else f"Bearer {token}".encode()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer, or pass on, one request."""
        if scope["type"] != "http" or scope["method"] != "GET" or scope["path"] not in PATHS:
            await self.app(scope, receive, send)
        elif self.expected is not None and hmac.compare_digest(
            Headers(scope=scope).get("authorization", "").encode(), self.expected
        ):
            text = await run_in_threadpool(self.metrics.text)
            await Response(text, media_type=MEDIA_TYPE)(scope, receive, send)
        else:
            path = f"{PREFIX}/metrics"
            await self.app({**scope, "path": path, "raw_path": path.encode()}, receive, send)


class StateCollector(Collector):
    """Tells how the server is at the moment when it is asked.

    Args:
        server: The server.
        clock: Seconds, of a clock that doesn't jump.
    """

    def __init__(self, server: Server, *, clock: Callable[[], float] = time.monotonic) -> None:
        self._server = server
        self._clock = clock
        self._lock = threading.Lock()
        self._asked_at = float("-inf")
        self._standings: list[QueueStanding] | None = None

    def describe(self) -> Iterable[Metric]:
        """Return nothing: names are checked when they are told."""
        return []

    def collect(self) -> Iterable[Metric]:
        """Return the state; what can't be asked is left out."""
        yield from self._queue()
        yield from self._workers()
        yield from self._disks()
        open_connections, used = connection_counts(self._server.database)
        connections = GaugeMetricFamily(
            "clearlines_database_connections", "Connections to the database.", labels=["state"]
        )
        connections.add_metric(["used"], used)
        connections.add_metric(["idle"], open_connections - used)
        yield connections

    def _queue(self) -> Iterable[Metric]:
        standings = self._current_standings()
        answers = GaugeMetricFamily(
            "clearlines_database_up", "Whether the database answered.", value=float(standings is not None)
        )
        yield answers
        if standings is None:
            return
        depth = GaugeMetricFamily("clearlines_queue_depth", "Work by kind and state.", labels=["kind", "state"])
        wait = GaugeMetricFamily(
            "clearlines_queue_oldest_wait_seconds", "How long the oldest work has been waiting.", labels=["kind"]
        )
        failed = GaugeMetricFamily(
            "clearlines_queue_failed_lately", "Work that failed within a day and nobody has mended.", labels=["kind"]
        )
        for standing in standings:
            depth.add_metric([standing.kind, "waiting"], standing.waiting)
            depth.add_metric([standing.kind, "running"], standing.running)
            wait.add_metric([standing.kind], standing.oldest_wait or 0.0)
            failed.add_metric([standing.kind], standing.failed)
        yield from (depth, wait, failed)

    def _current_standings(self) -> list[QueueStanding] | None:
        with self._lock:
            if self._clock() - self._asked_at >= GOOD_FOR:
                try:
                    with self._server.database.read() as session:
                        self._standings = queue_standings(session, latest_failures(session), self._server.clock())
                except ClearLinesError:
                    self._standings = None
                self._asked_at = self._clock()
            return self._standings

    def _workers(self) -> Iterable[Metric]:
        status = self._server.dispatcher.status()
        yield GaugeMetricFamily(
            "clearlines_dispatcher_active", "Whether this server gives work out.", value=float(status.holds_lock)
        )
        yield GaugeMetricFamily(
            "clearlines_crew_reachable", "Whether work can be sent to workers.", value=float(status.crew.reachable)
        )
        workers = GaugeMetricFamily("clearlines_workers", "Worker processes.", labels=["accepted"])
        for accepted in (True, False):
            number = sum(worker.accepted is accepted for worker in status.crew.workers)
            workers.add_metric([str(accepted).lower()], number)
        yield workers
        in_hand = GaugeMetricFamily("clearlines_work_in_hand", "Work that workers have, or next.", labels=["state"])
        in_hand.add_metric(["running"], status.running)
        in_hand.add_metric(["next"], status.waiting)
        yield in_hand

    def _disks(self) -> Iterable[Metric]:
        room = GaugeMetricFamily("clearlines_disk_bytes", "Room for files.", labels=["disk", "state"])
        for disk in disks_of(self._server):
            for state, value in (("used", disk.used), ("free", disk.free)):
                if value is not None:
                    room.add_metric([disk.name, state], value)
        yield room
