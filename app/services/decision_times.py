"""How long decisions take, by person and by verdict."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass

from app.services.time_bins import histogram, quantiles
from app.services.work_logs import TimeKey, WorkLog

QUARTILES = (0.25, 0.5, 0.75)


@dataclass(frozen=True)
class DecisionTimes:
    """How long key presses took, ms.

    Attributes:
        count: Key presses that tell it.
        histogram: Their numbers by ``Statistics.edges``.
    """

    count: int
    lower_quartile: float | None
    median: float | None
    upper_quartile: float | None
    histogram: tuple[int, ...]


@dataclass(frozen=True)
class VerdictTimes:
    """How long it took to give a verdict."""

    verdict: str
    times: DecisionTimes


def verdict_times(log: WorkLog, verdict: str) -> VerdictTimes:
    """Return how long it took to give a verdict."""
    return VerdictTimes(verdict, times_of(log, lambda key: key[1] == verdict))


def times_of(log: WorkLog, wanted: Callable[[TimeKey], bool]) -> DecisionTimes:
    """Return how long the key presses took whose person and verdict are wanted."""
    counts = Counter[int]()
    for key, number in log.times.items():
        if wanted(key):
            counts[key[2]] += number
    low, median, high = quantiles(counts, QUARTILES)
    return DecisionTimes(counts.total(), low, median, high, tuple(histogram(counts)))
