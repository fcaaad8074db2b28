"""How long decisions took, in bins that a database counts and quartiles can be read from.

A bin is 50 ms wide up to 10 s, and 1 s from there to two minutes; who took longer was away from the page.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from sqlalchemy import ColumnElement, case
from sqlalchemy.sql.elements import SQLCoreOperations

FINE = 50  # ms
COARSE = 1_000  # ms
COARSE_FROM = 10_000  # ms
AWAY = 120_000  # ms

_FINE_BINS = COARSE_FROM // FINE
BINS = _FINE_BINS + (AWAY - COARSE_FROM) // COARSE + 1

EDGES = (0, 250, 500, 750, 1_000, 1_500, 2_000, 3_000, 5_000, 10_000, 30_000, 60_000, AWAY)
"""Lower ends of the bars that are shown, ms; each is the lower end of a bin."""


def bin_of(milliseconds: SQLCoreOperations[int | None]) -> ColumnElement[int]:
    """Return the bin of a time as an expression."""
    return case(
        (milliseconds < COARSE_FROM, milliseconds // FINE),
        (milliseconds < AWAY, _FINE_BINS + (milliseconds - COARSE_FROM) // COARSE),
        else_=BINS - 1,
    )


def lower_end(number: int) -> int:
    """Return where a bin begins, ms; the bin after the last begins where nothing is any more."""
    if number <= _FINE_BINS:
        return number * FINE
    return COARSE_FROM + (number - _FINE_BINS) * COARSE


def histogram(counts: Mapping[int, int]) -> list[int]:
    """Return how many times are in each bar of ``EDGES``.

    Args:
        counts: Number of times by bin.
    """
    bars = [0] * len(EDGES)
    for number, count in counts.items():
        start = lower_end(number)
        bars[sum(edge <= start for edge in EDGES) - 1] += count
    return bars


def quantiles(counts: Mapping[int, int], shares: Sequence[float]) -> list[float | None]:
    """Return quantiles of times, ms, evenly spread within a bin; ``None`` without any time.

    Args:
        counts: Number of times by bin.
        shares: Of the times that are below, each in [0, 1].
    """
    total = sum(counts.values())
    return [None if not total else _quantile(counts, share * total) for share in shares]


def _quantile(counts: Mapping[int, int], rank: float) -> float:
    below = 0
    place = 0.0
    for number in sorted(counts):
        start, end = lower_end(number), min(lower_end(number + 1), AWAY)
        if below + counts[number] >= rank:
            return start + (end - start) * (rank - below) / counts[number]
        below += counts[number]
        place = float(end)
    return place
