"""Lensfun's radial models fitted to one of our lenses.

Lensfun sends a point of the corrected image to the measured one by its distance r from the lens centre, in units of
half the shorter side (the convention of Hugin):

    poly5    r_d = r (1 + k1 r^2 + k2 r^4)
    ptlens   r_d = r (1 - a - b - c + c r + b r^2 + a r^3)

ptlens keeps the circle of radius 1 in place and therefore scales the corrected image, by s say. With r = s r_u of ours
it is a free cubic q0 + q1 r_u + q2 r_u^2 + q3 r_u^3, linear in what is sought; that the coefficients sum up to 1 then
says s^4 = q0 s^3 + q1 s^2 + q2 s + q3.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from app.calibration.exports.conversion import Conversion
from app.calibration.exports.frame_sample import ConversionError, FrameSample, Rays
from app.calibration.exports.projection_fit import GOOD
from app.errors import CannotExport

Array = NDArray[np.float64]

POLY5, PTLENS = "poly5", "ptlens"
LEAST_SLOPE = 0.02
"""Least d(r_d) / d(r) within the frame; at 0 the polynomial folds."""


def convert_lensfun(sample: FrameSample) -> Conversion:
    """Fit poly5, and ptlens where that isn't exact.

    Raises:
        CannotExport: If both fold within the frame.
    """
    found = [one for one in (_poly5(sample), _ptlens(sample)) if one is not None]
    if not found:
        raise CannotExport("the fits of poly5 and ptlens fold within the frame", where="lens")
    return next((one for one in found if one.error.rms <= GOOD), min(found, key=lambda one: one.error.rms))


def unit_length(width: int, height: int) -> float:
    """Return half the shorter side in px as Lensfun counts it, between the centres of the outermost pixels."""
    return (min(width, height) - 1) / 2


def _poly5(sample: FrameSample) -> Conversion | None:
    k1, k2 = _fit(sample, (2, 4), fixed=1.0)
    return _conversion(sample, POLY5, (k1, k2), np.polynomial.Polynomial([1, 0, k1, 0, k2]), ())


def _ptlens(sample: FrameSample) -> Conversion | None:
    q = _fit(sample, (0, 1, 2, 3), fixed=0.0)
    roots = np.roots([1, *-q])
    scales = roots.real[(np.abs(roots.imag) < 1e-9) & (roots.real > 0)]
    if not scales.size:
        return None
    scale = float(scales[np.argmin(np.abs(scales - 1))])
    coefficients = q[3] / scale**4, q[2] / scale**3, q[1] / scale**2
    notes = (
        f"Lensfun's corrected image is {scale:.6f} times as large as that of the other formats, as ptlens has it.",
        f"Lensfun 0.3 can be {_mixed_up(sample, coefficients, scale):.2f} px further off where it takes four pixels at "
        "once: with ptlens it mixes up the distances of neighbours.",
    )
    return _conversion(sample, PTLENS, coefficients, np.polynomial.Polynomial(q), notes)


def _mixed_up(sample: FrameSample, coefficients: tuple[float, ...], scale: float) -> float:
    """Return how far off a pixel is, in px, that is moved as the pixel two columns away should be."""
    a, b, c = coefficients
    radius = scale * _polar(sample, sample.check)[0]
    return float((2 * radius * np.abs(c + 2 * b * radius + 3 * a * radius**2)).max())


def _conversion(
    sample: FrameSample,
    model: str,
    coefficients: tuple[float, ...],
    radial: np.polynomial.Polynomial,
    notes: tuple[str, ...],
) -> Conversion | None:
    radius, along = _polar(sample, sample.check)
    slope = (radial * np.polynomial.Polynomial([0, 1])).deriv()(np.linspace(0, radius.max(), 500))
    if slope.min() < LEAST_SLOPE:
        return None
    seen = along * radial(radius)[:, None] + sample.lens.center
    return Conversion(
        model,
        tuple(float(value) for value in coefficients),
        ConversionError.between(seen, sample.check.measured),
        (
            f"Radial only, about the distortion centre ({sample.lens.center[0]:.3f}, {sample.lens.center[1]:.3f}) px.",
            *notes,
        ),
    )


def _fit(sample: FrameSample, powers: tuple[int, ...], *, fixed: float) -> Array:
    radius, along = _polar(sample, sample.fit)
    reach = radius.max()
    columns = np.stack([(along * ((radius / reach) ** power)[:, None]).ravel() for power in powers], -1)
    right = (sample.fit.measured - sample.lens.center - fixed * along).ravel()
    answer = np.linalg.lstsq(columns, right, rcond=None)[0]
    return np.asarray(answer / reach ** np.array(powers), np.float64)


def _polar(sample: FrameSample, points: Rays) -> tuple[Array, Array]:
    along = points.corrected - sample.lens.center
    return np.hypot(*along.T) / unit_length(sample.lens.width, sample.lens.height), along
