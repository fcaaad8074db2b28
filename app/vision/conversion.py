"""Refit of any undistortion by the Brown-Conrady model, with what is lost by it.

Two lens models never agree exactly, so a conversion is a fit over the frame and its error belongs to the result. What
lines can't see, a homography, is left free, since it costs nothing and brings the models closer.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from app.errors import InvalidInput
from app.vision.brown import Brown, map_derivatives
from app.vision.field import FieldError, Lens, displacement
from app.vision.frame import frame_grid, half_diagonal

Array = NDArray[np.float64]

LADDER = ((0, 1, 2, 3, 4), (0, 1, 2), (0, 1), (0,))
"""Coefficients (k1, k2, k3, p1, p2) that a refit may use: all, then fewer while the result folds within the frame."""


class Refit(NamedTuple):
    """A Brown-Conrady lens that stands for another one, and how far both are apart in px over the frame."""

    brown: Brown
    error: FieldError


def refit_brown(lens: Lens, width: int, height: int, center: tuple[float, float]) -> Refit:
    """Fit Brown-Conrady coefficients to another undistortion on a grid of the frame.

    Args:
        lens: The undistortion to stand for.
        width: Image width in px.
        height: Image height in px.
        center: Distortion centre to use, in px.
    """
    measured = frame_grid(width, height)
    target = lens.undistort(measured)
    finite = np.isfinite(target).all(axis=1)
    measured, target = measured[finite], target[finite]
    scale = half_diagonal(width, height)
    brown = Brown(width, height, center, scale)
    for used in LADDER:
        coefficients = np.zeros(5)
        coefficients[list(used)] = _solve((measured - center) / scale, (target - center) / scale, used)
        k1, k2, k3, p1, p2 = (float(value) for value in coefficients)
        brown = Brown(width, height, center, scale, (k1, k2, k3), (p1, p2))
        if brown.is_invertible():
            break
    return Refit(brown, displacement(target, brown.undistort(measured)))


class OpenCVLens:
    """A lens as OpenCV writes it: camera matrix K and coefficients D = (k1, k2, p1, p2, k3), distorting direction.

    Raises:
        InvalidInput: If K isn't an invertible camera matrix or D has more or fewer than 4 or 5 finite numbers.
    """

    def __init__(self, K: ArrayLike, D: ArrayLike) -> None:
        self.K = _numbers(K, "K")
        self.D = _numbers(D, "D").ravel()
        if self.K.shape != (3, 3) or self.K[0, 0] <= 0 or self.K[1, 1] <= 0:
            raise InvalidInput("not a camera matrix", where="K", expected="3x3 with positive focal lengths")
        if self.D.size not in (4, 5):
            raise InvalidInput(f"{self.D.size} coefficients", where="D", expected="k1, k2, p1, p2 and perhaps k3")

    def undistort(self, points: ArrayLike) -> Array:
        """Map measured points ``(N, 2)`` in px to corrected ones, by OpenCV's iteration, with K kept."""
        stop = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_COUNT, 300, 1e-13)
        measured = np.asarray(points, np.float64).reshape(-1, 1, 2)
        return np.asarray(cv2.undistortPoints(measured, self.K, self.D, None, None, self.K, stop), np.float64).reshape(
            -1, 2
        )


def opencv_to_brown(K: ArrayLike, D: ArrayLike, width: int, height: int) -> Refit:
    """Express an OpenCV calibration in our model and direction.

    Args:
        K: Camera matrix, 3x3, px.
        D: k1, k2, p1, p2 and perhaps k3.
        width: Image width in px.
        height: Image height in px.

    Raises:
        InvalidInput: If K or D isn't what it should be.
    """
    lens = OpenCVLens(K, D)
    return refit_brown(lens, width, height, (float(lens.K[0, 2]), float(lens.K[1, 2])))


def _solve(measured: Array, target: Array, used: Sequence[int]) -> Array:
    """Return the coefficients that bring Brown's correction closest to a homography of the target.

    Linear but for the product of both sides in the two projective terms, where the last answer stands in.
    """
    x, y = target.T
    one, zero = np.ones_like(x), np.zeros_like(x)
    dx, dy = map_derivatives(np.zeros(7), measured[:, 0], measured[:, 1])
    fields = np.concatenate([dx[list(used)], dy[list(used)]], axis=1).T
    affine = np.concatenate([np.stack([one, x, y, zero, zero, zero], -1), np.stack([zero, zero, zero, one, x, y], -1)])
    corrected, right = measured.T.ravel(), measured.T.ravel()
    # a touch of shrinking decides what the points leave open, as for a frame of one pixel
    shrink = 1e-7 * np.sqrt(len(right)) * np.eye(len(used), len(used) + 8)
    answer: Array = np.zeros(len(used))
    for _ in range(6):
        projective = np.stack([np.tile(x, 2) * corrected, np.tile(y, 2) * corrected], -1)
        left = np.concatenate([np.concatenate([fields, -affine, projective], axis=1), shrink])
        solution = np.linalg.lstsq(left, np.concatenate([-right, np.zeros(len(used))]), rcond=1e-10)[0]
        answer = np.asarray(solution[: len(used)], np.float64)
        corrected = right + fields @ answer
    return answer


def _numbers(values: ArrayLike, where: str) -> Array:
    try:
        numbers = np.asarray(values, np.float64)
    except (TypeError, ValueError):
        raise InvalidInput("not numbers", where=where) from None
    if not np.isfinite(numbers).all():
        raise InvalidInput("not finite", where=where)
    return numbers
