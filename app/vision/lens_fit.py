"""Robust fit of a division-model lens to segments of which many are not straight lines of the scene.

Every segment is a draw from a mixture: straight, so that its quadratic and cubic amplitude under the right lens are
noise of known size, or not, so that they follow a Laplace law of the size that kerbs, roofs and bonnets bend by. A scan
of k1 over all plausible lenses finds the basin (in place of sampling), Levenberg-Marquardt steps with responsibilities
refine it, and further parameters are released one rung of a ladder at a time, each only if the data ask for it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from app.vision import division
from app.vision.bins import BinnedSegments
from app.vision.division import Division
from app.vision.sampson import Bend, bend

Array = NDArray[np.float64]

DIVISION = division.map_points
PRIOR_SD = np.array([0.2, 0.1, 0.15, 0.01, 0.01])
"""Prior standard deviations of k1, k2, k3 and the centre's offset, in half diagonals, around 0."""
SCAN = np.linspace(-0.25, 0.5, 76)
RUNGS = ((0,), (0, 3, 4), (0, 1, 3, 4), (0, 1, 2, 3, 4))
"""Parameters that are free on each rung of the ladder."""
RUNG_GAIN = 6.0
"""Drop of the penalised negative log likelihood that releases a rung's parameters."""
SURE_OF_K1 = 0.05
"""Spread of k1 over the scan above which nothing further is released: what isn't sure of k1 can't tell more."""
SCAN_TEMPERATURE = 4.0
"""By how much the scan's evidence is divided: segments of one scene aren't independent."""
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
        scan: float64 ``(76,)``, penalised negative log likelihood over `SCAN`, centre fixed.
        loss: Penalised negative log likelihood at the parameters.
    """

    parameters: Array
    free: tuple[int, ...]
    mixture: Mixture
    responsibility: Array
    bend: Bend
    scan: Array
    loss: float


def fit_lens(binned: BinnedSegments, width: int, height: int) -> LensFit:
    """Fit a division-model lens; deterministic, needs at least one segment.

    Args:
        binned: Segments of one camera.
        width: Image width in px.
        height: Image height in px.
    """
    mixture = mixture_of(binned)
    scan = np.array([_loss(bend(binned, DIVISION, k1 * FIRST), mixture, k1 * FIRST) for k1 in SCAN])
    parameters, loss = refine(binned, mixture, SCAN[int(np.argmin(scan))] * FIRST, RUNGS[0])
    free = RUNGS[0]
    for rung in RUNGS[1:] if scan_spread(scan) < SURE_OF_K1 else ():
        trial, trial_loss = refine(binned, mixture, parameters, rung)
        if loss - trial_loss >= RUNG_GAIN and Division.from_parameters(width, height, trial).is_invertible():
            parameters, loss, free = trial, trial_loss, rung
    left = bend(binned, DIVISION, parameters, slopes=range(5))
    return LensFit(parameters, free, mixture, responsibilities(left, mixture)[0], left, scan, loss)


def scan_spread(scan: Array) -> float:
    """Return the standard deviation of k1's posterior over the scan, which a second basin widens."""
    posterior = np.exp(-(scan - scan.min()) / SCAN_TEMPERATURE)
    posterior /= posterior.sum()
    return float(np.sqrt(posterior @ (SCAN - posterior @ SCAN) ** 2))


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
    precision = PRIOR_SD[rows] ** -2
    parameters, damping = start.copy(), 1e-3
    left = bend(binned, DIVISION, parameters, slopes=rows)
    loss = _loss(left, mixture, parameters)
    for _ in range(iterations):
        normal, gradient = _normal_equations(left, mixture)
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
    return float(responsibilities(left, mixture)[1].sum() + 0.5 * ((parameters / PRIOR_SD) ** 2).sum())
