"""The lens model as OpenCV writes it: Brown's polynomial carries corrected points to measured ones.

The correction is its inverse, found by Newton's method; its derivatives follow from the implicit function theorem.
Coordinates are in half diagonals from the image centre, as everywhere in the fit, so the coefficients are those of
OpenCV for a focal length of half a diagonal and the distortion centre as principal point.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from app.calibration.inversion import invert
from app.vision import brown
from app.vision.brown import Mapped

Array = NDArray[np.float64]


def map_points(parameters: Array, x: Array, y: Array) -> Mapped:
    """Correct points in normalised coordinates and give the Jacobian d(x_u, y_u) / d(x, y).

    Args:
        parameters: float64 ``(7,)``: k1, k2, k3, p1, p2, then the distortion centre, in half diagonals.
        x: Measured coordinates in half diagonals from the image centre, any shape.
        y: Likewise, same shape.

    Returns:
        Corrected points and Jacobian; NaN where the polynomial reaches no such measured point.
    """
    corrected_x, corrected_y = invert(brown.map_points, parameters, x, y)
    forward = brown.map_points(parameters, corrected_x, corrected_y)
    determinant = forward.xx * forward.yy - forward.xy**2
    return Mapped(
        corrected_x, corrected_y, forward.yy / determinant, -forward.xy / determinant, forward.xx / determinant
    )


def map_derivatives(parameters: Array, x: Array, y: Array) -> tuple[Array, Array]:
    """Derivatives of the corrected coordinates by the seven parameters.

    Returns:
        d(x_u) and d(y_u), float64 ``(7, ...)`` each, in the order of `parameters`.
    """
    return derivatives_from(parameters, x, y, map_points(parameters, x, y))


def derivatives_from(parameters: Array, x: Array, y: Array, mapped: Mapped) -> tuple[Array, Array]:
    """Like `map_derivatives`, where the corrected points are known already, which is what takes time."""
    del x, y
    forward_x, forward_y = brown.map_derivatives(parameters, mapped.x, mapped.y)
    return -(mapped.xx * forward_x + mapped.xy * forward_y), -(mapped.xy * forward_x + mapped.yy * forward_y)


def before_fold(parameters: Array, x: Array, y: Array) -> NDArray[np.bool_]:
    """Tell which corrected points lie nearer to the centre than where the radial polynomial turns back.

    Beyond it the polynomial gives points that other, nearer ones have already: no lens sends them there.

    Args:
        parameters: float64 ``(7,)``.
        x: Corrected coordinates in half diagonals from the image centre, any shape.
        y: Likewise, same shape.
    """
    k1, k2, k3, _, _, cx, cy = parameters
    # d(r (1 + k1 r^2 + k2 r^4 + k3 r^6)) / dr in r^2
    roots = np.roots(np.trim_zeros([7 * k3, 5 * k2, 3 * k1, 1.0], "f"))
    turning = roots.real[(np.abs(roots.imag) < 1e-9) & (roots.real > 0)]
    fold = turning.min() if turning.size else np.inf
    return np.asarray((x - cx) ** 2 + (y - cy) ** 2 < fold, bool)
