"""Coefficients of OpenCV's model that stand for one of our lenses.

The rays are those of our correction with the stated focal length and principal point, and stay so: where the file's
lens sends a ray must be where our lens saw it, and the distance in the measured image is the error. No homography is
slipped in between. The camera matrix is kept as stated; where a model is too short to be exact with it, one scale and
shift of the measured image are fitted too, which is the file's own camera matrix and is told in its notes.

The polynomial is linear in its coefficients, so least squares in px is one linear solve; with a denominator, or the
camera matrix left free, that solve is the start of Gauss-Newton steps.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from app.calibration.exports.conversion import Conversion
from app.calibration.exports.frame_sample import ConversionError, FrameSample, Rays
from app.calibration.exports.projection import DENOMINATOR, NAMES, RADIAL_POWERS, area, derivatives, project
from app.errors import CannotExport

Array = NDArray[np.float64]

GOOD = 0.05
"""px rms at which a model is exact enough for no other one to be tried: half of what edge points scatter."""
LEAST_AREA = 0.1
"""Least area ratio of the fitted lens to ours, anywhere in the frame; below it, or its sign turned, the fit folds."""
MOST_STEPS = 30
SHRINK = 1e-4
"""px per unit of a coefficient at the frame's edge: decides what two nearly equal terms leave open."""


class Model(NamedTuple):
    """A model of a tool.

    Attributes:
        name: As the tool calls it.
        used: Places of its coefficients in OpenCV's order; all others are 0.
        length: How many coefficients a file has, from the first on.
        free: Whether the camera matrix is fitted too.
    """

    name: str
    used: tuple[int, ...]
    length: int
    free: bool = False


class Fit(NamedTuple):
    """What was fitted.

    Attributes:
        coefficients: ``(8,)`` in OpenCV's order.
        focal_length: Of the file's camera matrix, px.
        principal_point: Of the file's camera matrix, px, ``(2,)``.
    """

    coefficients: Array
    focal_length: float
    principal_point: Array

    def project(self, rays: Array) -> Array:
        """Map rays ``(N, 2)`` to measured points in px."""
        return self.focal_length * project(self.coefficients, rays) + self.principal_point


def convert(sample: FrameSample, models: Sequence[Model]) -> Conversion:
    """Fit the models in turn; take the first that is as good as exact, else the one with the smallest error.

    Args:
        sample: The lens over its frame.
        models: Simplest first.

    Raises:
        CannotExport: If each of them folds within the frame.
    """
    found: list[Conversion] = []
    for model in models:
        fit = _fit(sample, model)
        if _folds(fit.coefficients, sample.check) or _folds(fit.coefficients, sample.fit):
            continue
        found.append(_conversion(sample, model, fit))
        if found[-1].error.rms <= GOOD:
            break
    if not found:
        names = ", ".join(dict.fromkeys(model.name for model in models))
        raise CannotExport(f"every fit of {names} folds within the frame", where="lens")
    return min(found, key=lambda one: (one.error.rms > GOOD, one.error.rms))


def _conversion(sample: FrameSample, model: Model, fit: Fit) -> Conversion:
    x, y = (float(value) for value in fit.principal_point)
    stated = sample.intrinsics
    note = (
        f"Camera matrix fitted with the coefficients: {fit.focal_length:.6g} px, ({x:.3f}, {y:.3f}) px. Rays are those "
        f"of {stated.focal_length:.6g} px, ({stated.principal_point[0]:.3f}, {stated.principal_point[1]:.3f}) px."
    )
    return Conversion(
        model.name,
        tuple(float(value) for value in fit.coefficients[: model.length]),
        ConversionError.between(fit.project(sample.check.rays), sample.check.measured),
        (note,) if model.free else (),
        fit.focal_length if model.free else None,
        (x, y) if model.free else None,
    )


def _fit(sample: FrameSample, model: Model) -> Fit:
    used, rays = list(model.used), sample.fit.rays
    focal_length, principal_point = sample.intrinsics.focal_length, np.array(sample.intrinsics.principal_point)
    # lengths in units of the farthest ray make all terms of one size
    reach = float(np.hypot(*rays.T).max())
    unit = np.array([reach ** -(2 * RADIAL_POWERS.get(place, 0.5)) for place in used])
    shrink = SHRINK * np.eye(len(used), len(used) + 3 * model.free)

    def fit_of(scaled: NDArray[np.floating]) -> Fit:
        coefficients = np.zeros(len(NAMES))
        coefficients[used] = scaled[: len(used)] * unit
        if not model.free:
            return Fit(coefficients, focal_length, principal_point)
        return Fit(
            coefficients, focal_length * float(scaled[-3]), np.add(principal_point, scaled[-2:], dtype=np.float64)
        )

    def columns(scaled: NDArray[np.floating]) -> Array:
        fit = fit_of(scaled)
        fields = list(fit.focal_length * derivatives(fit.coefficients, rays)[used] * unit[:, None, None])
        if model.free:
            one, zero = np.ones(len(rays)), np.zeros(len(rays))
            fields += [
                focal_length * project(fit.coefficients, rays),
                np.stack([one, zero], -1),
                np.stack([zero, one], -1),
            ]
        return np.concatenate([np.stack([field.ravel() for field in fields], -1), shrink])

    def residuals(scaled: NDArray[np.floating]) -> Array:
        apart = fit_of(scaled).project(rays) - sample.fit.measured
        return np.append(apart, SHRINK * scaled[: len(used)]).astype(np.float64)

    start = np.concatenate([_linear(sample, used, unit), [1.0, 0.0, 0.0] if model.free else []])
    if max(used) < DENOMINATOR and not model.free:
        return fit_of(start)
    return fit_of(
        least_squares(residuals, start, jac=columns, method="lm", max_nfev=MOST_STEPS).x  # pyright: ignore[reportArgumentType]
    )


def _linear(sample: FrameSample, used: list[int], unit: Array) -> Array:
    """Return the coefficients in units of `unit`: the best with the camera matrix kept; with a denominator, nearly."""
    rays, focal_length = sample.fit.rays, sample.intrinsics.focal_length
    measured = (sample.fit.measured - sample.intrinsics.principal_point) / focal_length
    fields = derivatives(np.zeros(len(NAMES)), rays)
    for place in range(DENOMINATOR, len(NAMES)):
        # x_d (1 + k4 r^2 + ...) = x (1 + k1 r^2 + ...) is linear in all of them
        fields[place] = -measured * ((rays**2).sum(axis=1) ** RADIAL_POWERS[place])[:, None]
    left = focal_length * (fields[used].reshape(len(used), -1) * unit[:, None]).T
    right = focal_length * (measured - rays).ravel()
    padded = np.concatenate([left, SHRINK * np.eye(len(used))]), np.concatenate([right, np.zeros(len(used))])
    return np.asarray(np.linalg.lstsq(*padded, rcond=None)[0], np.float64)


def _folds(coefficients: Array, points: Rays) -> bool:
    return bool((area(coefficients, points.rays) < LEAST_AREA * points.area).any())
