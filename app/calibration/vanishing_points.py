"""Vanishing points of the lines of one image, found without knowing the focal length.

Parallel lines of the scene meet in one point of the corrected image, maybe at infinity. Points are unit vectors over
the image plane at a distance of one half diagonal, so that none is special (Barnard's Gaussian sphere, 1983). Pairs
of lines propose points; the one that most lines agree with is refined, its lines are put aside, and so on. A line's
disagreement is the angle, at the segment in the image, between it and the way to the point. What as many lines could
do by chance is no vanishing point (a-contrario test as in Almansa, Desolneux and Vamech 2003).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray
from scipy.special import bdtrc

from app.calibration.corrected_lines import CorrectedLines

Array = NDArray[np.float64]

SCENE_ANGLE = np.deg2rad(0.25)
"""rad; what edges called parallel differ by in directions, what the lens leaves included."""
REACH = 3.0
"""Standard deviations within which a line agrees with a point."""
PROPOSALS = 400
MOST_POINTS = 6
FEWEST_LINES = 3
FALSE_ALARMS = 0.05
"""Vanishing points expected by chance in an image of lines without order, at most."""
ROUNDS = 8


@dataclass(frozen=True, eq=False)
class VanishingPoint:
    """Where lines of one image meet.

    Attributes:
        vector: float64 ``(3,)``, unit vector; x and y in half diagonals from the image centre where z is 1.
        covariance: float64 ``(3, 3)`` of the vector, singular along it.
        lines: bool ``(L,)``, the lines that agree.
        support: Sum of the probabilities of these lines.
    """

    vector: Array
    covariance: Array
    lines: NDArray[np.bool_]
    support: float


def vanishing_points(lines: CorrectedLines, *, seed: int = 0) -> list[VanishingPoint]:
    """Find the vanishing points of an image, the best supported first.

    Args:
        lines: Of the image.
        seed: Of the choice of pairs, where there are too many to try all.
    """
    found: list[VanishingPoint] = []
    open_ = np.ones(len(lines), bool)
    proposals = _proposals(lines, seed)
    while len(found) < MOST_POINTS and open_.sum() >= FEWEST_LINES and len(proposals):
        deviation = deviations(proposals, lines) / _sigma(lines)
        votes = np.exp(-0.5 * deviation**2) @ (open_ * lines.weight * _worth(lines))
        vector = proposals[int(np.argmax(votes))]
        agreeing = open_.copy()
        for _ in range(ROUNDS):
            agreeing = open_ & (deviations(vector[None], lines)[0] < REACH * _sigma(lines))
            if agreeing.sum() < 2:
                break
            vector = refined(vector, lines.select(agreeing))
        if not _meaningful(lines, agreeing, open_):
            break
        found.append(_point(vector, lines, agreeing))
        open_ &= ~agreeing
    return sorted(found, key=lambda point: -point.support)


def deviations(vectors: Array, lines: CorrectedLines) -> Array:
    """Return the angle in rad between lines and their ways to points, float64 ``(P, L)`` in [0, pi / 2].

    Args:
        vectors: float64 ``(P, 3)``.
        lines: The L lines.
    """
    return np.abs(signed_deviations(vectors[:, None], lines))


def signed_deviations(vectors: Array, lines: CorrectedLines) -> Array:
    """Return the sines' angles of `deviations` with their sign, for vectors ``(..., L, 3)`` or ``(..., 1, 3)``."""
    towards = vectors[..., :2] - vectors[..., 2:] * lines.middle
    cross = lines.direction[:, 0] * towards[..., 1] - lines.direction[:, 1] * towards[..., 0]
    along = np.abs(lines.direction[:, 0] * towards[..., 0] + lines.direction[:, 1] * towards[..., 1])
    return np.arctan2(cross, np.maximum(along, 1e-12))


def refined(vector: Array, lines: CorrectedLines) -> Array:
    """Return the point that agrees best with lines, by one step of reweighted least squares on the sphere."""
    normal = _normals(lines)
    heavy = lines.weight / (_sigma(lines) * _distance(vector, lines)) ** 2
    _, vectors = np.linalg.eigh(normal.T @ (heavy[:, None] * normal))
    best = vectors[:, 0]
    return best if best @ vector >= 0 else -best


def _proposals(lines: CorrectedLines, seed: int) -> Array:
    number = len(lines)
    if number * (number - 1) // 2 <= PROPOSALS:
        pairs = np.array(list(combinations(range(number), 2)), np.int64).reshape(-1, 2)
    else:
        odds = lines.length * lines.weight
        random = np.random.default_rng(seed)
        pairs = random.choice(number, (PROPOSALS, 2), p=odds / odds.sum())
        pairs = pairs[pairs[:, 0] != pairs[:, 1]]
    normal = _normals(lines)
    vectors = np.cross(normal[pairs[:, 0]], normal[pairs[:, 1]])
    size = np.linalg.norm(vectors, axis=1)
    return np.asarray(vectors[size > 1e-9] / size[size > 1e-9, None], np.float64)


def _normals(lines: CorrectedLines) -> Array:
    """Return a per line with a . v = 0 for the points v on it, and a_xy of length 1, float64 ``(L, 3)``."""
    across = np.stack([-lines.direction[:, 1], lines.direction[:, 0]], -1)
    return np.column_stack([across, -(across * lines.middle).sum(1)])


def _distance(vector: Array, lines: CorrectedLines) -> Array:
    return np.maximum(np.hypot(*(vector[:2] - vector[2] * lines.middle).T), 1e-3)


def _sigma(lines: CorrectedLines) -> Array:
    return np.hypot(lines.sigma, SCENE_ANGLE)


def _worth(lines: CorrectedLines) -> Array:
    """Return how much a line's vote counts: long ones, and those away from others, say more."""
    return np.sqrt(lines.length)


def _meaningful(lines: CorrectedLines, agreeing: NDArray[np.bool_], open_: NDArray[np.bool_]) -> bool:
    count, number = int(agreeing.sum()), int(open_.sum())
    if count < FEWEST_LINES:
        return False
    chance = float(np.mean(2 * REACH * _sigma(lines)[open_] / np.pi))
    tests = number * (number - 1) / 2
    more = bdtrc(count - 3, number - 2, min(chance, 1.0))  # P(X > count - 3) of a binomial X
    return bool(tests * more < FALSE_ALARMS)


def _point(vector: Array, lines: CorrectedLines, agreeing: NDArray[np.bool_]) -> VanishingPoint:
    chosen = lines.select(agreeing)
    normal = _normals(chosen)
    heavy = chosen.weight / (_sigma(chosen) * _distance(vector, chosen)) ** 2
    tangent = np.linalg.svd(vector[None])[2][1:]
    information = tangent @ (normal.T @ (heavy[:, None] * normal)) @ tangent.T
    covariance = np.asarray(tangent.T @ np.linalg.inv(information + 1e-9 * np.eye(2)) @ tangent, np.float64)
    return VanishingPoint(vector, covariance, agreeing, float(chosen.weight.sum()))
