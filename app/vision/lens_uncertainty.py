"""How far off a fitted lens may be, in px over the frame, and whether that is good enough to be used.

A covariance of parameters helps nobody; what counts is how far points of the corrected image may lie from where they
should, after the homography that lines can't determine. Two numbers say so. `scan_spread` is the spread of all
plausible lenses of one parameter, so that a second, far answer that fits nearly as well shows; `pred` adds the
curvature of the likelihood at the answer in all parameters. Both count evidence by structures, of which each may bend
by its own (`app.vision.lens_evidence`): one kerb or bonnet found as five pieces stays one witness.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from app.vision import division
from app.vision.brown import Brown
from app.vision.division import Division
from app.vision.field import field_error, observable_part
from app.vision.frame import center_of, frame_grid, half_diagonal
from app.vision.lens_evidence import TEMPERATURE, structure_sd, sum_structures
from app.vision.lens_fit import RUNGS, LensFit, prior_sd

Array = NDArray[np.float64]

MODEL_ERROR = 0.0015
"""Share of the half diagonal that a real lens is away from the model family."""
MOST_PREDICTED = 0.42
"""Largest `pred` to accept, as a share of the size of the correction: what isn't 2.4 times its own predicted error
could well be worse than no correction."""


class LensUncertainty(NamedTuple):
    """Uncertainty of a lens, all in px RMS over the frame.

    Attributes:
        pred: Predicted field error.
        scan_spread: Standard deviation of k1 over all plausible lenses, as a field.
        correction: Size of the correction itself: the field error that doing nothing would have, were the lens right.
    """

    pred: float
    scan_spread: float
    correction: float


def lens_uncertainty(fit: LensFit, width: int, height: int) -> LensUncertainty:
    """Return the uncertainty of a fit of `app.vision.lens_fit`.

    Args:
        fit: The fit.
        width: Image width in px.
        height: Image height in px.
    """
    sensitivity = field_sensitivity(fit.parameters, width, height)
    chance = float(np.sqrt(max(np.trace(covariance(fit) @ sensitivity), 0.0)))
    spread = fit.posterior.sd * float(np.sqrt(sensitivity[0, 0]))
    # where more than k1 was released, lenses of k1 alone have been outvoted and their spread says nothing
    known = max(chance, spread) if fit.free == RUNGS[0] else chance
    pred = math.hypot(known, MODEL_ERROR * half_diagonal(width, height))
    lens = Division.from_parameters(width, height, fit.parameters)
    correction = field_error(Brown.identity(width, height), lens, width, height).rms
    return LensUncertainty(pred, spread, correction)


def covariance(fit: LensFit) -> Array:
    """Return the covariance of the five parameters, released or not, float64 ``(5, 5)``.

    A structure's own k1, of variance v, is eliminated: it leaves I - I e e' I / (1 / v + e' I e) of the information I
    (Woodbury), e being the direction of k1.
    """
    weight = fit.responsibility / fit.mixture.sigma**2 / TEMPERATURE
    slopes = np.stack([fit.bend.quadratic_slope, fit.bend.cubic_slope])
    each = np.einsum("s,dsi,dsj->sij", weight, slopes, slopes)
    found, own = sum_structures(each, fit.structure)
    along = own[:, :, 0]
    shared = along[:, :, None] * along[:, None] / (structure_sd(found) ** -2 + along[:, 0])[:, None, None]
    information = np.diag(prior_sd(fit.parameters) ** -2) + (own - shared).sum(0)
    return np.linalg.inv(information)


def field_sensitivity(parameters: Array, width: int, height: int) -> Array:
    """Return the quadratic form that turns small changes of the parameters into px^2 of mean squared field error.

    Args:
        parameters: float64 ``(5,)`` of the division model.
        width: Image width in px.
        height: Image height in px.

    Returns:
        float64 ``(5, 5)``, what a homography can imitate taken out.
    """
    scale = half_diagonal(width, height)
    x, y = ((frame_grid(width, height, 24) - center_of(width, height)) / scale).T
    mapped = division.map_points(parameters, x, y)
    dx, dy = division.map_derivatives(parameters, x, y)
    fields = np.concatenate([dx, dy], axis=1).T
    left = observable_part(np.stack([mapped.x, mapped.y], -1), fields)
    return scale**2 * (left.T @ left) / len(x)


def reasons_to_refuse(uncertainty: LensUncertainty, trusted: int) -> list[str]:
    """Return why a lens shouldn't be used, in words; an empty list if it may be.

    Args:
        uncertainty: Of the lens.
        trusted: Number of segments that the fit took to be straight.
    """
    pred, spread, correction = uncertainty
    if pred < MOST_PREDICTED * correction:
        return []
    if spread >= MOST_PREDICTED * correction:
        why = f"other lenses fit nearly as well, {spread:.1f} px apart, where different parts of the scene disagree or"
        why += " too few of them tell"
    else:
        why = f"the predicted error is {pred:.1f} px"
    return [f"not enough information: {why}; the correction would be {correction:.1f} px ({trusted} trusted segments)"]
