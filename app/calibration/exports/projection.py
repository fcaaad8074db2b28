"""OpenCV's lens model, which COLMAP, ROS, Kalibr, MATLAB and mrcal share: rays to measured points.

With ``r^2 = x^2 + y^2`` of the ray and coefficients in OpenCV's order k1 k2 p1 p2 k3 k4 k5 k6:

    x_d = x (1 + k1 r^2 + k2 r^4 + k3 r^6) / (1 + k4 r^2 + k5 r^4 + k6 r^6) + 2 p1 x y + p2 (r^2 + 2 x^2)
    y_d = y (...) / (...) + p1 (r^2 + 2 y^2) + 2 p2 x y
    (u, v) = f (x_d, y_d) + principal point

after OpenCV's documentation of calib3d; each tool uses the first few coefficients and has zeros for the others.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

NAMES = ("k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6")
RADIAL_POWERS = {0: 1, 1: 2, 4: 3, 5: 1, 6: 2, 7: 3}
"""Power of r^2 of each radial coefficient, by its place; the last three are of the denominator."""
DENOMINATOR = 5
"""Place of the first coefficient of the denominator."""


def project(coefficients: Array, rays: Array) -> Array:
    """Distort rays.

    Args:
        coefficients: ``(8,)`` in OpenCV's order.
        rays: ``(N, 2)``, no unit.

    Returns:
        float64 ``(N, 2)``, no unit.
    """
    _, _, p1, p2, *_ = coefficients
    x, y = rays.T
    r2 = x * x + y * y
    above, below = _fraction(coefficients, r2)
    cross = 2 * x * y
    tangential = np.stack([p1 * cross + p2 * (r2 + 2 * x * x), p1 * (r2 + 2 * y * y) + p2 * cross], -1)
    return rays * (above / below)[:, None] + tangential


def derivatives(coefficients: Array, rays: Array) -> Array:
    """Return d(distorted) / d(coefficient) at rays ``(N, 2)``, float64 ``(8, N, 2)``."""
    x, y = rays.T
    r2 = x * x + y * y
    above, below = _fraction(coefficients, r2)
    cross = 2 * x * y
    columns = np.empty((len(NAMES), len(rays), 2))
    for place, power in RADIAL_POWERS.items():
        slope = r2**power / below
        columns[place] = rays * (slope if place < DENOMINATOR else -slope * above / below)[:, None]
    columns[2] = np.stack([cross, r2 + 2 * y * y], -1)
    columns[3] = np.stack([r2 + 2 * x * x, cross], -1)
    return columns


def area(coefficients: Array, rays: Array) -> Array:
    """Return the area ratio, distorted to undistorted, at rays ``(N, 2)``; zero or less beyond a fold or a pole."""
    k1, k2, p1, p2, k3, k4, k5, k6 = coefficients
    x, y = rays.T
    r2 = x * x + y * y
    above, below = _fraction(coefficients, r2)
    above_slope = k1 + r2 * (2 * k2 + r2 * 3 * k3)
    below_slope = k4 + r2 * (2 * k5 + r2 * 3 * k6)
    radial = above / below
    slope = (above_slope - radial * below_slope) / below
    xx = radial + 2 * x * x * slope + 2 * p1 * y + 6 * p2 * x
    yy = radial + 2 * y * y * slope + 6 * p1 * y + 2 * p2 * x
    xy = 2 * x * y * slope + 2 * p1 * x + 2 * p2 * y
    return np.where((below > 0) & (xx + yy > 0), xx * yy - xy * xy, -1.0)


def _fraction(coefficients: Array, r2: Array) -> tuple[Array, Array]:
    k1, k2, _, _, k3, k4, k5, k6 = coefficients
    return 1 + r2 * (k1 + r2 * (k2 + r2 * k3)), 1 + r2 * (k4 + r2 * (k5 + r2 * k6))
