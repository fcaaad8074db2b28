"""Brown-Conrady coefficients by MSAC, as the ClearLines paper has it.

MSAC (Torr and Zisserman 2000, "MLESAC", section 4) draws minimal samples, solves each for a model, and keeps the model
of least cost ``C = sum rho(e^2)`` with ``rho(e^2) = e^2`` below the threshold and constant above it, so that inliers
count by how well they fit, where RANSAC only counts them. Here the data are segments: e is how far one still bends
under the model, in units of its noise. Two segments, each giving one strong constraint (its bend), determine k1 and
k2; the best sample's model is then refined on its inliers in all seven parameters under priors, without which the
centre and the tangential coefficients run away together.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.vision import brown
from app.vision.bins import BinnedSegments
from app.vision.brown import Brown
from app.vision.frame import center_of, half_diagonal
from app.vision.sampson import Bend, amplitudes_over, bend

Array = NDArray[np.float64]

BROWN = brown.map_points
PRIOR_SD = np.array([0.4, 0.1, 0.05, 0.002, 0.002, 0.02, 0.02])
"""Prior standard deviations of k1, k2, k3, p1, p2 and the centre's offset (half diagonals), around 0."""
THRESHOLD = 1.96
"""Errors beyond this many standard deviations, the 95 % point of one degree of freedom, are outliers."""
MOST_SCORED = 300
"""Segments that a hypothesis is scored on; of more, a random part."""


@dataclass(frozen=True, eq=False)
class MsacResult:
    """Result of `msac_brown`.

    Attributes:
        brown: The lens; the identity if there are no segments.
        cost: Mean of rho over all segments, from 0 (all fit perfectly) to `THRESHOLD` squared (none fits).
        inliers: bool ``(S,)``.
        hypotheses: Number of samples tried.
    """

    brown: Brown
    cost: float
    inliers: NDArray[np.bool_]
    hypotheses: int


def msac_brown(binned: BinnedSegments, width: int, height: int, *, seed: int = 0, hypotheses: int = 50) -> MsacResult:
    """Estimate a Brown-Conrady lens by MSAC; the same for the same seed.

    Args:
        binned: Segments of one camera.
        width: Image width in px.
        height: Image height in px.
        seed: Of the random samples.
        hypotheses: Number of samples to try.
    """
    if not len(binned):
        return MsacResult(Brown.identity(width, height), THRESHOLD**2, np.zeros(0, bool), 0)
    generator = np.random.default_rng(seed)
    scored = binned
    if len(binned) > MOST_SCORED:
        scored = binned.select(np.sort(generator.choice(len(binned), MOST_SCORED, replace=False)))
    unbent = bend(scored, BROWN, np.zeros(7), slopes=(0, 1))
    trials = np.zeros((hypotheses + 1, 7))
    for trial in trials[1:]:
        sample = generator.choice(len(scored), min(2, len(scored)), replace=False)
        trial[:] = _step(np.zeros(7), (0, 1), unbent, scored.sigma, sample)
    errors = (amplitudes_over(scored, BROWN, trials)[0] / scored.sigma) ** 2
    best = trials[np.argmin(np.minimum(errors, THRESHOLD**2).mean(axis=1))]
    parameters = _polish(binned, best, width, height)
    errors = squared_errors(binned, bend(binned, BROWN, parameters))
    return MsacResult(_lens(parameters, width, height), mean_cost(errors), errors < THRESHOLD**2, hypotheses)


def squared_errors(binned: BinnedSegments, left: Bend) -> Array:
    """Return e^2 of each segment, float64 ``(S,)``: its quadratic amplitude in units of its noise, squared."""
    return (left.quadratic / binned.sigma) ** 2


def mean_cost(errors: Array) -> float:
    """Return the mean of rho over squared errors ``(S,)``."""
    return float(np.minimum(errors, THRESHOLD**2).mean())


def _polish(binned: BinnedSegments, start: Array, width: int, height: int) -> Array:
    """Refine on the inliers, their threshold shrinking; keep what costs least and is invertible."""
    parameters, best, best_cost = start, start, np.inf
    for free in ((0, 1), tuple(range(7))):
        left = bend(binned, BROWN, parameters, slopes=free)
        if not np.isfinite(best_cost):
            best_cost = mean_cost(squared_errors(binned, left))
        for widening in (3.0, 2.0, 1.0, 1.0):
            inlier = np.flatnonzero(squared_errors(binned, left) < (widening * THRESHOLD) ** 2)
            parameters = _step(parameters, free, left, binned.sigma, inlier)
            left = bend(binned, BROWN, parameters, slopes=free)
            cost = mean_cost(squared_errors(binned, left))
            if cost < best_cost and _lens(parameters, width, height).is_invertible():
                best, best_cost = parameters, cost
    return best


def _step(start: Array, free: tuple[int, ...], left: Bend, sigma: Array, chosen: NDArray[np.int64]) -> Array:
    """Take a Gauss-Newton step that straightens the chosen segments, under the priors; `left` has the free slopes."""
    rows, parameters = list(free), start.copy()
    precision = PRIOR_SD[rows] ** -2
    slope = left.quadratic_slope[chosen]
    weighted = slope / sigma[chosen, None] ** 2
    gradient = weighted.T @ left.quadratic[chosen] + precision * parameters[rows]
    parameters[rows] -= np.linalg.solve(weighted.T @ slope + np.diag(precision), gradient)
    # no lens of a camera lies farther out, and far out the model folds and its slopes mean nothing
    limit = 4 * PRIOR_SD[rows]
    parameters[rows] = np.clip(parameters[rows], -limit, limit)
    return parameters


def _lens(parameters: Array, width: int, height: int) -> Brown:
    scale, (xc, yc) = half_diagonal(width, height), center_of(width, height)
    k1, k2, k3, p1, p2, cx, cy = (float(value) for value in parameters)
    return Brown(width, height, (xc + scale * cx, yc + scale * cy), scale, (k1, k2, k3), (p1, p2))
