"""Between which probabilities a candidate is left to a person.

Of calibrated probabilities the error of accepting is known beforehand: a candidate kept at probability p is wrong with
1 - p, one rejected with p. The thresholds let in as many as a wanted share of errors among those accepted allows.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from app.errors import InvalidInput


class Thresholds(NamedTuple):
    """Suggestions to keep are those of ``probability >= keep``, to reject those of ``probability < reject``."""

    keep: float
    reject: float


CHEAPEST = Thresholds(0.5, 0.5)
"""Least work: a wrong suggestion costs one correction, and so does one that is left open."""


def thresholds_for(probability: ArrayLike, error_rate: float) -> Thresholds:
    """Return thresholds at which the suggestions accepted are expected to be wrong at most at a wanted rate.

    Args:
        probability: Calibrated, ``(S,)``: of candidates like those that the thresholds are for.
        error_rate: Largest share of errors among the candidates kept, and likewise among those rejected, in [0, 1].

    Raises:
        InvalidInput: On an error rate out of [0, 1].

    Returns:
        ``keep`` from 0.5 up and ``reject`` up to 0.5.
    """
    if not 0 <= error_rate <= 1:
        raise InvalidInput(f"an error rate of {error_rate}", where="error_rate", expected="0 to 1")
    p = np.asarray(probability, np.float64)
    keep = 1 - _lowest_odds(1 - p[p >= 0.5], error_rate)
    reject = _lowest_odds(p[p < 0.5], error_rate)
    return Thresholds(keep, reject)


def _lowest_odds(wrong: np.ndarray, error_rate: float) -> float:
    """Return up to which probability of being wrong the mean of those let in stays within the rate."""
    wrong = np.sort(wrong)
    if not len(wrong):
        return 0.5 if error_rate >= 0.5 else error_rate
    mean = np.cumsum(wrong) / np.arange(1, len(wrong) + 1)
    allowed = int(np.searchsorted(mean, error_rate, side="right"))
    if allowed == len(wrong):
        return 0.5
    # a threshold lets in all that are alike, or none of them
    allowed = min(allowed, int(np.searchsorted(wrong, wrong[allowed])))
    return float(min(0.5, (wrong[allowed - 1] + wrong[allowed]) / 2 if allowed else wrong[0] * 0.5))
