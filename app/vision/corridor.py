"""The corridor in which an edge is looked for between clicked points: coordinates along and across its middle.

The middle is the line between the first and the last point, bent as the lens bends a straight line of the scene; points
in between push it sideways. Coordinates are ``along`` the chord, in px from the first point, and ``across`` it, in px
from the bent line; the point they stand for is

    first + along * direction + (bend(along) + across) * normal
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from app.errors import InvalidInput
from app.vision.sampson import Lens

Array = NDArray[np.float64]

MOST_CLICKS = 20
SHORTEST = 8.0
"""px; between points nearer to each other nothing can be told from noise."""
MOST_REACH = 64.0
"""px beside a clicked point that its edge may lie."""

_KNOTS = 33
_STEPS = 8
# how much farther from the middle an edge may run between two points: what a wide-angle lens bends, and what is left
# of that where the lens is known
_BULGE, _BULGE_WITH_LENS, _LEAST_BULGE, _MOST_BULGE = 0.02, 0.004, 1.0, 48.0


@dataclass(frozen=True, eq=False)
class Corridor:
    """Where an edge is looked for.

    Attributes:
        first: float64 ``(2,)`` px, the first clicked point.
        direction: float64 ``(2,)``, unit vector to the last one.
        length: px between the two.
        clicks: float64 ``(k, 2)``, coordinates along and across of the clicked points, rising along.
        reach: px beside a clicked point that the edge may lie.
        bulge: px by which it may be farther away half-way between two points, per px between these.
    """

    first: Array
    direction: Array
    length: float
    clicks: Array
    reach: float
    bulge: float
    bend: CubicSpline

    @property
    def normal(self) -> Array:
        """Unit vector across the chord, the direction turned from x towards y."""
        return np.array([-self.direction[1], self.direction[0]])

    def places(self, along: Array, across: Array) -> Array:
        """Return the points at coordinates of one shape, float64 ``(..., 2)`` px."""
        sideways = self.bend(along) + across
        return self.first + along[..., None] * self.direction + sideways[..., None] * self.normal

    def coordinates(self, points: Array) -> Array:
        """Return along and across of points ``(n, 2)`` px, float64 ``(n, 2)``."""
        return _coordinates(points, self.first, self.direction, self.bend)

    def middle(self, along: Array) -> Array:
        """Return the coordinate across of the corridor's middle, float64 as `along`."""
        return np.interp(along, self.clicks[:, 0], self.clicks[:, 1])

    def half_width(self, along: Array) -> Array:
        """Return how far from its middle the corridor reaches, float64 px as `along`."""
        stops = self.clicks[:, 0]
        leg = np.clip(np.searchsorted(stops, along, side="right") - 1, 0, len(stops) - 2)
        size = np.diff(stops)[leg]
        share = np.clip((along - stops[leg]) / size, 0, 1)
        return self.reach + np.clip(self.bulge * size, _LEAST_BULGE, _MOST_BULGE) * 4 * share * (1 - share)


def corridor_between(clicks: Array, size: tuple[int, int], *, reach: float, lens: Lens | None = None) -> Corridor:
    """Return the corridor along clicked points.

    Args:
        clicks: float64 ``(k, 2)`` px, 2 to 20 points that follow each other along the edge.
        size: Width and height of the image, px.
        reach: px beside each point that the edge may lie.
        lens: Under which the edge is straight; without one it may bend more.

    Raises:
        InvalidInput: On too few or too many points, one outside the image, points that turn back or lie too close.
    """
    clicks = checked_clicks(clicks, size)
    if not 0 < reach <= MOST_REACH:
        raise InvalidInput(f"a reach of {reach:g} px", where="reach", expected=f"more than 0, at most {MOST_REACH:g}")
    chord = clicks[-1] - clicks[0]
    length = float(np.hypot(*chord))
    if length < SHORTEST:
        raise InvalidInput(
            f"the first and the last point are {length:.1f} px apart",
            where="points",
            expected=f"at least {SHORTEST:g} px",
        )
    direction = chord / length
    bend = _bend_of(lens, clicks[0], direction, length)
    coordinates = _coordinates(clicks, clicks[0], direction, bend)
    coordinates[[0, -1]] = [0.0, 0.0], [length, 0.0]
    turning = np.flatnonzero(np.diff(coordinates[:, 0]) < 1.0)
    if turning.size:
        raise InvalidInput(
            "the points turn back",
            where=f"points[{int(turning[0]) + 1}]",
            expected="points that follow each other along one edge",
            hint="remove this point, or trace the edge in two parts",
        )
    bulge = _BULGE if lens is None else _BULGE_WITH_LENS
    return Corridor(clicks[0], direction, length, coordinates, float(reach), bulge, bend)


def checked_clicks(clicks: Array, size: tuple[int, int]) -> Array:
    """Return clicked points as float64 ``(k, 2)``.

    Raises:
        InvalidInput: On too few or too many, one that isn't finite or lies outside the image.
    """
    points = np.asarray(clicks, np.float64)
    if points.ndim != 2 or points.shape[1] != 2 or not 2 <= len(points) <= MOST_CLICKS:
        raise InvalidInput("these points make no line", where="points", expected=f"2 to {MOST_CLICKS} pairs of x, y")
    inside = np.isfinite(points) & (points >= -0.5) & (points <= np.array(size) - 0.5)
    if not inside.all():
        raise InvalidInput(
            "a point lies outside the image",
            where=f"points[{int(np.flatnonzero(~inside.all(axis=1))[0])}]",
            expected=f"x from -0.5 to {size[0] - 0.5:g}, y from -0.5 to {size[1] - 0.5:g}",
        )
    return points


def _coordinates(points: Array, first: Array, direction: Array, bend: CubicSpline) -> Array:
    relative = points - first
    along = relative @ direction
    across = relative @ np.array([-direction[1], direction[0]]) - bend(along)
    return np.stack([along, across], axis=1)


def _bend_of(lens: Lens | None, first: Array, direction: Array, length: float) -> CubicSpline:
    """Return how far the image of a straight line through both ends of a chord is beside it, px over px along it."""
    along = np.linspace(0, length, _KNOTS)
    offset = np.zeros(_KNOTS)
    if lens is not None:
        chord, normal = first + along[:, None] * direction, np.array([-direction[1], direction[0]])
        start, stop = lens.undistort(chord[[0, -1]])
        across = np.array([start[1] - stop[1], stop[0] - start[0]])
        # Newton's method for each place by itself: the corrected place is to lie on the corrected line
        for _ in range(_STEPS):
            places = chord + offset[:, None] * normal
            miss = (lens.undistort(places) - start) @ across
            slope = lens.jacobian(places) @ normal @ across
            offset -= miss / np.where(np.abs(slope) < 1e-9, 1e-9, slope)
        if not np.isfinite(offset).all() or np.abs(offset).max() > length / 4:
            offset = np.zeros(_KNOTS)  # beyond what the lens was estimated for, it says nothing
    return CubicSpline(along, offset)
