"""Time requests of one client to several servers in turn, so that what else the machine does falls on all of them."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import httpx2 as httpx
import numpy as np
import psycopg
from shared.scale_requests import PageQuery

MILLISECONDS = 1_000


@dataclass(frozen=True)
class Timing:
    """How long requests of one kind took, ms.

    Attributes:
        first: The very first one after the server's start.
        processor: Mean time on a processor, of the server and of the database together: what waiting for other
            programs doesn't add to.
    """

    first: float
    median: float
    p95: float
    processor: float


@dataclass(frozen=True)
class Server:
    """A server of one size.

    Attributes:
        address: Of its API.
        database: Address of its database.
        process: Number of its process.
        token: A reader's.
    """

    address: str
    database: str
    process: int
    token: str

    def processor_seconds(self) -> dict[int, float]:
        """Return how long it and each of its connections to the database have been on a processor."""
        with psycopg.connect(self.database) as connection:
            rows = connection.execute("SELECT pid FROM pg_stat_activity WHERE datname = current_database()").fetchall()
        return {process: _processor_seconds(process) for process in (self.process, *(row[0] for row in rows))}


def time_page(servers: Sequence[Server], pages: Sequence[PageQuery], rounds: int) -> list[Timing]:
    """Ask each server for the same page, round after round.

    Args:
        servers: Of each size.
        pages: What to ask each of them for.
        rounds: How often, the first time not counted.
    """
    with httpx.Client(timeout=300.0) as client:

        def ask(place: int, number: int) -> None:
            server, page = servers[place], pages[place]
            headers = {"Authorization": f"Bearer {server.token}"} if page.role == "reader" else {}
            answer = client.get(server.address + page.path(number), headers=headers)
            if answer.status_code != httpx.codes.OK:
                raise RuntimeError(f"{page.name}: {answer.status_code} {answer.text[:500]}")

        return time_each(servers, ask, rounds)


def time_each(servers: Sequence[Server], ask: Callable[[int, int], None], rounds: int) -> list[Timing]:
    """Time what is asked of each server, given its place and the number of the round."""
    seconds: list[list[float]] = [[] for _ in servers]
    for place in range(len(servers)):
        seconds[place].append(_timed(ask, place, 0))
    before = [server.processor_seconds() for server in servers]
    for number in range(1, rounds + 1):
        for place in range(len(servers)):
            seconds[place].append(_timed(ask, place, number))
    worked = [_worked(start, server.processor_seconds()) for server, start in zip(servers, before, strict=True)]
    return [_timing(each, spent / rounds) for each, spent in zip(seconds, worked, strict=True)]


def figures_of(timings: Mapping[str, Sequence[Timing]], names: Sequence[str]) -> dict[str, float]:
    """Return times as figures: the name of the page, of the size and of the figure, joined."""
    return {
        f"{page} {name} {figure}".replace(",", "").replace("'", "").replace(" ", "_"): round(getattr(timing, figure), 3)
        for page, of_page in timings.items()
        for name, timing in zip(names, of_page, strict=True)
        for figure in ("median", "p95", "processor")
    }


def _worked(before: Mapping[int, float], after: Mapping[int, float]) -> float:
    """Return what was worked between two looks; of a connection that was closed meanwhile, nothing is known."""
    return sum(max(seconds - before.get(process, 0.0), 0.0) for process, seconds in after.items())


def _timed(ask: Callable[[int, int], None], place: int, number: int) -> float:
    begun = time.perf_counter()
    ask(place, number)
    return time.perf_counter() - begun


def _timing(seconds: Sequence[float], processor: float) -> Timing:
    later = np.array(seconds[1:]) * MILLISECONDS
    first = seconds[0] * MILLISECONDS
    return Timing(first, float(np.median(later)), float(np.percentile(later, 95)), processor * MILLISECONDS)


def _processor_seconds(process: int) -> float:
    total = 0.0
    with suppress(FileNotFoundError, ProcessLookupError):  # processes and threads end meanwhile
        for task in sorted(Path(f"/proc/{process}/task").iterdir()):
            with suppress(FileNotFoundError, ProcessLookupError):
                total += int((task / "schedstat").read_text().split()[0]) / 1e9
    return total
