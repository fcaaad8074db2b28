"""All that is known of a lens near one answer, with structures that bend by their own as much as they are seen to.

Segments of one structure (`app.vision.lens_evidence`) share a k1 of their own, b ~ N(0, (t sd)^2). How much structures
bend differs between scenes: those of a building agree to the width of their noise, kerbs and hedges don't. So t isn't
fixed: every value on a grid is a hypothesis, weighted by how well it explains the disagreement that is seen (marginal
likelihood; Gelman, "Prior distributions for variance parameters in hierarchical models", 2006, on why to average over
it). Likewise of which kind the lens is, and k2 and k3: nearly none, as of most lenses, or as large as those of wide
ones (spike and slab; George and McCulloch 1993). Each hypothesis is a linear model with normal errors, so it has its
answer in closed form; b is eliminated by Woodbury's identity. The estimate is their average, and what they disagree on
is part of its uncertainty.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from app.vision.lens_evidence import KINDS, SCAN, STRAY, structure_sd, sum_structures
from app.vision.lens_mixture import Equations

Array = NDArray[np.float64]

BENDING = np.array([0.0, 0.1, 0.2, 0.4, 0.7, 1.0, 1.4])
"""Values of t."""
BENDING_WEIGHT = np.array([0.05, 0.15, 0.3, 1.0, 1.0, 1.0, 0.7])
"""Their prior weights: structures of real scenes that don't bend at all are rare."""
PRIOR_SD = np.array([0.1, 0.15, 0.01, 0.01])
"""Prior standard deviations of k2, k3 and the centre's offset, in half diagonals, around 0; those of k2 and k3 hold for
a lens of `WIDE` k1."""
WIDE, LEAST_SHARE = 0.2, 0.2
"""Higher coefficients are the larger the wider a lens is; this share of their prior remains where k1 is 0."""
SPIKE = 0.1
"""Share of the prior's standard deviation left to k2 and k3 where they are taken to be nearly none."""
SPIKE_WEIGHT, SLAB_WEIGHT = 3.0, 2.0
LEAST_CURVATURE = 1.0
"""Structures that tell k1 by less aren't asked whether they are astray."""
LEAST_KNOWN = 0.1
"""Least share of a structure's information that remains when it isn't known which of its segments are straight."""


class LensPosterior(NamedTuple):
    """A mixture of H normal laws of the five parameters.

    Attributes:
        weight: float64 ``(H,)``, adding up to 1; hypotheses of one t lie next to one another.
        parameters: float64 ``(H, 5)``, means.
        covariance: float64 ``(H, 5, 5)``.
    """

    weight: Array
    parameters: Array
    covariance: Array

    @property
    def mean(self) -> Array:
        """Mean of all, float64 ``(5,)``."""
        return self.weight @ self.parameters


class Priors(NamedTuple):
    """A mixture of P normal laws of the five parameters, each with independent ones.

    Attributes:
        mean: float64 ``(P, 5)``.
        sd: float64 ``(P, 5)``, standard deviations.
        weight: float64 ``(P,)``, adding up to 1.
    """

    mean: Array
    sd: Array
    weight: Array


def higher_sds(k1: float) -> Array:
    """Return the priors' standard deviations of all but k1, nearly without k2 and k3 and with, float64 ``(2, 4)``.

    Args:
        k1: Roughly the lens's k1: its size sets the priors.
    """
    slab = PRIOR_SD.copy()
    slab[:2] *= LEAST_SHARE + (1 - LEAST_SHARE) * abs(k1) / WIDE
    spike = slab.copy()
    spike[:2] *= SPIKE
    return np.stack([spike, slab])


def priors(k1: float) -> Priors:
    """Return the priors of all five parameters: each kind of lens, nearly without k2 and k3 and with.

    Args:
        k1: Roughly the lens's k1, see `higher_sds`.
    """
    mean, sd, weight = np.zeros((2, 2, 5)), np.empty((2, 2, 5)), np.empty((2, 2))
    for row, kind in enumerate(KINDS):
        mean[row, :, 0], sd[row, :, 0], sd[row, :, 1:] = kind.mean, kind.sd, higher_sds(k1)
        weight[row] = np.array([SPIKE_WEIGHT, SLAB_WEIGHT]) * kind.share
    return Priors(mean.reshape(-1, 5), sd.reshape(-1, 5), weight.ravel() / weight.sum())


def lens_posterior(
    said: Equations, structure: NDArray[np.int64], parameters: Array, k1: float, *, steps: bool
) -> LensPosterior:
    """Combine what segments say near some parameters.

    Args:
        said: By each segment, at the parameters.
        structure: int64 ``(S,)`` from `app.vision.lens_evidence.structures`.
        parameters: float64 ``(5,)``.
        k1: Roughly the lens's k1, for the priors.
        steps: Whether the means are wanted for a next step (which must not overshoot) or the covariances for good.
    """
    found, gradient = sum_structures(said.gradient, structure)
    curvature = sum_structures(said.normal if steps else said.straight, structure)[1]
    if not steps:
        known = sum_structures(said.known, structure)[1][:, 0, 0] / np.maximum(curvature[:, 0, 0], 1e-12)
        curvature = curvature * np.clip(known, LEAST_KNOWN, 1.0)[:, None, None]
    laws = priors(k1)
    away = parameters - laws.mean
    precision = np.eye(5) * laws.sd[:, None] ** -2
    score: list[Array] = []
    means: list[Array] = []
    covariances: list[Array] = []
    for bending, weight in zip(BENDING, BENDING_WEIGHT, strict=True):
        normal, pull, fits = _eliminated(gradient, curvature, (bending * structure_sd(found)) ** 2)
        downhill = pull + away / laws.sd**2
        covariance = np.asarray(np.linalg.inv(precision + normal), np.float64)
        step = np.einsum("pij,pj->pi", covariance, downhill)
        gain = 0.5 * (downhill * step - (away / laws.sd) ** 2).sum(1)
        occam = 0.5 * np.linalg.slogdet(covariance)[1] - np.log(laws.sd).sum(1)
        score.append(fits + gain + occam + np.log(weight * laws.weight))
        means.append(parameters - step)
        covariances.append(covariance)
    weight = np.exp(np.concatenate(score) - np.max(score))
    return LensPosterior(weight / weight.sum(), np.concatenate(means), np.concatenate(covariances))


def _eliminated(gradient: Array, curvature: Array, variance: Array) -> tuple[Array, Array, float]:
    """Sum over structures, of which each has a k1 of its own of a variance ``(G,)``.

    Returns:
        Curvature ``(5, 5)`` and gradient ``(5,)`` of the negative log likelihood, and how much better it is explained.
    """
    slope, along, own = gradient[:, 0], curvature[:, :, 0], curvature[:, 0, 0]
    share = variance / (1 + variance * own)
    bound = np.log(1 - STRAY) + 0.5 * share * slope**2 - 0.5 * np.log1p(variance * own)
    # one that is astray may have any k1 of the scan
    safe = np.maximum(own, LEAST_CURVATURE)
    free = np.log(STRAY / np.ptp(SCAN)) + 0.5 * slope**2 / safe + 0.5 * np.log(2 * np.pi / safe)
    both = np.logaddexp(bound, np.where(own > LEAST_CURVATURE, free, -np.inf))
    trust = np.exp(bound - both)
    normal = curvature - share[:, None, None] * along[:, :, None] * along[:, None]
    pull = gradient - (share * slope)[:, None] * along
    return np.einsum("g,gij->ij", trust, normal), trust @ pull, float(both.sum())
