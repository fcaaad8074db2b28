"""What the vanishing points of images say of the focal length, before any is believed.

Two vanishing points of directions at right angles satisfy ``(v1 - pp) . (v2 - pp) + f^2 = 0`` (Hartley and Zisserman
2004, ch. 8) for square pixels. Which pairs are at right angles isn't known. So every pair and every triple of points
of an image is an explanation of it, beside "none of them"; given a focal length its likelihood is that of the angles
that it makes, in which the cosine of two unrelated directions lies anywhere. Explanations are summed, images
multiplied: a focal length is believed where different angles agree on it, as those that aren't right ones don't.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from app.calibration.vanishing_points import VanishingPoint

Array = NDArray[np.float64]

FOCAL_LENGTHS = np.geomspace(0.45, 9.0, 300)
"""In half diagonals: fields of view along the diagonal from 131 down to 13 degrees; equally likely before any line."""
PRINCIPAL_POINT_SIGMA = 0.03
"""Standard deviation of a principal point from the image centre, in half diagonals and each direction."""
RIGHT_ANGLES = 0.6
"""Probability that an image with two vanishing points or more has two at right angles."""
ANGLE_SIGMA = np.deg2rad(0.5)
"""rad; by which right angles of buildings aren't."""


@dataclass(frozen=True, eq=False)
class Votes:
    """What one image says.

    Attributes:
        explanations: Indices of the points that would be at right angles, two or three each.
        factor: float64 ``(H, F)``, how much likelier the points are under each explanation than unrelated, for each of
            `FOCAL_LENGTHS`.
        prior: float64 ``(H,)``, probability of each explanation before; together `RIGHT_ANGLES`.
    """

    explanations: tuple[tuple[int, ...], ...]
    factor: Array
    prior: Array

    def evidence(self) -> Array:
        """Return the likelihood of the image over `FOCAL_LENGTHS` against that of unrelated points."""
        if not self.explanations:
            return np.ones(len(FOCAL_LENGTHS))
        return 1 - RIGHT_ANGLES + self.prior @ self.factor

    def best(self, index: int) -> tuple[int, ...] | None:
        """Return the likeliest explanation given a focal length, ``None`` where unrelated points are likelier."""
        if not self.explanations:
            return None
        share = self.prior * self.factor[:, index]
        if share.sum() < 1 - RIGHT_ANGLES:
            return None
        return self.explanations[int(np.argmax(share))]


def votes_of(points: Sequence[VanishingPoint]) -> Votes:
    """Return what the vanishing points of an image say of the focal length."""
    pairs = list(combinations(range(len(points)), 2))
    triples = list(combinations(range(len(points)), 3))
    explanations: tuple[tuple[int, ...], ...] = (*pairs, *triples)
    if not pairs:
        return Votes((), np.zeros((0, len(FOCAL_LENGTHS))), np.zeros(0))
    of_pair = {pair: _right_angle(points[pair[0]], points[pair[1]]) for pair in pairs}
    factor = np.array([np.prod([of_pair[pair] for pair in combinations(some, 2)], axis=0) for some in explanations])
    weight = np.array([np.sqrt(np.prod([points[index].support for index in some])) for some in explanations])
    weight = weight ** (1 / np.array([len(some) for some in explanations]))
    return Votes(explanations, factor, RIGHT_ANGLES * weight / weight.sum())


def _right_angle(one: VanishingPoint, other: VanishingPoint) -> Array:
    """Return how much likelier two points are at right angles than unrelated, for each focal length."""
    depth = np.stack([np.ones_like(FOCAL_LENGTHS), np.ones_like(FOCAL_LENGTHS), FOCAL_LENGTHS], -1)
    first, second = depth * one.vector, depth * other.vector
    size1, size2 = np.linalg.norm(first, axis=1), np.linalg.norm(second, axis=1)
    first, second = first / size1[:, None], second / size2[:, None]
    cosine = (first * second).sum(1)
    slope1 = (second - cosine[:, None] * first) / size1[:, None]
    slope2 = (first - cosine[:, None] * second) / size2[:, None]
    variance = np.einsum("fi,ij,fj->f", depth * slope1, one.covariance, depth * slope1)
    variance += np.einsum("fi,ij,fj->f", depth * slope2, other.covariance, depth * slope2)
    # a principal point elsewhere moves both points alike
    center = -one.vector[2] * slope1[:, :2] - other.vector[2] * slope2[:, :2]
    variance += PRINCIPAL_POINT_SIGMA**2 * (center**2).sum(1) + ANGLE_SIGMA**2
    # unrelated directions have any cosine alike: density 1 / 2
    return 2 * np.exp(-0.5 * cosine**2 / variance) / np.sqrt(2 * np.pi * variance)
