"""The inverse of a plane map by Newton's method."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from app.vision.brown import Mapped

Array = NDArray[np.float64]
MapPoints = Callable[[Array, Array, Array], Mapped]

QUICK_STEPS = 8
"""Newton steps taken as they are; nearly all points arrive within five."""
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
    at_x, at_y, left = _quick(family, parameters, target_x, target_y)
    if left.size:
        at_x[left], at_y[left] = _damped(family, parameters, target_x[left], target_y[left])
    return at_x.reshape(shape), at_y.reshape(shape)


def _quick(
    family: MapPoints, parameters: Array, target_x: Array, target_y: Array
) -> tuple[Array, Array, NDArray[np.int64]]:
    """Take plain Newton steps; return where they lead and the indices of points that didn't arrive on the near side."""
    at_x, at_y, arrived = target_x.copy(), target_y.copy(), np.zeros(target_x.shape, np.bool_)
    with np.errstate(all="ignore"):
        for _ in range(QUICK_STEPS):
            mapped = family(parameters, at_x, at_y)
            away_x, away_y = mapped.x - target_x, mapped.y - target_y
            determinant = mapped.xx * mapped.yy - mapped.xy**2
            arrived = (np.abs(away_x) + np.abs(away_y) < FOUND) & (determinant > 0) & (mapped.xx + mapped.yy > 0)
            if arrived.all():
                break
            at_x -= (mapped.yy * away_x - mapped.xy * away_y) / determinant
            at_y -= (mapped.xx * away_y - mapped.xy * away_x) / determinant
        # a step may leap over the fold and come back to a far side that has the same image
        arrived &= at_x**2 + at_y**2 <= 9 * (target_x**2 + target_y**2) + 1e-6
    return at_x, at_y, np.flatnonzero(~arrived)


def _damped(family: MapPoints, parameters: Array, target_x: Array, target_y: Array) -> tuple[Array, Array]:
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
    return at_x, at_y
