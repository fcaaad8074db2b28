"""The inverse of a plane map by Newton's method."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from app.vision.brown import Mapped

Array = NDArray[np.float64]
MapPoints = Callable[[Array, Array, Array], Mapped]

MOST_STEPS = 60
FOUND = 1e-11
"""Distance, in half diagonals, at which a point counts as reached: 1e-8 px of a large image."""


def invert(family: MapPoints, parameters: Array, x: Array, y: Array) -> tuple[Array, Array]:
    """Find the points that a map carries to given ones; a step that leads away is halved until it doesn't.

    Args:
        family: The map, with its (symmetric) Jacobian.
        parameters: Of the map.
        x: Where the points should arrive, any shape.
        y: Likewise, same shape.

    Returns:
        Coordinates of the points; NaN where none was found, as beyond the fold of a strong lens.
    """
    shape = np.shape(x)
    target_x, target_y = np.ravel(x).astype(np.float64), np.ravel(y).astype(np.float64)
    at_x, at_y = target_x.copy(), target_y.copy()
    damping = np.ones_like(target_x)
    mapped = family(parameters, at_x, at_y)
    miss = np.hypot(mapped.x - target_x, mapped.y - target_y)
    for _ in range(MOST_STEPS):
        if not (miss > FOUND).any():
            break
        determinant = mapped.xx * mapped.yy - mapped.xy**2
        determinant = np.where(np.abs(determinant) < 1e-9, 1e-9, determinant)
        away_x, away_y = mapped.x - target_x, mapped.y - target_y
        next_x = at_x - damping * (mapped.yy * away_x - mapped.xy * away_y) / determinant
        next_y = at_y - damping * (mapped.xx * away_y - mapped.xy * away_x) / determinant
        ahead = family(parameters, next_x, next_y)
        length = np.hypot(ahead.x - target_x, ahead.y - target_y)
        better = length < miss
        damping = np.where(better, np.minimum(2 * damping, 1.0), damping / 2)
        at_x, at_y = np.where(better, next_x, at_x), np.where(better, next_y, at_y)
        miss = np.where(better, length, miss)
        mapped = Mapped(*(np.where(better, new, old) for new, old in zip(ahead, mapped, strict=True)))
    lost = ~(miss < 1e3 * FOUND)
    at_x[lost] = at_y[lost] = np.nan
    return at_x.reshape(shape), at_y.reshape(shape)
