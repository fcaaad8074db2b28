"""The same edge in two consecutive frames of a drive.

Between frames an edge moves by some percent of the image, keeps its direction to some degrees and its length within a
factor. A cost adds up these changes, less their median over the image, as the camera moves everything alike; pairs are
the one-to-one assignment of least cost (Kuhn, 1955) among those that are near enough.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from app.review.strands import Strands, strands
from app.vision.segments import Segments

Array = NDArray[np.float64]

FARTHEST = 0.06
"""Image diagonals that a middle may move across the edge; along it, twice that."""
LARGEST_TURN = np.deg2rad(7.0)
LARGEST_RATIO = 2.0
"""Of the longer length to the shorter."""
ROUNDS = 2
"""How often the common movement is taken out."""


class FrameMatches(NamedTuple):
    """M pairs of the same edge, in the order of ``first``.

    Attributes:
        first: int64 ``(M,)``, candidate of the first frame.
        second: int64 ``(M,)``, candidate of the second frame.
        cost: float64 ``(M,)`` in [0, 1), 0 for edges that didn't change.
    """

    first: NDArray[np.int64]
    second: NDArray[np.int64]
    cost: Array


def frame_matches(first: Segments, second: Segments, size: tuple[int, int]) -> FrameMatches:
    """Match candidates of two consecutive frames of one camera.

    Args:
        first: Candidates of one frame, px.
        second: Candidates of the other, px.
        size: Width and height of the frames, px.
    """
    nothing = FrameMatches(np.zeros(0, np.int64), np.zeros(0, np.int64), np.zeros(0))
    if not len(first) or not len(second):
        return nothing
    one, other = strands(first, size), strands(second, size)
    shift = np.zeros((len(one), 2))
    pairs = nothing
    for _ in range(ROUNDS):
        pairs = _assigned(_costs(one, other, shift))
        if len(pairs.first) < 5:
            break
        shift = _movement(one, other, pairs)
    return pairs


def _costs(one: Strands, other: Strands, shift: Array) -> Array:
    """Return costs ``(A, B)``; 1 and more where a pair is none."""
    offset = other.middle[None] - (one.middle + shift)[:, None]
    along = np.einsum("abd,ad->ab", offset, one.direction)
    across = np.einsum("abd,ad->ab", offset, one.normal)
    sine = (
        one.direction[:, None, 0] * other.direction[None, :, 1]
        - one.direction[:, None, 1] * other.direction[None, :, 0]
    )
    turn = np.arcsin(np.minimum(np.abs(sine), 1.0))
    ratio = np.abs(np.log(np.maximum(one.length[:, None], 1) / np.maximum(other.length[None], 1)))
    limit = FARTHEST * one.diagonal
    parts = [across / limit, along / (2 * limit), turn / LARGEST_TURN, ratio / np.log(LARGEST_RATIO)]
    return np.sqrt(sum((part**2 for part in parts), np.zeros_like(along)))


def _assigned(costs: Array) -> FrameMatches:
    rows, columns = linear_sum_assignment(np.minimum(costs, 1.0))
    value = costs[rows, columns]
    near = value < 1
    return FrameMatches(rows[near].astype(np.int64), columns[near].astype(np.int64), value[near])


def _movement(one: Strands, other: Strands, pairs: FrameMatches) -> Array:
    """Return how far each of the first frame's middles moves with its nearest matched ones, ``(A, 2)`` px."""
    moved = other.middle[pairs.second] - one.middle[pairs.first]
    # an edge says nothing of its movement along itself, where it is cut differently
    normal = one.normal[pairs.first]
    away = np.linalg.norm(one.middle[:, None] - one.middle[pairs.first][None], axis=2) / (0.2 * one.diagonal)
    weight = np.exp(-0.5 * away**2) + 1e-6
    across = np.einsum("pd,pd->p", moved, normal)
    products = np.einsum("ap,pd,pe->ade", weight, normal, normal)
    right = np.einsum("ap,p,pd->ad", weight, across, normal)
    steady = 0.05 * weight.sum(axis=1)[:, None, None] * np.eye(2)
    return np.linalg.solve(products + steady, right[..., None])[..., 0]
