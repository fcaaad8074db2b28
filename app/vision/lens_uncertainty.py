"""How far off a fitted lens may be, in px over the frame, and whether that is good enough to be used.

A covariance of parameters helps nobody; what counts is how far points of the corrected image may lie from where they
should, after the homography that lines can't determine. `pred` is the error to be expected, over all that
`app.vision.lens_hierarchy` holds possible near the answer, over further answers of the scan that fit nearly as well,
and with what no lens of the family can follow. `scan_spread` is the spread of all plausible lenses of one parameter.
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
from app.vision.lens_evidence import SCAN
from app.vision.lens_fit import LensFit

Array = NDArray[np.float64]

MODEL_ERROR, MODEL_NOISE = 0.0025, 4
"""Share of the half diagonal that a lens is away from the model family where segments' cubic amplitudes are as large as
those of photos usually are, and the power by which it falls with them: what the family can't follow shows there."""
ELSEWHERE = 0.06
"""Distance in k1 from the scan's best answer beyond which another one isn't part of the same."""
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

    @property
    def pred_of_identity(self) -> float:
        """Predicted field error, px RMS, of making no correction: what holds where a lens is refused."""
        return math.hypot(self.pred, self.correction)


def lens_uncertainty(fit: LensFit, width: int, height: int) -> LensUncertainty:
    """Return the uncertainty of a fit of `app.vision.lens_fit`.

    Args:
        fit: The fit.
        width: Image width in px.
        height: Image height in px.
    """
    sensitivity = field_sensitivity(fit.parameters, width, height)
    away = SCAN - SCAN[np.argmax(fit.scan.probability)]
    elsewhere = np.where(np.abs(away) > ELSEWHERE, away, 0.0)
    # where nothing was refined, the scan's own spread has all of it already
    other = float(fit.scan.probability @ elsewhere**2) * sensitivity[0, 0] if fit.refined else 0.0
    model = MODEL_ERROR * half_diagonal(width, height) * fit.mixture.noise[1] ** MODEL_NOISE
    weight, means, covariances = fit.posterior
    pred = 0.0
    for share, mean, covariance in zip(weight, means, covariances, strict=True):
        apart = mean - fit.parameters
        pred += share * math.sqrt(
            expected_length(covariance @ sensitivity) ** 2 + apart @ sensitivity @ apart + other + model**2
        )
    lens = Division.from_parameters(width, height, fit.parameters)
    correction = field_error(Brown.identity(width, height), lens, width, height).rms
    return LensUncertainty(float(pred), fit.scan.sd * math.sqrt(sensitivity[0, 0]), correction)


def expected_length(form: Array) -> float:
    """Return the mean of the square root of a quadratic form of normal variables.

    The form is taken for a multiple of a chi-square law of the same mean and variance (Satterthwaite 1946).

    Args:
        form: Covariance times the form's matrix, float64 ``(P, P)``.
    """
    mean = float(np.trace(form))
    freedom = mean**2 / max(float(np.trace(form @ form)), 1e-300)
    if mean <= 0:
        return 0.0
    return math.sqrt(2 * mean / freedom) * math.exp(math.lgamma((freedom + 1) / 2) - math.lgamma(freedom / 2))


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
