"""Robust fit of a division-model lens to segments of which many are not straight lines of the scene.

Every segment is a draw from a mixture: straight, so that its quadratic and cubic amplitude under the right lens are
noise of known size, or not, so that they follow a Laplace law of the size that kerbs, roofs and bonnets bend by. A scan
over all plausible lenses (in place of sampling) gives k1 with what is known of it, see `app.vision.lens_evidence`.
Where that is enough, further parameters are released one rung of a ladder at a time by Levenberg-Marquardt steps with
responsibilities, each rung only if the data ask for it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from app.vision import division
from app.vision.bins import BinnedSegments
from app.vision.division import Division
from app.vision.lens_evidence import BARREL_SD, PINCUSHION_SD, SCAN, K1Posterior, k1_posterior, structures
from app.vision.sampson import Bend, bend

Array = NDArray[np.float64]

DIVISION = division.map_points
PRIOR_SD = np.array([BARREL_SD, 0.1, 0.15, 0.01, 0.01])
"""Prior standard deviations of k1, k2, k3 and the centre's offset, in half diagonals, around 0."""
RUNGS = ((0,), (0, 3, 4), (0, 1, 3, 4), (0, 1, 2, 3, 4))
"""Parameters that are free on each rung of the ladder."""
RUNG_GAIN = 6.0
"""Drop of the penalised negative log likelihood that releases a rung's parameters."""
SURE_OF_K1 = 0.05
"""Standard deviation of k1 above which nothing further is released: what isn't sure of k1 can't tell more."""
FIRST = np.eye(5)[0]

# The law of segments' amplitudes, by maximum likelihood on segments of indoor and street scenes under known lenses.
SHARE_BASE, SHARE_LENGTH, SHARE_ROUGHNESS = -0.79, 0.75, -2.73
SHARE_VERTICAL, SHARE_VERTICAL_LENGTH = 0.21, 1.07
QUADRATIC_SCALE, QUADRATIC_LENGTH, QUADRATIC_VERTICAL = 0.22, 0.68, 0.57
CUBIC_SCALE, CUBIC_LENGTH, CUBIC_VERTICAL = 0.042, -0.14, 0.62


class Mixture(NamedTuple):
    """The law that each segment's amplitudes are drawn from, float64 ``(S,)`` each.

    Attributes:
        share: Log odds of being straight before any lens is looked at.
        sigma: px, normal noise of both amplitudes of a straight segment.
        quadratic: px, Laplace scale of the quadratic amplitude of one that isn't straight.
        cubic: px, likewise of the cubic amplitude.
    """

    share: Array
    sigma: Array
    quadratic: Array
    cubic: Array


@dataclass(frozen=True, eq=False)
class LensFit:
    """Result of `fit_lens`.

    Attributes:
        parameters: float64 ``(5,)``: k1, k2, k3 and the centre's offset in half diagonals.
        free: Indices of the parameters that were released.
        mixture: The law that the segments were taken to follow.
        responsibility: float64 ``(S,)`` in [0, 1], probability of each segment of being straight under the lens.
        bend: Amplitudes left under the lens, with derivatives by all parameters.
        posterior: What is known of k1 alone; its mean is the answer where nothing further was released.
        structure: int64 ``(S,)``, which structure each segment was counted to.
    """

    parameters: Array
    free: tuple[int, ...]
    mixture: Mixture
    responsibility: Array
    bend: Bend
    posterior: K1Posterior
    structure: NDArray[np.int64]


def fit_lens(binned: BinnedSegments, width: int, height: int) -> LensFit:
    """Fit a division-model lens; deterministic, needs at least one segment.

    Args:
        binned: Segments of one camera.
        width: Image width in px.
        height: Image height in px.
    """
    mixture, structure = mixture_of(binned), structures(binned)
    scan = np.array([responsibilities(bend(binned, DIVISION, k1 * FIRST), mixture)[1] for k1 in SCAN])
    posterior = k1_posterior(scan, structure)
    parameters, free = posterior.mean * FIRST, RUNGS[0]
    if posterior.sd < SURE_OF_K1:
        released, loss = refine(binned, mixture, parameters, RUNGS[0])
        for rung in RUNGS[1:]:
            trial, trial_loss = refine(binned, mixture, released, rung)
            if loss - trial_loss >= RUNG_GAIN and Division.from_parameters(width, height, trial).is_invertible():
                parameters, released, loss, free = trial, trial, trial_loss, rung
    left = bend(binned, DIVISION, parameters, slopes=range(5))
    return LensFit(parameters, free, mixture, responsibilities(left, mixture)[0], left, posterior, structure)


