"""Three vanishing points at right angles, from the candidates themselves.

Most edges of what people build run along three directions at right angles (Coughlan and Yuille, "Manhattan World",
ICCV 1999). A vanishing point of the first direction comes from two candidates, that of the second from a third
candidate and the right angle, the third from both; the triple that most weighted candidates point to is kept, over
several focal lengths as the camera's isn't known. Directions are compared where the candidate is, in the image.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.review.strands import Strands

Array = NDArray[np.float64]

FOCAL_LENGTHS = (0.55, 0.72, 0.95, 1.3)
"""In image diagonals."""
FINER = (0.86, 0.93, 1.0, 1.08, 1.16)
"""Of the focal length found, tried once the frame is near."""
TRIALS = 160
"""Triples tried for each focal length."""
WITNESSES = 120
"""Candidates that vote, the heaviest."""
CLOSE = np.deg2rad(1.5)
"""rad; deviation at which a vote has fallen to exp(-1/2)."""
SEED = 20250


@dataclass(frozen=True, eq=False)
class VanishingFrame:
    """Three directions at right angles.

    Attributes:
        points: float64 ``(3, 3)``, a unit vector in camera coordinates (x right, y down, z ahead) per row: first the
            one nearest to upright, then the others, the one nearest to the view's axis first.
        focal: Focal length in px.
        support: float64 ``(3,)``, share of the weight of all witnesses that points to each.
    """

    points: Array
    focal: float
    support: Array


def vanishing_frame(strands: Strands) -> VanishingFrame | None:
    """Find the frame that most candidates agree with; ``None`` with fewer than three candidates."""
    weight = _weights(strands)
    order = np.argsort(-weight, kind="stable")[:WITNESSES]
    order = order[weight[order] > 0]
    if len(order) < 3:
        return None
    middle, direction = (values[order] for values in (_centred(strands.middle, strands), strands.direction))
    weight = weight[order] / weight[order].sum()
    random = np.random.default_rng(SEED)
    best: tuple[float, Array, float] | None = None
    for share in FOCAL_LENGTHS:
        focal = share * strands.diagonal
        triples = _triples(middle, direction, focal, weight, random)
        votes = np.exp(-0.5 * (_deviation(triples, middle, direction, focal) / CLOSE) ** 2).max(axis=1) @ weight
        leader = int(np.argmax(votes))
        if best is None or votes[leader] > best[0]:
            best = float(votes[leader]), triples[leader], focal
    if best is None:
        return None
    refined = [_refined(best[1], middle, direction, best[2] * finer, weight) for finer in FINER]
    support = [
        _support(frame, middle, direction, best[2] * finer, weight) for frame, finer in zip(refined, FINER, strict=True)
    ]
    leader = int(np.argmax([each.sum() for each in support]))
    points = _ordered(refined[leader])
    focal = best[2] * FINER[leader]
    return VanishingFrame(points, focal, _support(points, middle, direction, focal, weight))


def deviations(frame: VanishingFrame, strands: Strands) -> Array:
    """Return the angle between each candidate and its way to each vanishing point, float64 ``(S, 3)`` in [0, pi/2]."""
    return _deviation(frame.points[None], _centred(strands.middle, strands), strands.direction, frame.focal)[0].T


def _support(frame: Array, middle: Array, direction: Array, focal: float, weight: Array) -> Array:
    """Return the share of the weight that points to each point of a frame, float64 ``(3,)``."""
    return np.exp(-0.5 * (_deviation(frame[None], middle, direction, focal)[0] / CLOSE) ** 2) @ weight


def _weights(strands: Strands) -> Array:
    scores = np.where(np.isfinite(strands.scores), strands.scores, 0.3)
    return strands.length * (0.05 + scores)


def _centred(points: Array, strands: Strands) -> Array:
    return points - [(strands.width - 1) / 2, (strands.height - 1) / 2]


def _planes(middle: Array, direction: Array, focal: float) -> Array:
    """Return the normal of the plane through the camera and each candidate, float64 ``(S, 3)``."""
    there, along = (
        np.column_stack([values, np.full(len(middle), z)]) for values, z in ((middle, focal), (direction, 0.0))
    )
    return _across(there, along)


def _triples(middle: Array, direction: Array, focal: float, weight: Array, random: np.random.Generator) -> Array:
    """Return frames made of three candidates each, float64 ``(TRIALS, 3, 3)``."""
    planes = _planes(middle, direction, focal)
    chosen = random.choice(len(weight), (TRIALS, 3), p=weight)
    # upright candidates are the surest witnesses, so they make the first point of every other triple
    upright = np.abs(direction[:, 1]) > 0.94
    if upright.sum() >= 2:
        odds = weight * upright / (weight * upright).sum()
        chosen[::2, :2] = random.choice(len(weight), (len(chosen[::2]), 2), p=odds)
    first = _across(planes[chosen[:, 0]], planes[chosen[:, 1]])
    second = _across(planes[chosen[:, 2]], first)
    return np.stack([first, second, _across(first, second)], axis=1)


def _across(one: Array, other: Array) -> Array:
    """Return unit vectors at right angles to both, ``(..., 3)``; straight ahead where they are parallel."""
    vectors = np.asarray(np.cross(one, other), np.float64)
    norm = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.where(norm > 1e-9, vectors / np.maximum(norm, 1e-9), [0.0, 0.0, 1.0])


def _deviation(frames: Array, middle: Array, direction: Array, focal: float) -> Array:
    """Return angles in rad between candidates ``(S,)`` and their ways to the points of frames ``(T, 3, 3)``."""
    x, y, z = (frames[:, :, axis, None] for axis in range(3))
    towards_x, towards_y = x * focal - z * middle[:, 0], y * focal - z * middle[:, 1]
    cross = np.abs(towards_x * direction[:, 1] - towards_y * direction[:, 0])
    return np.arctan2(cross, np.abs(towards_x * direction[:, 0] + towards_y * direction[:, 1]))


def _refined(frame: Array, middle: Array, direction: Array, focal: float, weight: Array) -> Array:
    """Turn a frame by least squares towards the candidates that point to it; the right angles stay."""
    planes = _planes(middle, direction, focal)
    for _ in range(4):
        angle = _deviation(frame[None], middle, direction, focal)[0]
        odds = np.exp(-0.5 * (angle / CLOSE) ** 2) * weight
        # a small turn r moves v by r x v, and n . (v + r x v) = n . v + (v x n) . r should be 0
        slopes = np.asarray(np.cross(frame[:, None], planes[None]), np.float64).reshape(-1, 3)
        value = (frame @ planes.T).reshape(-1)
        heavy = odds.reshape(-1, 1)
        turn = np.linalg.solve(slopes.T @ (heavy * slopes) + 1e-6 * np.eye(3), -slopes.T @ (heavy[:, 0] * value))
        frame = _orthonormal(frame + np.asarray(np.cross(turn[None], frame), np.float64))
    return frame


def _orthonormal(frame: Array) -> Array:
    left, _, right = np.linalg.svd(frame)
    return np.asarray(left @ right, np.float64)


def _ordered(frame: Array) -> Array:
    upright = int(np.argmax(np.abs(frame[:, 1])))
    others = sorted((row for row in range(3) if row != upright), key=lambda row: -abs(frame[row, 2]))
    return frame[[upright, *others]]
