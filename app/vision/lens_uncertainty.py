"""How far off a fitted lens may be, in px over the frame, and whether that is good enough to be used.

A covariance of parameters helps nobody; what counts is how far points of the corrected image may lie from where they
should, after the homography that lines can't determine. Two numbers say so. `pred` follows from the curvature of the
likelihood at the answer; `scan_spread` from the whole scan of k1, so that a second, far answer that fits nearly as
well shows. Segments of one scene share causes of error (a kerb seen as five pieces), so the data count for less than
independent ones would.
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
from app.vision.lens_fit import PRIOR_SD, LensFit, scan_spread

Array = NDArray[np.float64]

TEMPERATURE = 2.0
"""By how much the evidence of segments is divided: those of one scene aren't independent. The curvature within a basin
is trusted more than the scan, which has to tell a wrong basin from the right one."""
MODEL_ERROR = 0.0015
"""Share of the half diagonal that a real lens is away from the model family."""
MOST_PREDICTED = 0.3
MOST_SPREAD = 0.65
"""Largest `pred` and `scan_spread` to accept, as shares of the size of the correction."""


class LensUncertainty(NamedTuple):
    """Uncertainty of a lens, all in px RMS over the frame.

    Attributes:
        pred: Predicted field error.
        scan_spread: Standard deviation of the posterior of k1 over all plausible lenses, as a field.
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
    slope2, slope3 = fit.bend.quadratic_slope, fit.bend.cubic_slope
    weight = (fit.responsibility / fit.mixture.sigma**2)[:, None]
    information = (weight * slope2).T @ slope2 + (weight * slope3).T @ slope3
    covariance = np.linalg.inv(information / TEMPERATURE + np.diag(PRIOR_SD**-2))
    sensitivity = field_sensitivity(fit.parameters, width, height)
    chance = float(np.sqrt(max(np.trace(covariance @ sensitivity), 0.0)))
    pred = math.hypot(chance, MODEL_ERROR * half_diagonal(width, height))

    spread = scan_spread(fit.scan) * float(np.sqrt(sensitivity[0, 0]))
    lens = Division.from_parameters(width, height, fit.parameters)
    correction = field_error(Brown.identity(width, height), lens, width, height).rms
    return LensUncertainty(pred, spread, correction)


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


def reasons_to_refuse(uncertainty: LensUncertainty, trusted: float) -> list[str]:
    """Return why a lens shouldn't be used, in words; an empty list if it may be.

    Args:
        uncertainty: Of the lens.
        trusted: Number of segments that the fit took to be straight.
    """
    pred, spread, correction = uncertainty
    reasons = []
    if pred >= MOST_PREDICTED * correction:
        reasons.append(
            f"not enough information: the predicted error of {pred:.1f} px isn't small against the correction of"
            f" {correction:.1f} px ({trusted:.0f} trusted segments)"
        )
    if spread >= MOST_SPREAD * correction:
        reasons.append(
            f"not enough information: other lenses fit nearly as well, {spread:.1f} px apart, against a correction of"
            f" {correction:.1f} px"
        )
    return reasons
