"""The Ladder: which of someone's submissions a board shows as the best, so that nobody climbs on noise.

Whoever may submit again and again and sees every score can fit the test labels without learning anything about lines.
The Ladder shows a new best only when it exceeds the one shown by more than the noise of their difference, and shows it
rounded; what isn't shown says no more than that. Source: Blum and Hardt, "The Ladder: a reliable leaderboard for
machine learning competitions" (ICML 2015), whose parameter-free form asks for one standard error of the paired
difference of losses. F1 is no mean of losses, so the standard error is that of the paired bootstrap.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from app.errors import InvalidInput

STEP = 1e-3
"""Least rise of a shown best, and what shown scores are rounded to."""


def ladder(values: NDArray[np.float64], drawn: NDArray[np.float64], step: float = STEP) -> NDArray[np.int64]:
    """Return which submission is shown as the best after each one.

    Args:
        values: float64 ``(T,)``, scores in the order of submission; more is better.
        drawn: float64 ``(T, B)``, scores of the same draws of the images for all (see ``bootstrap``).
        step: Least rise, whatever the noise.

    Returns:
        int64 ``(T,)``, rising: the index of the submission shown once the t-th has been scored.

    Raises:
        InvalidInput: When the shapes don't belong together.

    Example:
        >>> values, noise = np.array([0.5, 0.52, 0.7]), np.array([-0.1, 0.0, 0.1])
        >>> drawn = values[:, None] + np.stack([noise, -noise, noise])
        >>> ladder(values, drawn)
        array([0, 0, 2])
    """
    if values.ndim != 1 or drawn.ndim != 2 or len(drawn) != len(values):
        raise InvalidInput(
            f"{values.shape} scores don't go with {drawn.shape} draws", where="draws", expected="one row per score"
        )
    shown = np.zeros(len(values), np.int64)
    for index in range(1, len(values)):
        best = shown[index - 1]
        is_new = exceeds_noise(float(values[index] - values[best]), drawn[index] - drawn[best], step)
        shown[index] = index if is_new else best
    return shown


def exceeds_noise(rise: float, drawn: NDArray[np.float64], step: float = STEP) -> bool:
    """Return whether a rise is more than one standard error of itself, and at least a step.

    Args:
        rise: Score of the new submission less that of the one shown.
        drawn: float64 ``(B,)``, the same of each draw.
        step: Least rise.
    """
    return rise >= step and rise > float(np.std(drawn))
