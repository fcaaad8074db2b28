"""How far lines still bend under a lens, and how that changes with the lens.

Residuals are first-order distances in the measured image (`app.vision.sampson`), with the lines eliminated. Their
derivatives are analytic: the distance of a point from a curve changes as fast as the curve moves along its normal at
the foot of the point, so the lens's derivative is taken there, and the weight's own derivative isn't needed.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from app.calibration.lens import FAMILIES, Family
from app.calibration.observations import LineObservations
from app.vision.brown import Mapped

Array = NDArray[np.float64]


class Residuals(NamedTuple):
    """Distances of bins from their lines under a lens.

    Attributes:
        distance: float64 ``(S, B)`` px, in the measured image.
        normal_x: float64 ``(S, 1)``, the corrected line's normal.
        normal_y: Likewise.
        along: float64 ``(S, B)``, place along the corrected line, half diagonals from the mean point.
        stretch: float64 ``(S, B)``, px of the corrected image per px of the measured one along the normal.
        foot_x: float64 ``(S, B)``, foot of the bin on the measured curve, half diagonals.
        foot_y: Likewise.
        foot: The feet corrected, with the Jacobian at the bins.
    """

    distance: Array
    normal_x: Array
    normal_y: Array
    along: Array
    stretch: Array
    foot_x: Array
    foot_y: Array
    foot: Mapped


def residuals(lines: LineObservations, mapped: Mapped) -> Residuals:
    """Return the distances of the lines' bins under a lens that was applied to them."""
    weight = lines.weight
    u = mapped.x - np.einsum("sb,sb->s", weight, mapped.x)[:, None]
    v = mapped.y - np.einsum("sb,sb->s", weight, mapped.y)[:, None]
    xx, xy, yy = (np.einsum("sb,sb,sb->s", weight, left, right) for left, right in ((u, u), (u, v), (v, v)))
    angle = 0.5 * np.arctan2(2 * xy, xx - yy)
    # of the two senses the one that leads along the chord, so that amplitudes don't change sign from lens to lens
    angle += np.pi * np.round((lines.direction - angle) / np.pi)
    nx, ny = -np.sin(angle)[:, None], np.cos(angle)[:, None]
    across_x, across_y = mapped.xx * nx + mapped.xy * ny, mapped.xy * nx + mapped.yy * ny
    squared = np.maximum(across_x**2 + across_y**2, 1e-12)
    off = (nx * u + ny * v) / squared
    stretch = np.sqrt(squared)
    foot = Mapped(
        mapped.x - off * (mapped.xx * across_x + mapped.xy * across_y),
        mapped.y - off * (mapped.xy * across_x + mapped.yy * across_y),
        *mapped[2:],
    )
    foot_x, foot_y = lines.x - off * across_x, lines.y - off * across_y
    return Residuals(lines.scale * off * stretch, nx, ny, u * ny - v * nx, stretch, foot_x, foot_y, foot)


def amplitudes(lines: LineObservations, family: Family, parameters: Array) -> Array:
    """Return how far lines bend, by degree, float64 ``(S, 5)`` px.

    Args:
        lines: The lines.
        family: The lens family.
        parameters: All of the family's, in half diagonals.
    """
    mapped = FAMILIES[family].map_points(parameters, lines.x, lines.y)
    return np.einsum("sdb,sb->sd", lines.basis, residuals(lines, mapped).distance)


def amplitudes_and_slopes(lines: LineObservations, family: Family, parameters: Array) -> tuple[Array, Array]:
    """Return how far lines bend, ``(S, 5)`` px, and the derivatives by all parameters of the family, ``(S, 5, P)``."""
    left = residuals(lines, FAMILIES[family].map_points(parameters, lines.x, lines.y))
    dx, dy = FAMILIES[family].derivatives_from(parameters, left.foot_x, left.foot_y, left.foot)
    return np.einsum("sdb,sb->sd", lines.basis, left.distance), field_slopes(lines, left, dx, dy)


def field_slopes(lines: LineObservations, left: Residuals, dx: Array, dy: Array) -> Array:
    """Return what fields of displacement of the corrected image do to the amplitudes, ``(S, 5, P)``.

    Args:
        lines: The lines.
        left: Their residuals.
        dx: Fields at the feet, float64 ``(P, S, B)`` in half diagonals.
        dy: Likewise.
    """
    weight = lines.weight
    moved = left.normal_x * dx + left.normal_y * dy
    # the line follows the points: by the mean and the turn that a fit in the corrected image gives it
    moved -= np.einsum("sb,psb->ps", weight, moved)[..., None]
    turn = np.einsum("sb,sb,psb->ps", weight, left.along, moved)
    turn /= np.maximum(np.einsum("sb,sb->s", weight, left.along**2), 1e-18)
    moved -= turn[..., None] * left.along
    return lines.basis @ np.moveaxis(moved * (lines.scale / left.stretch), 0, 2)
