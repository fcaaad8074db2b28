"""How far two people agree beyond chance: Cohen's kappa.

    kappa = (p_o - p_e) / (1 - p_e)

with p_o the share of equal verdicts and p_e what two people who judge independently, each with their own shares of
verdicts, would have equal (Cohen, Educational and Psychological Measurement 20, 1960). The interval takes the
large-sample standard error of Fleiss, Cohen and Everitt (Psychological Bulletin 72, 1969).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from app.errors import InvalidInput

NORMAL_95 = 1.959963984540054
"""Half width of a 95 % interval in standard errors."""


class Kappa(NamedTuple):
    """Agreement of two people.

    Attributes:
        value: Kappa in [-1, 1]; ``None`` where it isn't defined: nothing judged, or the same verdict throughout.
        low: Lower end of the 95 % interval; ``None`` where kappa is.
        high: Upper end.
        observed: Share of equal verdicts; ``None`` if nothing was judged.
        expected: Share that chance would make equal; ``None`` if nothing was judged.
        count: Candidates that both judged.
    """

    value: float | None
    low: float | None
    high: float | None
    observed: float | None
    expected: float | None
    count: int  # pyright: ignore[reportIncompatibleMethodOverride]


class LengthBin(NamedTuple):
    """Agreement on candidates of ``low <= length < high``, px; ``high`` is ``None`` for the last bin."""

    low: float
    high: float | None
    kappa: Kappa


def cohen_kappa(table: ArrayLike) -> Kappa:
    """Return kappa of a square table of counts.

    Args:
        table: ``(V, V)`` counts from 0 up: rows the first person's verdicts, columns the second's, in the same order.

    Raises:
        InvalidInput: On a table that isn't square, or counts that are negative or not finite.

    Example:
        >>> round(cohen_kappa([[20, 5], [10, 15]]).value, 3)
        0.4
    """
    counts = np.asarray(table, np.float64)
    if counts.ndim != 2 or counts.shape[0] != counts.shape[1] or not counts.size:
        raise InvalidInput(f"a table of shape {counts.shape}", where="table", expected="a square of counts")
    if not np.isfinite(counts).all() or (counts < 0).any():
        raise InvalidInput("a count is negative or not finite", where="table", expected="counts from 0 up")
    total = counts.sum()
    if total == 0:
        return Kappa(None, None, None, None, None, 0)
    shares = counts / total
    rows, columns = shares.sum(axis=1), shares.sum(axis=0)
    observed, expected = float(np.trace(shares)), float(rows @ columns)
    number = round(float(total))
    if expected >= 1 - 1e-12:
        return Kappa(None, None, None, observed, expected, number)
    value = (observed - expected) / (1 - expected)
    error = _standard_error(shares, rows, columns, observed, expected, float(total))
    low, high = max(-1.0, value - NORMAL_95 * error), min(1.0, value + NORMAL_95 * error)
    return Kappa(value, low, high, observed, expected, number)


def kappa_of(first: Sequence[str], second: Sequence[str], verdicts: Sequence[str]) -> Kappa:
    """Return kappa of two people's verdicts on the same candidates; those not in ``verdicts`` are left out.

    Raises:
        InvalidInput: If the two lists differ in length.
    """
    return cohen_kappa(verdict_table(first, second, verdicts))


def verdict_table(first: Sequence[str], second: Sequence[str], verdicts: Sequence[str]) -> NDArray[np.int64]:
    """Count pairs of verdicts, int64 ``(V, V)``: rows the first person's, columns the second's.

    Raises:
        InvalidInput: If the two lists differ in length.
    """
    if len(first) != len(second):
        raise InvalidInput(f"{len(first)} and {len(second)} verdicts", where="verdicts", expected="one each of both")
    position = {verdict: index for index, verdict in enumerate(verdicts)}
    table = np.zeros((len(verdicts), len(verdicts)), np.int64)
    for one, other in zip(first, second, strict=True):
        if one in position and other in position:
            table[position[one], position[other]] += 1
    return table


def kappa_by_length(
    first: Sequence[str],
    second: Sequence[str],
    lengths: ArrayLike,
    verdicts: Sequence[str],
    edges: Sequence[float] = (0.0, 50.0, 100.0, 200.0, 400.0),
) -> tuple[LengthBin, ...]:
    """Return kappa of the candidates of each bin of length.

    Args:
        first: The first person's verdicts, one per candidate.
        second: The second person's.
        lengths: ``(S,)``, px.
        verdicts: Those that count.
        edges: Lower ends of the bins, rising, px.

    Raises:
        InvalidInput: If the lists differ in length.
    """
    sizes = np.asarray(lengths, np.float64)
    if not len(first) == len(second) == len(sizes):
        raise InvalidInput(f"{len(first)}, {len(second)} verdicts and {len(sizes)} lengths", where="lengths")
    of_candidate = np.searchsorted(np.asarray(edges), sizes, side="right") - 1
    bins = []
    for number, low in enumerate(edges):
        rows = np.flatnonzero(of_candidate == number).tolist()
        kappa = kappa_of([first[row] for row in rows], [second[row] for row in rows], verdicts)
        bins.append(LengthBin(float(low), float(edges[number + 1]) if number + 1 < len(edges) else None, kappa))
    return tuple(bins)


def _standard_error(
    shares: NDArray[np.float64],
    rows: NDArray[np.float64],
    columns: NDArray[np.float64],
    observed: float,
    expected: float,
    total: float,
) -> float:
    agreeing = np.diag(shares) * ((1 - expected) - (rows + columns) * (1 - observed)) ** 2
    mixed = shares * (columns[:, None] + rows[None, :]) ** 2
    differing = (1 - observed) ** 2 * (mixed.sum() - np.trace(mixed))
    rest = (observed * expected - 2 * expected + observed) ** 2
    variance = (agreeing.sum() + differing - rest) / (total * (1 - expected) ** 4)
    return math.sqrt(max(float(variance), 0.0))
