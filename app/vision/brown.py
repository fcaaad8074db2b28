"""The Brown-Conrady lens model in the undistort direction: corrected = measured + correction(measured).

Formula (Brown 1971, "Close-range camera calibration"), with ``x = (u - xc) / S``, ``y = (v - yc) / S`` and
``r^2 = x^2 + y^2`` taken at the measured, distorted point:

    x_u = x (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p1 x y + p2 (r^2 + 2 x^2)
    y_u = y (1 + k1 r^2 + k2 r^4 + k3 r^6) + p1 (r^2 + 2 y^2) + 2 p2 x y

The ClearLines paper prints it without the leading 1 and with r of the corrected point; both are slips, since without
the 1 zero coefficients would send every point to the centre. Barrel distortion has k1 > 0 here and k1 < 0 in OpenCV,
whose polynomial goes the other way.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from app.vision.frame import center_of, frame_grid, half_diagonal

Array = NDArray[np.float64]

MINIMUM_DETERMINANT = 0.05
"""Smallest area ratio, corrected to measured, at which a lens still counts as invertible."""


class Mapped(NamedTuple):
    """Corrected coordinates and the (symmetric) Jacobian of the correction, each of the shape of the input."""

    x: Array
    y: Array
    xx: Array
    xy: Array
    yy: Array


def map_points(parameters: Array, x: Array, y: Array) -> Mapped:
    """Correct points in normalised coordinates and give the Jacobian d(x_u, y_u) / d(x, y).

    Args:
        parameters: float64 ``(7,)``: k1, k2, k3, p1, p2, then the distortion centre (in units of S).
        x: Measured coordinates in units of S, any shape.
        y: Likewise, same shape.
    """
    k1, k2, k3, p1, p2, cx, cy = parameters
    x, y = x - cx, y - cy
    r2 = x * x + y * y
    radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3))
    slope = k1 + r2 * (2 * k2 + r2 * 3 * k3)
    cross = 2 * x * y
    return Mapped(
        cx + x * radial + p1 * cross + p2 * (r2 + 2 * x * x),
        cy + y * radial + p1 * (r2 + 2 * y * y) + p2 * cross,
        radial + 2 * x * x * slope + 2 * p1 * y + 6 * p2 * x,
        cross * slope + 2 * p1 * x + 2 * p2 * y,
        radial + 2 * y * y * slope + 6 * p1 * y + 2 * p2 * x,
    )


def map_derivatives(parameters: Array, x: Array, y: Array) -> tuple[Array, Array]:
    """Derivatives of the corrected coordinates by the seven parameters.

    Returns:
        d(x_u) and d(y_u), float64 ``(7, ...)`` each, in the order of `parameters`.
    """
    mapped = map_points(parameters, x, y)
    x, y = x - parameters[5], y - parameters[6]
    r2 = x * x + y * y
    cross = 2 * x * y
    dx = np.stack([x * r2, x * r2**2, x * r2**3, cross, r2 + 2 * x * x, 1 - mapped.xx, -mapped.xy])
    dy = np.stack([y * r2, y * r2**2, y * r2**3, r2 + 2 * y * y, cross, -mapped.xy, 1 - mapped.yy])
    return dx, dy


@dataclass(frozen=True)
class Brown:
    """A Brown-Conrady lens for images of one size.

    Attributes:
        width: Image width in px.
        height: Image height in px.
        center: Distortion centre ``(xc, yc)`` in px, pixel centre at integers.
        scale: S in px, the length that coordinates are divided by; half the image diagonal unless said otherwise.
        k: Radial coefficients k1, k2, k3.
        p: Tangential coefficients p1, p2.
    """

    width: int
    height: int
    center: tuple[float, float]
    scale: float
    k: tuple[float, float, float] = (0.0, 0.0, 0.0)
    p: tuple[float, float] = (0.0, 0.0)

    @classmethod
    def identity(cls, width: int, height: int) -> Brown:
        """Return the lens that changes nothing, centred on the image."""
        return cls(width, height, center_of(width, height), half_diagonal(width, height))

    def undistort(self, points: ArrayLike) -> Array:
        """Map measured points ``(N, 2)`` in px to corrected ones, float64 ``(N, 2)`` in px."""
        mapped = map_points(self._parameters, *self._normalised(points))
        return self.scale * np.stack([mapped.x, mapped.y], -1) + self.center

    def jacobian(self, points: ArrayLike) -> Array:
        """Return d(corrected) / d(measured) at points ``(N, 2)`` in px, float64 ``(N, 2, 2)``, no unit."""
        mapped = map_points(self._parameters, *self._normalised(points))
        return np.stack([np.stack([mapped.xx, mapped.xy], -1), np.stack([mapped.xy, mapped.yy], -1)], -2)

    def smallest_determinant(self) -> float:
        """Return the least determinant of the Jacobian over the frame; at or below 0 the lens folds there."""
        mapped = map_points(self._parameters, *self._normalised(frame_grid(self.width, self.height, 65)))
        # the trace tells a reflection in both axes (both eigenvalues negative) from a proper map
        determinant = np.where(mapped.xx + mapped.yy > 0, mapped.xx * mapped.yy - mapped.xy**2, -1.0)
        return float(determinant.min())

    def is_invertible(self) -> bool:
        """Return whether the correction is one-to-one, with a margin, on the whole frame."""
        return self.smallest_determinant() > MINIMUM_DETERMINANT

    def distort(self, points: ArrayLike, iterations: int = 60, tolerance: float = 1e-9) -> Array:
        """Map corrected points to measured ones by Newton's method with step halving.

        Args:
            points: ``(N, 2)`` in px.
            iterations: Most Newton steps to take.
            tolerance: Largest error in px, of `undistort` at the answer, that counts as found.

        Returns:
            float64 ``(N, 2)`` in px; NaN where no measured point was found, as beyond the fold of a strong lens.
        """
        target = np.asarray(points, np.float64).reshape(-1, 2)
        found = target.copy()
        miss = self.undistort(found) - target
        length = np.hypot(*miss.T)
        damping = np.ones(len(target))
        for _ in range(iterations):
            open_ = np.flatnonzero((length > tolerance) & (damping > 1e-6))
            if not open_.size:
                break
            jacobian = self.jacobian(found[open_])
            determinant = jacobian[:, 0, 0] * jacobian[:, 1, 1] - jacobian[:, 0, 1] ** 2
            safe = np.where(np.abs(determinant) < 1e-9, 1.0, determinant)
            mx, my = miss[open_].T
            step = np.stack(
                [
                    jacobian[:, 1, 1] * mx - jacobian[:, 0, 1] * my,
                    jacobian[:, 0, 0] * my - jacobian[:, 0, 1] * mx,
                ],
                -1,
            )
            trial = found[open_] - (damping[open_] / safe)[:, None] * step
            trial_miss = self.undistort(trial) - target[open_]
            trial_length = np.hypot(*trial_miss.T)
            # a step that leaves the near side of the fold would find the mirror solution
            better = (trial_length < length[open_]) & (determinant > 0)
            taken = open_[better]
            found[taken], miss[taken], length[taken] = trial[better], trial_miss[better], trial_length[better]
            damping[taken] = np.minimum(1.0, 2 * damping[taken])
            damping[open_[~better]] /= 2
        found[length > max(tolerance, 1e-6)] = np.nan
        return found

    @property
    def _parameters(self) -> Array:
        return np.array([*self.k, *self.p, 0.0, 0.0])

    def _normalised(self, points: ArrayLike) -> tuple[Array, Array]:
        offset = (np.asarray(points, np.float64).reshape(-1, 2) - self.center) / self.scale
        return offset[:, 0], offset[:, 1]
