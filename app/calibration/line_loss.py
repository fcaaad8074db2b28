"""The robust loss of one line: a few lines that were kept aren't straight, and must not decide.

A line is straight, with amplitudes of the law of `app.calibration.line_noise`: normal, with a scale of each line's own,
so Student's law of several dimensions (Lange, Little and Taylor 1989). A line that wavers in the degrees which no lens
reaches is thereby believed less in those that one does. Or it is no straight line at all, with amplitudes of any size.
The loss is the negative logarithm of the mixture, and the weights of a step are the probabilities of its parts (EM;
Dempster, Laird and Rubin 1977). The decision falls by line, not by point: what bends is the line.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.special import gammaln

from app.calibration.observations import DEGREES, LineObservations

Array = NDArray[np.float64]

BENT = 0.8 * (2 / DEGREES) ** 2.0
"""px, scale of the amplitudes (Laplace law) of lines that aren't straight."""


class LineLoss(NamedTuple):
    """Loss of lines at their amplitudes.

    Attributes:
        loss: float64 ``(S,)``.
        weight: float64 ``(S,)``, what counts of the precision of each line.
        pull: float64 ``(S, 5)``, derivative of the loss by the amplitudes.
        straight: float64 ``(S,)``, probability of being straight.
    """

    loss: Array
    weight: Array
    pull: Array
    straight: Array


def line_loss(lines: LineObservations, bends: Array, variance: Array, freedom: float) -> LineLoss:
    """Return the loss of lines.

    Args:
        lines: The lines.
        bends: Amplitudes, float64 ``(S, 5)`` px.
        variance: Of each were the line straight, likewise, px squared.
        freedom: Degrees of freedom of the straight lines' law.
    """
    known = lines.known
    ratio = np.where(known, bends**2 / variance, 0.0).sum(1)
    scale = np.sqrt(BENT**2 + variance)
    straight = np.log(lines.probability) - straight_loss(known, ratio, variance, freedom)
    bent = np.log1p(-lines.probability) - np.where(known, np.log(2 * scale) + np.abs(bends) / scale, 0.0).sum(1)
    total = np.logaddexp(straight, bent)
    probability = np.exp(straight - total)
    weight = probability * (freedom + known.sum(1)) / (freedom + ratio)
    pull = weight[:, None] * bends / variance + (1 - probability)[:, None] * np.sign(bends) / scale
    return LineLoss(-total, weight, np.where(known, pull, 0.0), probability)


def straight_loss(known: NDArray[np.bool_], ratio: Array, variance: Array, freedom: float) -> Array:
    """Return the loss of lines were they straight, ``(S,)``; `ratio` is the sum of squares over their variances."""
    size = known.sum(1)
    level = 0.5 * np.where(known, np.log(variance), 0.0).sum(1) + 0.5 * size * np.log(np.pi * freedom)
    level += gammaln(freedom / 2) - gammaln((freedom + size) / 2)
    return level + 0.5 * (freedom + size) * np.log1p(ratio / freedom)
