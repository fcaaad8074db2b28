"""How far two undistortions are apart, in px over the frame.

Straight lines stay straight under any homography, so lines can never tell two undistortions apart that differ by one.
The best homography between both is therefore taken out first, and what is left is stated in px as RMS and maximum over
a grid of the frame. The same idea serves the uncertainty: the part of a small change of the parameters that no
homography can imitate.
"""

from __future__ import annotations

from typing import NamedTuple, Protocol

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from app.vision.frame import frame_grid

Array = NDArray[np.float64]


class Lens(Protocol):
    """Anything that undistorts points."""

    def undistort(self, points: ArrayLike) -> Array:
        """Map measured points ``(N, 2)`` in px to corrected ones."""
        ...


class FieldError(NamedTuple):
    """Displacement over the frame in px."""

    rms: float
    maximum: float


def field_error(reference: Lens, estimate: Lens, width: int, height: int, columns: int = 40) -> FieldError:
    """Return how far `estimate` lies from `reference` after the best homography, over the whole frame."""
    grid = frame_grid(width, height, columns)
    return displacement(reference.undistort(grid), estimate.undistort(grid))


def displacement(reference: Array, estimate: Array) -> FieldError:
    """Return the distance in px of corresponding points ``(N, 2)`` after the best homography."""
    aligned = apply_homography(best_homography(estimate, reference), estimate)
    distance = np.hypot(*(aligned - reference).T)
    return FieldError(float(np.sqrt(np.mean(distance**2))), float(distance.max()))


def best_homography(source: Array, target: Array) -> Array:
    """Return the 3x3 homography that carries `source` ``(N, 2)`` closest to `target`; identity if there is none."""
    if np.ptp(source, axis=0).min() < 1e-6 or not (np.isfinite(source).all() and np.isfinite(target).all()):
        return np.eye(3)
    homography, _ = cv2.findHomography(source, target, 0)
    return np.eye(3) if homography is None else np.asarray(homography, np.float64)


def apply_homography(homography: Array, points: Array) -> Array:
    """Map points ``(N, 2)`` by a 3x3 homography."""
    mapped = np.column_stack([points, np.ones(len(points))]) @ homography.T
    return mapped[:, :2] / mapped[:, 2:]


def homography_fields(points: Array) -> Array:
    """Return the eight displacement fields of small homographies at `points` ``(N, 2)``, float64 ``(2 N, 8)``."""
    x, y = points.T
    one, zero = np.ones_like(x), np.zeros_like(x)
    along_x = [one, x, y, zero, zero, zero, x * x, x * y]
    along_y = [zero, zero, zero, one, x, y, x * y, y * y]
    return np.concatenate([np.stack(along_x, -1), np.stack(along_y, -1)])


def observable_part(points: Array, fields: Array) -> Array:
    """Take from displacement fields what a small homography can do.

    Args:
        points: Corrected points ``(N, 2)``, best in units of about 1.
        fields: ``(2 N, P)``, x parts first, one column per parameter.

    Returns:
        What is left of each field, float64 ``(2 N, P)``.
    """
    basis, _ = np.linalg.qr(homography_fields(points))
    return fields - basis @ (basis.T @ fields)
