"""The law of segments' bends: noise of known size if straight in the scene, a wide law if not.

Every segment is a draw from a mixture: straight, so that its quadratic and cubic amplitude under the right lens are
normal noise, or not, so that they follow a Laplace law of the size that kerbs, roofs and bonnets bend by. The noise is
predicted from each segment's roughness; how well that holds for a camera is read off its own segments.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from app.vision.bins import BinnedSegments
from app.vision.sampson import Bend

Array = NDArray[np.float64]

# The law of segments' amplitudes, by maximum likelihood on segments of indoor and street scenes under known lenses.
SHARE_BASE, SHARE_LENGTH, SHARE_ROUGHNESS = -0.79, 0.75, -2.73
SHARE_VERTICAL, SHARE_VERTICAL_LENGTH = 0.21, 1.07
QUADRATIC_SCALE, QUADRATIC_LENGTH, QUADRATIC_VERTICAL = 0.22, 0.68, 0.57
CUBIC_SCALE, CUBIC_LENGTH, CUBIC_VERTICAL = 0.042, -0.14, 0.62

NOISE_LIMITS = 0.1, 1.5
"""Least and largest factor by which a camera's noise may differ from what is predicted."""
NOISE_DOUBT = 2.0
"""Number of segments that the prediction counts for when the factor is read off."""
SMALLEST_BEND = 0.02
"""px; below this the Laplace law's parabola is taken as that of this amplitude."""


class Mixture(NamedTuple):
    """The law that each segment's amplitudes are drawn from, float64 ``(S,)`` each.

    Attributes:
        share: Log odds of being straight before any lens is looked at.
        sigma: px, predicted normal noise of both amplitudes of a straight segment.
        quadratic: px, Laplace scale of the quadratic amplitude of one that isn't straight.
        cubic: px, likewise of the cubic amplitude.
        noise: Factors by which the camera's noise differs from `sigma`, for the quadratic and the cubic amplitude.
    """

    share: Array
    sigma: Array
    quadratic: Array
    cubic: Array
    noise: tuple[float, float] = (1.0, 1.0)


class Equations(NamedTuple):
    """What each segment says about parameters, near those at which it was looked at.

    Attributes:
        gradient: float64 ``(S, P)`` of the negative log likelihood.
        normal: float64 ``(S, P, P)``, curvature of a parabola that lies above it (what a step needs).
        straight: float64 ``(S, P, P)``, information of the segment as far as it is straight.
        known: float64 ``(S, P, P)``, the same less what isn't known of whether it is.
    """

    gradient: Array
    normal: Array
    straight: Array
    known: Array


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
    share, sigma, wide2, wide3, (noise2, noise3) = mixture
    sigma2, sigma3 = noise2 * sigma, noise3 * sigma
    straight = -0.5 * ((left.quadratic / sigma2) ** 2 + (left.cubic / sigma3) ** 2) - np.log(
        2 * np.pi * sigma2 * sigma3
    )
    other = -np.abs(left.quadratic) / wide2 - np.abs(left.cubic) / wide3 - np.log(4 * wide2 * wide3)
    straight = straight - np.logaddexp(0, -share)
    both = np.logaddexp(straight, other - np.logaddexp(0, share))
    return np.exp(straight - both), -both


def with_noise_of(mixture: Mixture, left: Bend, probability: Array) -> Mixture:
    """Return the mixture with the noise read off the segments, those that are straight (a step of EM).

    Args:
        mixture: The law so far.
        left: Amplitudes left under the lens.
        probability: float64 ``(S,)``, of being straight.
    """

    def factor(amplitude: Array) -> float:
        squared = NOISE_DOUBT + float((probability * (amplitude / mixture.sigma) ** 2).sum())
        return float(np.clip(np.sqrt(squared / (NOISE_DOUBT + float(probability.sum()))), *NOISE_LIMITS))

    return mixture._replace(noise=(factor(left.quadratic), factor(left.cubic)))


def equations(left: Bend, mixture: Mixture) -> Equations:
    """Return what each segment says about the parameters that `left` has slopes by.

    The information of a mixture is that of its parts less what isn't known of which part it is (Louis 1982, "Finding
    the observed information matrix when using the EM algorithm").
    """
    probability, _ = responsibilities(left, mixture)
    straight = probability[:, None, None]
    gradient: Array = np.zeros_like(left.quadratic_slope)
    doubt: Array = np.zeros_like(left.quadratic_slope)
    normal = np.zeros((*gradient.shape, gradient.shape[1]))
    information = np.zeros_like(normal)
    for amplitude, slopes, wide, noise in (
        (left.quadratic, left.quadratic_slope, mixture.quadratic, mixture.noise[0]),
        (left.cubic, left.cubic_slope, mixture.cubic, mixture.noise[1]),
    ):
        precision = (noise * mixture.sigma) ** -2
        # |a| / b is touched from above at a by a parabola with this weight
        weight = probability * precision + (1 - probability) / (wide * np.maximum(np.abs(amplitude), SMALLEST_BEND))
        squares = slopes[:, :, None] * slopes[:, None]
        gradient += (weight * amplitude)[:, None] * slopes
        doubt += (amplitude * precision - np.sign(amplitude) / wide)[:, None] * slopes
        normal += weight[:, None, None] * squares
        information += precision[:, None, None] * squares
    missing = straight * (1 - straight) * doubt[:, :, None] * doubt[:, None]
    return Equations(gradient, normal, straight * information, straight * information - missing)
