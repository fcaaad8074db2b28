"""Robust fit of a division-model lens to segments of which many are not straight lines of the scene.

A scan over all plausible lenses of one parameter (in place of sampling) gives k1 with what is known of it, see
`app.vision.lens_evidence`. Where that is enough, the answer is refined in all parameters: reweighted steps, each to the
mean of `app.vision.lens_hierarchy`, until they no longer move.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.vision import division
from app.vision.bins import BinnedSegments
from app.vision.division import Division
from app.vision.lens_evidence import SCAN, K1Posterior, k1_posterior, structures
from app.vision.lens_hierarchy import LensPosterior, higher_sds, lens_posterior
from app.vision.lens_mixture import Mixture, equations, mixture_of, responsibilities, with_noise_of
from app.vision.sampson import Bend, amplitudes_over, bend

Array = NDArray[np.float64]

DIVISION = division.map_points
SURE_OF_K1 = 0.045
"""Standard deviation of k1 above which nothing is refined: what isn't sure of k1 can't tell more."""
FIRST = np.eye(5)[0]
MOST_STEPS, FEWEST_STEPS = 12, 3
LARGEST_STEP = 0.15
"""Of k1; the steps' linear models hold for no more."""
STILL = 2e-4
"""Length of a step at which to stop."""


@dataclass(frozen=True, eq=False)
class LensFit:
    """Result of `fit_lens`.

    Attributes:
        parameters: float64 ``(5,)``: k1, k2, k3 and the centre's offset in half diagonals.
        refined: Whether more than k1 was estimated.
        mixture: The law that the segments were taken to follow.
        responsibility: float64 ``(S,)`` in [0, 1], probability of each segment of being straight under the lens.
        bend: Amplitudes left under the lens, with derivatives by all parameters.
        scan: What is known of k1 alone; its mean is the answer where nothing was refined.
        posterior: What is known of all parameters near the answer.
        structure: int64 ``(S,)``, which structure each segment was counted to.
    """

    parameters: Array
    refined: bool
    mixture: Mixture
    responsibility: Array
    bend: Bend
    scan: K1Posterior
    posterior: LensPosterior
    structure: NDArray[np.int64]


def fit_lens(binned: BinnedSegments, width: int, height: int) -> LensFit:
    """Fit a division-model lens; deterministic, needs at least one segment.

    Args:
        binned: Segments of one camera.
        width: Image width in px.
        height: Image height in px.
    """
    mixture, structure = mixture_of(binned), structures(binned)
    unsloped = np.zeros((0, 0))
    bends = Bend(*amplitudes_over(binned, DIVISION, SCAN[:, None] * FIRST), unsloped, unsloped)
    losses = responsibilities(bends, mixture)[1]
    scan = k1_posterior(losses, structure)
    if scan.sd < SURE_OF_K1:
        parameters, refined_mixture = refine(binned, mixture, structure, scan.mean)
        if Division.from_parameters(width, height, parameters).is_invertible():
            left = bend(binned, DIVISION, parameters, slopes=range(5))
            said = equations(left, refined_mixture)
            posterior = lens_posterior(said, structure, parameters, scan.mean, steps=False)
            probability, _ = responsibilities(left, refined_mixture)
            return LensFit(parameters, True, refined_mixture, probability, left, scan, posterior, structure)
    parameters = scan.mean * FIRST
    left = bend(binned, DIVISION, parameters, slopes=range(5))
    probability, _ = responsibilities(left, mixture)
    # of the other parameters no more is known than that they are those of a lens of the kind
    variance = np.diag([scan.sd**2, *(higher_sds(scan.mean)[0] ** 2)])
    posterior = LensPosterior(np.ones(1), parameters[None], variance[None])
    return LensFit(parameters, False, mixture, probability, left, scan, posterior, structure)


def refine(
    binned: BinnedSegments, mixture: Mixture, structure: NDArray[np.int64], k1: float, *, most_steps: int = MOST_STEPS
) -> tuple[Array, Mixture]:
    """Step from k1 alone to the answer in all parameters.

    Args:
        binned: Segments of one camera.
        mixture: Their law.
        structure: int64 ``(S,)``, of each segment.
        k1: Where to start.
        most_steps: Most steps to take.

    Returns:
        Parameters ``(5,)``, and the law with the camera's own noise.
    """
    parameters = k1 * FIRST
    for number in range(most_steps):
        left = bend(binned, DIVISION, parameters, slopes=range(5))
        posterior = lens_posterior(equations(left, mixture), structure, parameters, k1, steps=True)
        mixture = with_noise_of(mixture, left, responsibilities(left, mixture)[0])
        step = posterior.mean - parameters
        parameters = parameters + step * min(1.0, LARGEST_STEP / max(abs(float(step[0])), 1e-9))
        if number >= FEWEST_STEPS - 1 and np.linalg.norm(step) < STILL:
            break
    return parameters, mixture
