"""Candidates of one structure: window rows, the two sides of a pole, the steps of a stair.

Two candidates are of one family when they run alike, are about equally long and lie side by side, or one after the
other on one line; families are what such pairs connect.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from app.review.strands import Strands, strands
from app.vision.segments import Segments

TURN = np.deg2rad(3.0)
"""rad; members differ by no more in direction from their neighbours."""
RATIO = 1.6
"""Of the longer length to the shorter, at most."""
ASIDE = 0.5
"""Lengths that neighbours lie beside one another, at most."""
ASIDE_MOST = 0.06
"""Image diagonals that neighbours lie beside one another, at most."""
SHARED = 0.7
"""Share of the shorter one that neighbours side by side run along one another, at least."""
GAP = 0.6
"""Lengths between neighbours on one line, at most."""
OFF_LINE = 0.02
"""Lengths that neighbours on one line may be off it; 2 px at least."""


def families(segments: Segments, size: tuple[int, int]) -> NDArray[np.int64]:
    """Number the families of an image's candidates.

    Args:
        segments: S candidates, px.
        size: Width and height of the image, px.

    Returns:
        int64 ``(S,)``: the family of each candidate, from 0 in the order of their first members; -1 for one alone.
    """
    count = len(segments)
    if count < 2:
        return np.full(count, -1, np.int64)
    row, column = np.nonzero(related(strands(segments, size)))
    graph = coo_array((np.ones(len(row), np.int8), (row, column)), shape=(count, count))
    _, label = connected_components(graph, directed=False)
    alone = np.bincount(label)[label] == 1
    _, first, inverse = np.unique(label, return_index=True, return_inverse=True)
    first = np.where(alone[first], count, first)  # those alone take no number
    number = np.argsort(np.argsort(first, kind="stable"), kind="stable")
    return np.where(alone, -1, number[inverse]).astype(np.int64)


def related(traced: Strands) -> NDArray[np.bool_]:
    """Tell which pairs of candidates are neighbours of one family, bool ``(S, S)``, symmetric."""
    length, direction, middle = (
        values.astype(np.float32) for values in (traced.length, traced.direction, traced.middle)
    )
    sine = np.abs(direction[:, None, 0] * direction[None, :, 1] - direction[:, None, 1] * direction[None, :, 0])
    shorter, longer = np.minimum(length[:, None], length[None]), np.maximum(length[:, None], length[None])
    alike = (sine < np.sin(TURN)) & (longer < RATIO * shorter)
    offset = middle[None] - middle[:, None]
    along = np.abs(np.einsum("abd,ad->ab", offset, direction))
    across = np.abs(-offset[..., 0] * direction[:, None, 1] + offset[..., 1] * direction[:, None, 0])
    along, across = np.maximum(along, along.T), np.maximum(across, across.T)
    overlap = (length[:, None] + length[None]) / 2 - along
    beside = (across < np.minimum(ASIDE * shorter, ASIDE_MOST * traced.diagonal)) & (overlap > SHARED * shorter)
    in_line = (across < np.maximum(OFF_LINE * shorter, 2)) & (-overlap < GAP * shorter)
    pairs = alike & (beside | in_line)
    np.fill_diagonal(pairs, False)
    return pairs
