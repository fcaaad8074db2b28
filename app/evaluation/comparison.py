"""Which of two submissions is better, as far as the images can tell.

Both are scored on the same images, and hard images are hard for both. Their difference therefore varies far less than
either score, and it is the difference that is bootstrapped: both are measured on the same draws (paired bootstrap;
Efron and Tibshirani 1993, chapter 8; Koehn 2004, "Statistical significance tests for machine translation evaluation").
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from app.evaluation.bootstrap import (
    DRAWS,
    FEWEST_CLUSTERS,
    LEVEL,
    Measure,
    bootstrap,
    interval,
    or_none,
)


@dataclass(frozen=True)
class Difference:
    """One metric of two submissions a and b on the same images.

    Attributes:
        a: Value of the first; ``None`` if undefined.
        b: Value of the second.
        difference: ``b - a``; ``None`` if either is undefined.
        low: Lower end of the interval of the difference; ``None`` if nothing can be said.
        high: Upper end.
        tied: Whether the images can't tell the two apart: the interval covers 0, or there is none.
    """

    a: float | None
    b: float | None
    difference: float | None
    low: float | None
    high: float | None
    tied: bool

    def as_dict(self) -> dict[str, Any]:
        """Return the fields for JSON."""
        return asdict(self)


def compare(
    a: Measure, b: Measure, clusters: ArrayLike, draws: int = DRAWS, *, seed: int, level: float = LEVEL
) -> dict[str, Difference]:
    """Compare two submissions on the same images, in every metric that both have.

    Args:
        a: Metrics of the first under weightings of the images.
        b: Of the second, on the same images in the same order.
        clusters: int ``(I,)``, the cluster of each image.
        draws: B, number of draws.
        seed: Of the draws.
        level: Share of draws within the interval.

    Returns:
        Name of the metric to the difference.

    Raises:
        InvalidInput: When there are no images or no draws, or the level isn't in (0, 1).

    Example:
        >>> better = lambda weights: {"f1": weights @ np.array([0.8, 0.7, 0.9]) / weights.sum(axis=1)}
        >>> worse = lambda weights: {"f1": weights @ np.array([0.5, 0.4, 0.6]) / weights.sum(axis=1)}
        >>> compare(worse, better, [0, 1, 2], seed=0)["f1"].tied
        False
    """
    cluster = np.asarray(clusters)

    def differences(weights: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
        of_a, of_b = a(weights), b(weights)
        return {name: of_b[name] - of_a[name] for name in of_a if name in of_b}

    as_they_are = np.ones((1, len(cluster)))
    values_a, values_b = a(as_they_are), b(as_they_are)
    drawn = {}
    if len(np.unique(cluster)) >= FEWEST_CLUSTERS:
        drawn = bootstrap(differences, cluster, draws, seed=seed)
    both = [name for name in values_a if name in values_b]
    return {name: _difference(values_a[name][0], values_b[name][0], drawn.get(name), level) for name in both}


def is_tied(low: NDArray[np.float64], high: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return whether intervals of differences cover 0, ends included; undefined ones do, as they tell nothing."""
    return ~((low > 0) | (high < 0))


def _difference(a: float, b: float, drawn: NDArray[np.float64] | None, level: float) -> Difference:
    difference = b - a
    low, high = (np.nan, np.nan) if drawn is None or np.isnan(difference) else interval(drawn, level)
    tied = bool(is_tied(np.asarray(low), np.asarray(high)))
    return Difference(or_none(a), or_none(b), or_none(difference), or_none(low), or_none(high), tied)
