"""Whether two sets of images put detectors into one order: rank correlation, with an interval over the images."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.stats import kendalltau, spearmanr


@dataclass(frozen=True)
class Agreement:
    """Rank correlations of two orders of the same detectors, with the ends of their 95 % intervals.

    Attributes:
        spearman: Spearman's rho.
        spearman_interval: Its interval.
        kendall: Kendall's tau b.
        kendall_interval: Its interval.
    """

    spearman: float
    spearman_interval: tuple[float, float]
    kendall: float
    kendall_interval: tuple[float, float]


def agreement(
    here: NDArray[np.float64],
    there: NDArray[np.float64],
    draws_here: NDArray[np.float64],
    draws_there: NDArray[np.float64],
) -> Agreement:
    """Compare the scores of D detectors on two sets of images.

    Args:
        here: Scores on the one set, ``(D,)``.
        there: On the other.
        draws_here: Scores when the images of that set are drawn anew, ``(B, D)``.
        draws_there: Likewise; the sets are drawn independently.
    """
    pairs = list(zip(draws_here, draws_there, strict=True))
    rhos = np.array([_spearman(one, other) for one, other in pairs])
    taus = np.array([_kendall(one, other) for one, other in pairs])
    return Agreement(_spearman(here, there), _interval(rhos), _kendall(here, there), _interval(taus))


def draws(images: int, resamples: int, seed: int) -> NDArray[np.int64]:
    """Return how often each image is taken when as many are drawn with replacement, int64 ``(resamples, images)``."""
    return np.random.default_rng(seed).multinomial(images, np.full(images, 1 / images), size=resamples)


def places(scores: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return each detector's place, 1 for the greatest score, int64 ``(D,)``; of equal scores the first comes first."""
    order = np.argsort(-scores, kind="stable")
    place = np.empty(len(scores), np.int64)
    place[order] = np.arange(1, len(scores) + 1)
    return place


def _spearman(one: NDArray[np.float64], other: NDArray[np.float64]) -> float:
    return float(np.asarray(spearmanr(one, other))[0])


def _kendall(one: NDArray[np.float64], other: NDArray[np.float64]) -> float:
    return float(np.asarray(kendalltau(one, other))[0])


def _interval(values: NDArray[np.float64]) -> tuple[float, float]:
    low, high = np.percentile(values, [2.5, 97.5])
    return float(low), float(high)
