"""The division model with three coefficients: the lens model of the fit.

``p_u = c + (p - c) / D`` with ``D = 1 - k1 r^2 - k2 r^4 - k3 r^6`` and r the distance of the measured point p from the
centre c in half diagonals (Fitzgibbon 2001, "Simultaneous linear estimation of multiple view geometry and lens
distortion", has the first coefficient, lambda = -k1). One coefficient represents a wide real lens far better than one
of Brown's (0.55 px against 1.80 px over a KITTI frame), so fewer have to be told from few lines.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from app.vision.brown import MINIMUM_DETERMINANT, Mapped
from app.vision.frame import center_of, frame_grid, half_diagonal

Array = NDArray[np.float64]

SMALLEST_DIVISOR = 1e-3
"""D is kept from going below this; such points lie beyond the model's horizon and the lens isn't invertible."""


def map_points(parameters: Array, x: Array, y: Array) -> Mapped:
    """Correct points in normalised coordinates and give the Jacobian d(x_u, y_u) / d(x, y).

    Args:
        parameters: float64 ``(5,)``: k1, k2, k3, then the distortion centre, in half diagonals.
        x: Measured coordinates in half diagonals from the image centre, any shape.
        y: Likewise, same shape.
    """
    k1, k2, k3, cx, cy = parameters
    x, y = x - cx, y - cy
    r2 = x * x + y * y
    inverse = 1 / np.maximum(1 - r2 * (k1 + r2 * (k2 + r2 * k3)), SMALLEST_DIVISOR)
    slope = 2 * (k1 + r2 * (2 * k2 + r2 * 3 * k3)) * inverse * inverse
    return Mapped(cx + x * inverse, cy + y * inverse, inverse + slope * x * x, slope * x * y, inverse + slope * y * y)


def map_derivatives(parameters: Array, x: Array, y: Array) -> tuple[Array, Array]:
    """Derivatives of the corrected coordinates by the five parameters.

    Returns:
        d(x_u) and d(y_u), float64 ``(5, ...)`` each, in the order of `parameters`.
    """
    mapped = map_points(parameters, x, y)
    k1, k2, k3, cx, cy = parameters
    x, y = x - cx, y - cy
    r2 = x * x + y * y
    first = r2 / np.maximum(1 - r2 * (k1 + r2 * (k2 + r2 * k3)), SMALLEST_DIVISOR) ** 2
    second, third = first * r2, first * r2 * r2
    dx = np.stack([x * first, x * second, x * third, 1 - mapped.xx, -mapped.xy])
    dy = np.stack([y * first, y * second, y * third, -mapped.xy, 1 - mapped.yy])
    return dx, dy


@dataclass(frozen=True)
class Division:
    """A lens after the division model, for images of one size.

    Attributes:
        width: Image width in px.
        height: Image height in px.
        k: Coefficients k1, k2, k3 for r in half diagonals.
        offset: Distortion centre minus image centre, in half diagonals.
    """

    width: int
    height: int
    k: tuple[float, float, float] = (0.0, 0.0, 0.0)
    offset: tuple[float, float] = (0.0, 0.0)

    @classmethod
    def from_parameters(cls, width: int, height: int, parameters: ArrayLike) -> Division:
        """Return the lens of a parameter vector ``(5,)``: k1, k2, k3 and the centre's offset."""
        k1, k2, k3, cx, cy = (float(value) for value in np.asarray(parameters, np.float64))
        return cls(width, height, (k1, k2, k3), (cx, cy))

    @property
    def parameters(self) -> Array:
        """The parameter vector, float64 ``(5,)``."""
        return np.array([*self.k, *self.offset])

    @property
    def center(self) -> tuple[float, float]:
        """Distortion centre in px."""
        xc, yc = center_of(self.width, self.height)
        scale = half_diagonal(self.width, self.height)
        return xc + scale * self.offset[0], yc + scale * self.offset[1]

    def undistort(self, points: ArrayLike) -> Array:
        """Map measured points ``(N, 2)`` in px to corrected ones, float64 ``(N, 2)`` in px."""
        mapped = map_points(self.parameters, *self._normalised(points))
        scale = half_diagonal(self.width, self.height)
        return scale * np.stack([mapped.x, mapped.y], -1) + center_of(self.width, self.height)

    def jacobian(self, points: ArrayLike) -> Array:
        """Return d(corrected) / d(measured) at points ``(N, 2)`` in px, float64 ``(N, 2, 2)``, no unit."""
        mapped = map_points(self.parameters, *self._normalised(points))
        return np.stack([np.stack([mapped.xx, mapped.xy], -1), np.stack([mapped.xy, mapped.yy], -1)], -2)

    def is_invertible(self) -> bool:
        """Return whether the correction is one-to-one, with a margin, on the whole frame."""
        k1, k2, k3 = self.k
        x, y = self._normalised(frame_grid(self.width, self.height, 9))
        farthest = np.hypot(x - self.offset[0], y - self.offset[1]).max()
        r2 = np.linspace(0, farthest, 65) ** 2
        divisor = 1 - r2 * (k1 + r2 * (k2 + r2 * k3))
        if divisor.min() <= 10 * SMALLEST_DIVISOR:
            return False
        radial = divisor + 2 * r2 * (k1 + r2 * (2 * k2 + r2 * 3 * k3))
        return bool(radial.min() > 0 and (radial / divisor**3).min() > MINIMUM_DETERMINANT)

    def _normalised(self, points: ArrayLike) -> tuple[Array, Array]:
        offset = np.asarray(points, np.float64).reshape(-1, 2) - center_of(self.width, self.height)
        offset /= half_diagonal(self.width, self.height)
        return offset[:, 0], offset[:, 1]
