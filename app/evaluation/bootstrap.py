"""How far a score may be from chance: the bootstrap over images, clustered by sequence where sequences are known.

The images of a split are a sample of the images that could have been taken. Drawing as many clusters of images again,
with replacement, and scoring each draw shows how far the score of a sample varies (Efron 1979, "Bootstrap methods:
another look at the jackknife"); the percentiles of the draws bound the interval (Efron and Tibshirani 1993, "An
introduction to the bootstrap", chapter 13). Images of one sequence show the same street and are drawn together, as a
cluster (Davison and Hinkley 1997, "Bootstrap methods and their application", section 3.8): taken as independent they
would promise too much.

A draw is a weight per image, how often it was drawn. Every metric here is a function of weighted sums over images, so
all draws are one matrix product.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from app.errors import InvalidInput

DRAWS = 2000
"""Draws of a bootstrap: the ends of a 95 % interval then vary by a few percent of its width."""
LEVEL = 0.95
"""Share of draws within an interval."""
FEWEST_CLUSTERS = 2
"""Below it nothing varies, which says nothing about how far a score may be from chance."""

_BLOCK_WEIGHTS = 1 << 22  # weights held at once: 32 MB

Measure = Callable[[NDArray[np.float64]], Mapping[str, NDArray[np.float64]]]
"""Metrics of a set of I images under B weightings ``(B, I)`` of them: name to float64 ``(B,)``, NaN if undefined."""


class Estimate(NamedTuple):
    """A metric and its interval; ``None`` where it isn't defined, or for the interval, where nothing can be said."""

    value: float | None
    low: float | None
    high: float | None

    def as_dict(self) -> dict[str, float | None]:
        """Return ``{"value", "low", "high"}`` for JSON."""
        return self._asdict()


def clusters_of(sequences: Sequence[Hashable | None]) -> NDArray[np.int64]:
    """Number the clusters that images are drawn in: those of one sequence together, the others each alone.

    Returns:
        int64 ``(I,)``, from 0 in order of first appearance.

    Example:
        >>> clusters_of(["a", None, "a", None])
        array([0, 1, 0, 2])
    """
    numbers: dict[object, int] = {}
    keys = [(index,) if sequence is None else (None, sequence) for index, sequence in enumerate(sequences)]
    return np.array([numbers.setdefault(key, len(numbers)) for key in keys], dtype=np.int64)


def bootstrap_weights(clusters: ArrayLike, draws: int = DRAWS, *, seed: int) -> NDArray[np.float64]:
    """Draw as many clusters as there are, with replacement, and say how often each image is in a draw.

    Args:
        clusters: int ``(I,)``, the cluster of each image.
        draws: B, number of draws.
        seed: Of the draws: the same seed and clusters give the same weights, on every submission.

    Returns:
        float64 ``(B, I)``, whole numbers; the images of a cluster have the same in each row.

    Raises:
        InvalidInput: When there are no images or no draws.
    """
    return np.concatenate(list(weight_blocks(clusters, draws, seed=seed)))


def weight_blocks(clusters: ArrayLike, draws: int = DRAWS, *, seed: int) -> Iterator[NDArray[np.float64]]:
    """Yield the rows of ``bootstrap_weights`` a few at a time, so that memory stays bounded for any number of images.

    Raises:
        InvalidInput: When there are no images or no draws.
    """
    _, cluster = np.unique(np.asarray(clusters), return_inverse=True)
    if not cluster.size or draws < 1:
        raise InvalidInput(
            f"{draws} draws of {cluster.size} images make no bootstrap", expected="at least one of either"
        )
    count = int(cluster.max()) + 1
    random = np.random.default_rng(seed)
    rows = max(1, _BLOCK_WEIGHTS // len(cluster))
    for start in range(0, draws, rows):
        here = min(rows, draws - start)
        drawn = random.integers(0, count, (here, count)) + count * np.arange(here)[:, None]
        times = np.bincount(drawn.ravel(), minlength=here * count).reshape(here, count)
        yield times[:, cluster].astype(np.float64)


def bootstrap(
    measure: Measure, clusters: ArrayLike, draws: int = DRAWS, *, seed: int
) -> dict[str, NDArray[np.float64]]:
    """Return the metrics of every draw.

    Args:
        measure: The metrics of the images under weightings.
        clusters: int ``(I,)``.
        draws: B.
        seed: Of the draws.

    Returns:
        Name to float64 ``(B,)``.

    Example:
        Micro F1 of images with tallies ``(I, 3)`` of true positives, false positives and false negatives:

        >>> tallies = np.array([[3.0, 1, 0], [2, 0, 2]])
        >>> def f1(weights):
        ...     tp, fp, fn = (weights @ tallies).T
        ...     return {"f1": 2 * tp / (2 * tp + fp + fn)}
        >>> bootstrap(f1, [0, 1], 4, seed=0)["f1"].shape
        (4,)
    """
    blocks = [measure(weights) for weights in weight_blocks(clusters, draws, seed=seed)]
    return {name: np.concatenate([block[name] for block in blocks]) for name in blocks[0]}


def estimates(
    measure: Measure, clusters: ArrayLike, draws: int = DRAWS, *, seed: int, level: float = LEVEL
) -> dict[str, Estimate]:
    """Return the metrics of the images as they are, each with its interval.

    The interval is absent where there are fewer than two clusters, and leaves out draws in which a metric isn't
    defined.

    Raises:
        InvalidInput: When there are no images or no draws, or the level isn't in (0, 1).
    """
    cluster = np.asarray(clusters)
    values = measure(np.ones((1, len(cluster))))
    if len(np.unique(cluster)) < FEWEST_CLUSTERS:
        return {name: Estimate(or_none(value[0]), None, None) for name, value in values.items()}
    drawn = bootstrap(measure, cluster, draws, seed=seed)
    found = {}
    for name, value in values.items():
        low, high = interval(drawn[name], level)
        found[name] = Estimate(or_none(value[0]), or_none(low), or_none(high))
    return found


def interval(values: NDArray[np.float64], level: float = LEVEL) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the percentiles that the share ``level`` of the draws lies between.

    Args:
        values: float64 ``(B, ...)``; NaN is left out.
        level: Share of draws within, in (0, 1).

    Returns:
        Lower and upper end, float64 ``(...)``; NaN where no draw is defined.

    Raises:
        InvalidInput: When the level isn't in (0, 1).

    Example:
        >>> [round(float(end), 3) for end in interval(np.arange(101.0), 0.9)]
        [5.0, 95.0]
    """
    if not 0 < level < 1:
        raise InvalidInput(f"an interval can't hold the share {level}", where="level", expected="between 0 and 1")
    shares = [(1 - level) / 2, (1 + level) / 2]
    undefined = np.isnan(values)
    if not undefined.any():
        low, high = np.quantile(values, shares, axis=0)
        return low, high
    nowhere = undefined.all(axis=0)
    low, high = np.nanquantile(np.where(nowhere, 0.0, values), shares, axis=0)
    return np.where(nowhere, np.nan, low), np.where(nowhere, np.nan, high)


def or_none(value: float | NDArray[np.float64]) -> float | None:
    """Return a number for JSON: ``None`` where it is not finite."""
    number = float(value)
    return number if np.isfinite(number) else None
