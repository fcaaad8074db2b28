"""Straightness, measured in the distorted image.

Distances of corrected points from their line shrink with the corrected image, so a fit that minimises them can win by
collapsing the image. The first-order (Sampson) distance in the measured image can't:

    e_i = n . (U_i - mean U) / |J_i^T n|    px

with U_i the corrected point, n the normal of the total-least-squares line through the segment's corrected points and
J_i the Jacobian of the correction. The lines are eliminated (variable projection, Golub and Pereyra 1973): they are
refitted at every set of lens parameters. Derivatives are differences of the whole of it, line and weights included:
with the weights frozen (Kaufman 1975) every bent edge of the scene would seem to bend less under a lens that shrinks
the image, and many of them outvote the straight ones.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from app.vision.bins import BinnedSegments
from app.vision.brown import Mapped
from app.vision.segments import Segments

Array = NDArray[np.float64]


class Lens(Protocol):
    """A lens with its Jacobian."""

    def undistort(self, points: ArrayLike) -> Array:
        """Map measured points ``(N, 2)`` in px to corrected ones."""
        ...

    def jacobian(self, points: ArrayLike) -> Array:
        """Return d(corrected) / d(measured), ``(N, 2, 2)``."""
        ...


MapPoints = Callable[[Array, Array, Array], Mapped]
"""A family of lenses over normalised coordinates: `map_points` of `app.vision.brown` or `division`."""
STEP = 1e-6
"""Change of a parameter that derivatives are taken over: its square is lost, and so is rounding."""
TOGETHER = 600
"""Segments, times lenses, that amplitudes are taken of at once."""


class Bend(NamedTuple):
    """Amplitudes of the quadratic and the cubic part of segments, in px of the measured image; the signs mean nothing.

    Attributes:
        quadratic: float64 ``(S,)``.
        cubic: float64 ``(S,)``.
        quadratic_slope: float64 ``(S, P)``, derivatives by the P parameters that were asked for.
        cubic_slope: Likewise.
    """

    quadratic: Array
    cubic: Array
    quadratic_slope: Array
    cubic_slope: Array


def sampson_residuals(segments: Segments, lens: Lens) -> Array:
    """Return each point's signed distance in px, in the measured image, from its segment's straight line.

    Args:
        segments: Segments in px.
        lens: The lens under which they should be straight.

    Returns:
        float64 ``(N,)`` for the N points, positive towards (-dy, dx) where (dx, dy) leads from a segment's first
        point to its last; 0 for the points of segments that don't extend.
    """
    corrected = lens.undistort(segments.points)
    jacobian = lens.jacobian(segments.points)
    of_point, counts, number = segments.segment_of_point, segments.counts, len(segments)
    x, y = (
        values - (np.bincount(of_point, values, number) / counts)[of_point]
        for values in (corrected[:, 0], corrected[:, 1])
    )
    xx, xy, yy = (np.bincount(of_point, values, number) for values in (x * x, x * y, y * y))
    angle = 0.5 * np.arctan2(2 * xy, xx - yy)
    ends = segments.points[segments.offsets[1:] - 1] - segments.points[segments.offsets[:-1]]
    angle += np.where(ends[:, 0] * np.cos(angle) + ends[:, 1] * np.sin(angle) < 0, np.pi, 0.0)
    nx, ny = -np.sin(angle)[of_point], np.cos(angle)[of_point]
    stretch = np.hypot(jacobian[:, 0, 0] * nx + jacobian[:, 1, 0] * ny, jacobian[:, 0, 1] * nx + jacobian[:, 1, 1] * ny)
    return (nx * x + ny * y) / np.maximum(stretch, 1e-6)


def bend(binned: BinnedSegments, family: MapPoints, parameters: Array, *, slopes: Sequence[int] = ()) -> Bend:
    """Return how far the binned segments still bend under a lens.

    Args:
        binned: The segments.
        family: The lens family.
        parameters: The family's parameters in half diagonals.
        slopes: Indices of the parameters to give the derivatives by, in this order.
    """
    quadratic, cubic, angle = _amplitudes(binned, family, parameters)
    by = np.zeros((2, len(binned), len(slopes)))
    for column, index in enumerate(slopes):
        ahead = parameters.copy()
        ahead[index] += STEP
        ahead2, ahead3, _ = _amplitudes(binned, family, ahead, angle)
        by[:, :, column] = (ahead2 - quadratic) / STEP, (ahead3 - cubic) / STEP
    return Bend(quadratic, cubic, *by)


def amplitudes_over(binned: BinnedSegments, family: MapPoints, lenses: Array) -> tuple[Array, Array]:
    """Return how far the binned segments still bend under each of many lenses.

    Args:
        binned: The segments.
        family: The lens family.
        lenses: float64 ``(K, P)``, parameters of each lens in half diagonals.

    Returns:
        Quadratic and cubic amplitudes, float64 ``(K, S)`` each, px.
    """
    found = np.empty((2, len(lenses), len(binned)))
    # few segments leave room in the cache for several lenses at once, which spares calls
    together = max(1, TOGETHER // max(len(binned), 1))
    for first in range(0, len(lenses), together):
        some = lenses[first : first + together].T[:, :, None, None]
        found[:, first : first + together] = _amplitudes(binned, family, some)[:2]
    return found[0], found[1]


def _amplitudes(
    binned: BinnedSegments, family: MapPoints, parameters: Array, near: Array | None = None
) -> tuple[Array, Array, Array]:
    """Return quadratic and cubic amplitude and the direction of the line, in rad, of either sense or next to `near`.

    Parameters are ``(P,)`` for results ``(S,)``, or ``(P, K, 1, 1)`` for ``(K, S)``.
    """
    weight = binned.weight
    mapped = family(parameters, binned.x, binned.y)
    u = mapped.x - _summed(weight, mapped.x)[..., None]
    v = mapped.y - _summed(weight, mapped.y)[..., None]
    wu, wv = weight * u, weight * v
    xx, xy, yy = _summed(wu, u), _summed(wu, v), _summed(wv, v)
    angle = 0.5 * np.arctan2(2 * xy, xx - yy)
    if near is not None:
        angle += np.pi * np.round((near - angle) / np.pi)
    nx, ny = -np.sin(angle)[..., None], np.cos(angle)[..., None]
    stretch = np.sqrt((mapped.xx * nx + mapped.xy * ny) ** 2 + (mapped.xy * nx + mapped.yy * ny) ** 2)
    residual = binned.scale * (nx * u + ny * v) / np.maximum(stretch, 1e-6)
    return _summed(binned.quadratic, residual), _summed(binned.cubic, residual), angle


def _summed(left: Array, right: Array) -> Array:
    """Sum products over the bins."""
    return np.einsum("...b,...b->...", left, right)
