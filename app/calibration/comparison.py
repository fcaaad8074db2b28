"""A lens beside one known from elsewhere, as a map of the difference over the frame.

Lines can't tell two corrections apart that differ by a homography (`app.vision.field`), so the best one is taken out
first; what is left is what the two calibrations really disagree on, wherever their focal lengths and axes lie.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from app.errors import InvalidInput
from app.vision.conversion import OpenCVLens
from app.vision.field import Lens, apply_homography, best_homography
from app.vision.frame import center_of, frame_grid

Array = NDArray[np.float64]

COLUMNS = 40
INNER = 0.8
"""Part of the width and of the height that counts as the inner frame: chessboards seldom reach the corners."""
ARRIVED = 0.1
"""px from the measured point at which a corrected one, distorted again, counts as its correction."""
LEAST_SEEN = 0.5
"""Part of the frame that both lenses must correct to be compared."""
MOST_STRETCH = 10.0
"""How much larger or smaller than the frame a corrected image may be; px of a smaller one would hide any difference."""


@dataclass(frozen=True, eq=False)
class Difference:
    """How far a lens lies from a reference after the best homography, over a grid of the measured frame.

    Attributes:
        x: float64 ``(C,)``, columns of the grid in px.
        y: float64 ``(R,)``, rows of the grid in px.
        dx: float64 ``(R, C)``, lens minus reference in the reference's corrected image, px; NaN where either folds.
        dy: Likewise.
    """

    x: Array
    y: Array
    dx: Array
    dy: Array

    @property
    def distance(self) -> Array:
        """Length of the difference, float64 ``(R, C)`` px, NaN where either lens folds."""
        return np.hypot(self.dx, self.dy)

    @property
    def rms(self) -> float:
        """RMS over the frame, px."""
        return _rms(self.distance)

    @property
    def maximum(self) -> float:
        """Largest difference, px."""
        return float(np.nanmax(self.distance))

    @property
    def inner_rms(self) -> float:
        """RMS over the inner 80 % of width and height, px."""
        across, down = (np.abs(axis - axis.mean()) <= INNER * np.ptp(axis) / 2 + 1e-9 for axis in (self.x, self.y))
        return _rms(self.distance[np.ix_(down, across)])

    def as_dict(self) -> dict[str, Any]:
        """Return the difference as JSON-serialisable fields, null where either lens folds."""
        return {
            "columns": len(self.x),
            "rows": len(self.y),
            "x": self.x.tolist(),
            "y": self.y.tolist(),
            "dx": _nulls(self.dx),
            "dy": _nulls(self.dy),
            "rms": self.rms,
            "maximum": self.maximum,
            "inner_rms": self.inner_rms,
        }

    @classmethod
    def from_dict(cls, fields: Mapping[str, Any]) -> Difference:
        """Return the difference that `as_dict` gave the fields of."""
        return cls(*(np.array(fields[name], np.float64) for name in ("x", "y", "dx", "dy")))


class ReferenceLens:
    """A lens as OpenCV's calibrations write it, with any number of coefficients; NaN beyond its fold.

    Args:
        K: Camera matrix, 3x3, px.
        D: 4, 5, 8, 12 or 14 coefficients: k1, k2, p1, p2, k3, rational, thin prism, tilted sensor.

    Raises:
        InvalidInput: If K is no camera matrix, or D has another number of coefficients.
    """

    def __init__(self, K: ArrayLike, D: ArrayLike) -> None:
        coefficients = np.asarray(D, np.float64).ravel()
        if coefficients.size not in (4, 5, 8, 12, 14) or not np.isfinite(coefficients).all():
            raise InvalidInput(f"{coefficients.size} coefficients", where="D", expected="4, 5, 8, 12 or 14")
        self.K, self.D = OpenCVLens(K, np.zeros(5)).K, coefficients

    def undistort(self, points: ArrayLike) -> Array:
        """Map measured points ``(N, 2)`` in px to corrected ones, by OpenCV's iteration, with K kept."""
        stop = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_COUNT, 300, 1e-13)
        measured = np.asarray(points, np.float64).reshape(-1, 1, 2)
        rays = np.asarray(cv2.undistortPoints(measured, self.K, self.D, None, None, None, stop), np.float64)
        rays = np.where(np.isfinite(rays), rays, 0.0)
        # where there is no such ray the iteration ends anywhere, which the way back shows
        ahead = np.column_stack([rays.reshape(-1, 2), np.ones(len(rays))])
        back = np.asarray(cv2.projectPoints(ahead, np.zeros(3), np.zeros(3), self.K, self.D)[0], np.float64)
        corrected = rays.reshape(-1, 2) * self.K[[0, 1], [0, 1]] + self.K[:2, 2]
        with np.errstate(all="ignore"):
            found = np.hypot(*(back - measured).reshape(-1, 2).T) < ARRIVED
        return np.where(found[:, None], corrected, np.nan)


def compare(lens: Lens, reference: Lens, width: int, height: int) -> Difference:
    """Compare a lens with a reference on a grid of the frame, corners included.

    Args:
        lens: The lens in question.
        reference: The one it is held against.
        width: Image width in px.
        height: Image height in px.

    Raises:
        InvalidInput: If either of them can't correct half of the frame, or makes another size of it altogether.
    """
    grid = frame_grid(width, height, COLUMNS)
    ours, theirs = lens.undistort(grid), reference.undistort(grid)
    for name, corrected in (("lens", ours), ("reference", theirs)):
        _require_seen(grid, corrected, name, width, height)
    seen = _is_usable(ours, width, height) & _is_usable(theirs, width, height)
    shift = np.full(grid.shape, np.nan)
    shift[seen] = apply_homography(best_homography(ours[seen], theirs[seen]), ours[seen]) - theirs[seen]
    shape = (-1, COLUMNS)
    x, y = grid[:COLUMNS, 0], grid[::COLUMNS, 1]
    return Difference(x, y, shift[:, 0].reshape(shape), shift[:, 1].reshape(shape))


def _is_usable(corrected: ArrayLike, width: int, height: int) -> NDArray[np.bool_]:
    """Tell points that were corrected from those that an iteration beyond a lens's fold threw far away."""
    offset = np.abs(np.asarray(corrected, np.float64) - center_of(width, height))
    return np.asarray((offset < 100 * max(width, height)).all(axis=1))  # NaN is less than nothing


def _require_seen(grid: Array, corrected: Array, name: str, width: int, height: int) -> None:
    usable = _is_usable(corrected, width, height)
    if usable.mean() < LEAST_SEEN:
        raise InvalidInput(
            "it can't be undone on most of the frame", where=name, hint="is it for images of this size, in pixels?"
        )
    stretch = _spread(corrected[usable]) / _spread(grid[usable])
    if not 1 / MOST_STRETCH <= stretch <= MOST_STRETCH:
        raise InvalidInput(
            f"its corrected image is {stretch:.2g} times as large as the measured one",
            where=name,
            hint="are its numbers those of this camera, in pixels?",
        )


def _spread(points: Array) -> float:
    return float(np.sqrt(points.var(axis=0).sum()))


def _rms(distance: Array) -> float:
    return float(np.sqrt(np.nanmean(distance**2)))


def _nulls(values: Array) -> list[list[float | None]]:
    return [[value if np.isfinite(value) else None for value in row] for row in values.tolist()]
