"""Intervals by resampling whole images (Efron, 1979)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray


def interval(
    statistic: Callable[[NDArray[np.int64]], float], images: int, *, resamples: int = 1000, seed: int = 0
) -> tuple[float, float]:
    """Return the 95 % percentile interval of a statistic over images.

    Args:
        statistic: Called with how often each image is drawn, int64 ``(images,)``.
        images: Number of images.
        resamples: How many draws.
        seed: Of the draws; two statistics with one seed see the same draws.
    """
    draws = np.random.default_rng(seed).multinomial(images, np.full(images, 1 / images), size=resamples)
    low, high = np.percentile([statistic(weights) for weights in draws], [2.5, 97.5])
    return float(low), float(high)
