"""Line IoU of protocol clearlines-v2: how much of two polylines runs along one another.

With ``c(a|b)`` the share of a's samples (one per px of arc length) that lie within ``tau`` px of polyline b and whose
tangent is within 15 degrees of b's there,

    m = (|p| c(p|g) + |g| c(g|p)) / 2        LIoU(p, g) = m / (|p| + |g| - m)

so 1 for equal lines, 0 for lines that cross or run apart, whatever their direction. Related: buffer matching of
Heipke et al., "Evaluation of automatic road extraction" (1997); sampled lines of Almazan et al., "MCMLSD" (CVPR 2017).
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array
from scipy.spatial import KDTree

from app.evaluation.resampling import Samples, resample
from app.vision.segments import Segments

TAU = 3.0
"""Greatest distance of lines that still count as one, px."""

MAXIMUM_TURN = np.radians(15.0)
"""Greatest angle between their tangents, rad."""

_BLOCK_PAIRS = 1 << 21  # pairs of near samples held at once: about 200 MB with all temporaries


def line_iou_matrix(a: Segments, b: Segments, tau: float = TAU) -> csr_array:
    """Return the line IoU of every segment of ``a`` with every segment of ``b``.

    Only samples that lie near each other are looked at, so cost grows with their number, not with A times B.

    Args:
        a: A segments, px.
        b: B segments, px.
        tau: Greatest distance, px.

    Returns:
        Sparse float64 ``(A, B)`` in [0, 1], its stored values above 0. A segment without length has 0 with everything.
    """
    samples_a, samples_b = resample(a), resample(b)
    covered_a, covered_b = covered_lengths(samples_a, samples_b, tau)
    common = coo_array((covered_a + covered_b) / 2)
    rows, columns = common.coords
    union = samples_a.lengths[rows] + samples_b.lengths[columns] - common.data
    iou = np.divide(common.data, union, out=np.zeros_like(union), where=union > 0)
    result = csr_array((np.minimum(iou, 1.0), (rows, columns)), shape=common.shape)
    result.eliminate_zeros()
    return result


def covered_lengths(a: Samples, b: Samples, tau: float = TAU) -> tuple[csr_array, csr_array]:
    """Return ``|a| c(a|b)`` and ``|b| c(b|a)`` for every pair: the length of either that runs along the other.

    A sample of a is covered by b when the pieces of b next to its nearest sample of b pass within ``tau`` px (edge
    included) and the tangents there differ by 15 degrees at most; lines have no direction.

    Returns:
        Two sparse float64 ``(A, B)``, px.
    """
    shape = (len(a), len(b))
    covered_a: csr_array = csr_array(shape, dtype=np.float64)
    covered_b: csr_array = csr_array(shape, dtype=np.float64)
    # no sample is further than half a step from the point of its polyline that is nearest
    reach = tau + max(a.largest_step, b.largest_step) / 2
    for of_a, of_b, distance in _near_samples(a, b, reach):
        sample, nearest = _nearest_per_polyline(of_a, of_b, distance, b)
        covered_a = covered_a + _covered(a, sample, b, nearest, tau)
        sample, nearest = _nearest_per_polyline(of_b, of_a, distance, a)
        covered_b = covered_b + _covered(b, sample, a, nearest, tau).T
    return covered_a, covered_b


def _near_samples(
    a: Samples, b: Samples, reach: float
) -> Iterator[tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]]:
    """Yield all pairs of samples within ``reach`` px and their distances, a few whole polylines of a at a time."""
    if not len(a) or not len(b):
        return
    tree_a, tree_b = KDTree(a.points), KDTree(b.points)
    blocks = [np.arange(len(a.points))]
    # pairs are counted before they are listed, so that a pile of lines can't fill the memory
    if tree_a.count_neighbors(tree_b, reach) > _BLOCK_PAIRS:
        per_sample = np.asarray(tree_b.query_ball_point(a.points, reach, return_length=True), dtype=np.int64)
        per_polyline = np.add.reduceat(per_sample, a.offsets[:-1])
        block_of_polyline = np.cumsum(per_polyline) // _BLOCK_PAIRS
        blocks = np.split(blocks[0], a.offsets[np.flatnonzero(np.diff(block_of_polyline)) + 1])
    for block in blocks:
        tree = tree_a if len(blocks) == 1 else KDTree(a.points[block])
        pairs = tree.sparse_distance_matrix(tree_b, reach, output_type="ndarray")
        if len(pairs):
            yield block[pairs["i"]], pairs["j"], pairs["v"]


def _nearest_per_polyline(
    sample: NDArray[np.int64], other: NDArray[np.int64], distance: NDArray[np.float64], others: Samples
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Keep, for each sample and polyline of ``others``, the nearest of the pairs ``(sample, other)``."""
    key = sample * len(others) + others.polyline[other]
    order = np.argsort(key, kind="stable")
    starts = np.flatnonzero(np.diff(key[order], prepend=-1))
    sorted_distance = distance[order]
    least = np.repeat(np.minimum.reduceat(sorted_distance, starts), np.diff(starts, append=len(order)))
    nearest = np.flatnonzero(sorted_distance <= least)
    nearest = nearest[np.diff(key[order[nearest]], prepend=-1) != 0]
    return sample[order[nearest]], other[order[nearest]]


def _covered(
    samples: Samples, sample: NDArray[np.int64], others: Samples, nearest: NDArray[np.int64], tau: float
) -> csr_array:
    """Sum the length of the samples ``(N,)`` that their nearest samples' polylines cover, sparse ``(S, O)``, px."""
    cosine = np.abs((samples.tangents[sample] * others.tangents[nearest]).sum(axis=1))
    aligned = cosine >= np.cos(MAXIMUM_TURN) - 1e-12
    sample, nearest = sample[aligned], nearest[aligned]
    near = _distance_to_pieces(samples.points[sample], others, nearest) <= tau + 1e-9
    row, column = samples.polyline[sample[near]], others.polyline[nearest[near]]
    weight = samples.lengths / np.diff(samples.offsets)
    return coo_array((weight[row], (row, column)), shape=(len(samples), len(others))).tocsr()


def _distance_to_pieces(points: NDArray[np.float64], b: Samples, nearest: NDArray[np.int64]) -> NDArray[np.float64]:
    """Distance of points ``(N, 2)`` to the pieces on both sides of their nearest sample ``(N,)``, px."""
    first, last = b.offsets[:-1][b.polyline[nearest]], b.offsets[1:][b.polyline[nearest]] - 1
    before = np.maximum(nearest - 1, first)
    after = np.minimum(nearest + 1, last)
    corner = b.points[nearest]
    return np.minimum(
        _distance_to_piece(points, corner, b.points[before]), _distance_to_piece(points, corner, b.points[after])
    )


def _distance_to_piece(
    points: NDArray[np.float64], begin: NDArray[np.float64], end: NDArray[np.float64]
) -> NDArray[np.float64]:
    piece, to_point = end - begin, points - begin
    square = (piece * piece).sum(axis=1)
    along = np.divide((to_point * piece).sum(axis=1), square, out=np.zeros_like(square), where=square > 0)
    offset = to_point - np.clip(along, 0.0, 1.0)[:, None] * piece
    return np.hypot(offset[:, 0], offset[:, 1])