def mixture_of(binned: BinnedSegments) -> Mixture:
    """Return the law of each segment's amplitudes, from its length, direction and roughness."""
    size = np.log(binned.length / 100)
    upright = binned.vertical.astype(np.float64)
    share = SHARE_BASE + SHARE_LENGTH * size + SHARE_ROUGHNESS * np.log(np.maximum(binned.roughness, 0.02) / 0.15)
    share = share + upright * (SHARE_VERTICAL + SHARE_VERTICAL_LENGTH * size)
    quadratic = QUADRATIC_SCALE * np.exp(QUADRATIC_LENGTH * size) * QUADRATIC_VERTICAL**upright
    cubic = CUBIC_SCALE * np.exp(CUBIC_LENGTH * size) * CUBIC_VERTICAL**upright
    sigma = binned.sigma
    return Mixture(share, sigma, np.hypot(quadratic, sigma), np.hypot(cubic, sigma))


def responsibilities(left: Bend, mixture: Mixture) -> tuple[Array, Array]:
    """Return per segment the probability of being straight and the negative log likelihood, float64 ``(S,)`` each."""
    share, sigma, wide2, wide3 = mixture
    straight = -0.5 * (left.quadratic**2 + left.cubic**2) / sigma**2 - np.log(2 * np.pi * sigma**2)
    other = -np.abs(left.quadratic) / wide2 - np.abs(left.cubic) / wide3 - np.log(4 * wide2 * wide3)
    straight = straight - np.logaddexp(0, -share)
    both = np.logaddexp(straight, other - np.logaddexp(0, share))
    return np.exp(straight - both), -both


def prior_sd(parameters: Array) -> Array:
    """Return the priors' standard deviations that hold at parameters ``(5,)``: k1's depends on its sign."""
    return np.where(FIRST * parameters < 0, PINCUSHION_SD, PRIOR_SD)


def refine(
    binned: BinnedSegments,
    mixture: Mixture,
    start: Array,
    free: tuple[int, ...],
    *,
    iterations: int = 20,
    tolerance: float = 1e-2,
) -> tuple[Array, float]:
    """Lower the penalised loss by Levenberg-Marquardt steps with responsibilities and reweighted outliers.

    Args:
        binned: Segments of one camera.
        mixture: Their law.
        start: float64 ``(5,)``.
        free: Indices of the parameters that may change.
        iterations: Most steps to try.
        tolerance: Gain of loss at which to stop.

    Returns:
        Parameters ``(5,)`` and their penalised loss, which is never above that of the start.
    """
    rows = list(free)
    parameters, damping = start.copy(), 1e-3
    left = bend(binned, DIVISION, parameters, slopes=rows)
    loss = _loss(left, mixture, parameters)
    for _ in range(iterations):
        normal, gradient = _normal_equations(left, mixture)
        precision = prior_sd(parameters)[rows] ** -2
        normal += np.diag(precision)
        gradient += precision * parameters[rows]
        trial = parameters.copy()
        trial[rows] -= np.linalg.solve(normal + damping * np.diag(np.diag(normal)), gradient)
        trial_left = bend(binned, DIVISION, trial, slopes=rows)
        trial_loss = _loss(trial_left, mixture, trial)
        gain = loss - trial_loss
        if gain > 0:
            parameters, left, loss, damping = trial, trial_left, trial_loss, damping / 10
        else:
            damping *= 10
        if 0 <= gain < tolerance or damping > 1e4:
            break
    return parameters, loss


def _normal_equations(left: Bend, mixture: Mixture) -> tuple[Array, Array]:
    """Return the Gauss-Newton matrix and the gradient of the loss without priors, for the parameters with slopes."""
    probability, _ = responsibilities(left, mixture)
    number = left.quadratic_slope.shape[1]
    normal, gradient = np.zeros((number, number)), np.zeros(number)
    for amplitude, slopes, wide in (
        (left.quadratic, left.quadratic_slope, mixture.quadratic),
        (left.cubic, left.cubic_slope, mixture.cubic),
    ):
        # |a| / b is touched from above at a by a parabola with this weight
        weight = probability / mixture.sigma**2 + (1 - probability) / (wide * np.maximum(np.abs(amplitude), 0.02))
        normal += (slopes * weight[:, None]).T @ slopes
        gradient += slopes.T @ (weight * amplitude)
    return normal, gradient


def _loss(left: Bend, mixture: Mixture, parameters: Array) -> float:
    """Return the negative log likelihood of the mixture plus that of the priors."""
    return float(responsibilities(left, mixture)[1].sum() + 0.5 * ((parameters / prior_sd(parameters)) ** 2).sum())
