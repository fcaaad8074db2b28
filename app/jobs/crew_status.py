"""What is known of the workers and of what they have to do, for whoever watches over it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Kind = Literal["pool", "cluster"]


@dataclass(frozen=True)
class WorkerStatus:
    """One worker process.

    Attributes:
        name: What it calls itself.
        address: ``tcp://HOST:PORT`` on a cluster; the process id in a pool.
        accepted: Whether it is given work.
        reason: Why it isn't: it runs another version, say; ``None`` when it is.
        megabytes: Memory that it held when last seen; ``None`` where that isn't known.
        busy: Whether it has work.
    """

    name: str
    address: str
    accepted: bool
    reason: str | None
    megabytes: float | None
    busy: bool


@dataclass(frozen=True)
class CrewStatus:
    """All workers.

    Attributes:
        kind: Processes on this machine, or those of a cluster.
        address: Of the cluster's scheduler; ``None`` for a pool.
        reachable: Whether work can be sent: False while the scheduler is away.
        problem: What is wrong, in words; ``None`` when nothing is.
        workers: Those known; a pool starts its workers when there is work.
    """

    kind: Kind
    address: str | None
    reachable: bool
    problem: str | None
    workers: tuple[WorkerStatus, ...]


@dataclass(frozen=True)
class DispatcherStatus:
    """One process's dispatcher.

    Attributes:
        holds_lock: Whether it is the one that works; of several servers one is.
        crew: Its workers. On a cluster each server sees the same ones.
        running: Work that workers have; 0 where it doesn't hold the lock.
        waiting: Work in hand beside that.
    """

    holds_lock: bool
    crew: CrewStatus
    running: int
    waiting: int
