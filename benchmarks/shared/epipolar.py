"""How well two views of one scene obey the geometry of two pinholes, given a lens.

Features are matched once, in the images as they are; a lens only moves the matched points. So what differs between two
lenses is their doing alone.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple, Protocol

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

RATIO = 0.8
"""Of the distances of the best and the second match (Lowe 2004)."""
MOST_FEATURES = 4000
CLOSE = 1.0
"""px; a match is an inlier within."""
DIFFERENCE = 0.5
"""px over which a lens's Jacobian is taken."""


class Lens(Protocol):
    """Anything that undistorts points."""

    def undistort(self, points: ArrayLike) -> Array:
        """Map measured points ``(N, 2)`` in px to corrected ones."""
        ...


@dataclass(frozen=True, eq=False)
class Matches:
    """Points of two images that show the same; float64 ``(N, 2)`` in px, as measured."""

    first: Array
    second: Array

    def __len__(self) -> int:
        return len(self.first)


class EpipolarErrors(NamedTuple):
    """Of all matches of a pair, wrong ones included.

    Attributes:
        errors: float64 ``(N,)`` px in the measured images, of both points of a match from each other's epipolar line.
        median: px.
        inliers: Share of the matches within 1 px.
    """

    errors: Array
    median: float
    inliers: float


class PoseError(NamedTuple):
    """Errors of the relative pose: the angle of the rotation, and between the directions of the way; degrees."""

    rotation: float
    translation: float


def match(first: NDArray[np.uint8], second: NDArray[np.uint8]) -> Matches:
    """Match SIFT features of two grey images, best in both directions and clearly better than the second best."""
    sift = cv2.SIFT.create(MOST_FEATURES)
    (points1, features1), (points2, features2) = (sift.detectAndCompute(image, None) for image in (first, second))
    matcher = cv2.BFMatcher(cv2.NORM_L2)
    forth, back = (
        _unambiguous(matcher.knnMatch(*pair, k=2)) for pair in ((features1, features2), (features2, features1))
    )
    pairs = np.array([(one, two) for one, two in forth.items() if back.get(two) == one], np.int64).reshape(-1, 2)
    places1, places2 = (np.array([point.pt for point in points], np.float64) for points in (points1, points2))
    # one place may carry several features of different orientation
    _, unique = np.unique(np.hstack([places1[pairs[:, 0]], places2[pairs[:, 1]]]), axis=0, return_index=True)
    pairs = pairs[np.sort(unique)]
    return Matches(places1[pairs[:, 0]], places2[pairs[:, 1]])


def epipolar_errors(matches: Matches, lens: Lens) -> EpipolarErrors:
    """Fit a fundamental matrix to the corrected points and measure how far from it all matches are.

    Distances of corrected points would shrink with the corrected image, so each is carried back into its measured
    image: divided by the length of the line's normal seen through the lens's Jacobian.
    """
    first, second = (lens.undistort(points) for points in (matches.first, matches.second))
    fundamental, _ = cv2.findFundamentalMat(first, second, cv2.USAC_MAGSAC, CLOSE, 0.9999, 10_000)
    if fundamental is None or fundamental.shape != (3, 3):
        errors = np.full(len(matches), np.inf)
    else:
        errors = _symmetric(matches, lens, (first, second), np.asarray(fundamental, np.float64))
    return EpipolarErrors(errors, float(np.median(errors)), float(np.mean(errors < CLOSE)))


def pose_error(matches: Matches, lens: Lens, matrix: Array, rotation: Array, way: Array) -> PoseError:
    """Recover the relative pose by the true pinhole and compare it with the true pose.

    Args:
        matches: Of the two images.
        lens: To correct points with.
        matrix: The true K, float64 ``(3, 3)``.
        rotation: True rotation from the first camera's axes to the second's, float64 ``(3, 3)``.
        way: Origin of the first camera in the axes of the second, float64 ``(3,)``, of any length.
    """
    first, second = (
        (lens.undistort(points) - matrix[:2, 2]) / matrix[[0, 1], [0, 1]] for points in (matches.first, matches.second)
    )
    threshold = CLOSE / float(matrix[0, 0])
    essential, mask = cv2.findEssentialMat(first, second, np.eye(3), cv2.USAC_MAGSAC, 0.9999, threshold)
    if essential is None or essential.shape != (3, 3):
        return PoseError(180.0, 180.0)
    _, found, direction, _ = cv2.recoverPose(essential, first, second, np.eye(3), mask=mask.copy())
    turn = found @ rotation.T
    cosine = float(direction[:, 0] @ way / np.linalg.norm(way))
    angle = np.degrees(np.arccos(np.clip((np.trace(turn) - 1) / 2, -1, 1)))
    return PoseError(float(angle), float(np.degrees(np.arccos(np.clip(cosine, -1, 1)))))


def _unambiguous(candidates: Any) -> dict[int, int]:
    good = (pair[0] for pair in candidates if len(pair) == 2 and pair[0].distance < RATIO * pair[1].distance)
    return {best.queryIdx: best.trainIdx for best in good}


def _symmetric(matches: Matches, lens: Lens, corrected: tuple[Array, Array], fundamental: Array) -> Array:
    """Return the root mean square of both points' distances from their epipolar lines, px in the measured images."""
    first, second = (np.column_stack([points, np.ones(len(points))]) for points in corrected)
    squares = np.zeros(len(matches))
    sides = ((matches.first, first, second @ fundamental), (matches.second, second, first @ fundamental.T))
    for measured, points, lines in sides:
        ahead_x = _slope(lens, measured, np.array([DIFFERENCE, 0.0]))
        ahead_y = _slope(lens, measured, np.array([0.0, DIFFERENCE]))
        normal = lines[:, :2]
        slope = np.hypot((normal * ahead_x).sum(1), (normal * ahead_y).sum(1))
        squares += ((points * lines).sum(1) / np.maximum(slope, 1e-12)) ** 2
    return np.sqrt(squares / 2)


def _slope(lens: Lens, points: Array, step: Array) -> Array:
    """Return the derivative of corrected points along a step, by differences."""
    return (lens.undistort(points + step) - lens.undistort(points - step)) / (2 * float(np.hypot(*step)))
