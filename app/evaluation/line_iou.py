"""Line IoU of protocol clearlines-v2: how much of two polylines runs along one another.

With ``c(a|b)`` the share of a's samples (one per px of arc length) that polyline b covers (`app.evaluation.covering`),

    m = (|p| c(p|g) + |g| c(g|p)) / 2        LIoU(p, g) = m / (|p| + |g| - m)

so 1 for equal lines, 0 for lines that cross or run apart, whatever their direction.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array

from app.evaluation.covering import MAXIMUM_TURN, SLACK, TAU, Cover, mutual_cover
from app.evaluation.resampling import Samples, resample, sums
from app.vision.segments import Segments

__all__ = ["MAXIMUM_TURN", "TAU", "Overlaps", "covered_lengths", "line_iou_matrix", "overlaps_at"]


@dataclass(frozen=True, eq=False)
class Overlaps:
    """M pairs of polylines of which at least one runs along the other somewhere, in the order of row, then column.

    Attributes:
        row: int64 ``(M,)``, polyline of the first set.
        column: int64 ``(M,)``, polyline of the second set.
        row_length: float64 ``(M,)``, length of the row that the column covers, px.
        column_length: float64 ``(M,)``, length of the column that the row covers, px.
        iou: float64 ``(M,)``, line IoU in [0, 1].
    """

    row: NDArray[np.int64]
    column: NDArray[np.int64]
    row_length: NDArray[np.float64]
    column_length: NDArray[np.float64]
    iou: NDArray[np.float64]

    def select(self, chosen: NDArray[np.bool_]) -> Overlaps:
        """Return the pairs that a mask ``(M,)`` chooses."""
        return Overlaps(
            self.row[chosen],
            self.column[chosen],
            self.row_length[chosen],
            self.column_length[chosen],
            self.iou[chosen],
        )


def line_iou_matrix(a: Segments, b: Segments, tau: float = TAU, turn: float = MAXIMUM_TURN) -> csr_array:
    """Return the line IoU of every segment of ``a`` with every segment of ``b``.

    Args:
        a: A segments, px.
        b: B segments, px.
        tau: Greatest distance, px.
        turn: Greatest angle between tangents, rad.

    Returns:
        Sparse float64 ``(A, B)`` in [0, 1], its stored values above 0. A segment without length has 0 with everything.
    """
    samples_a, samples_b = resample(a), resample(b)
    (overlaps,) = overlaps_at(samples_a, samples_b, *mutual_cover(samples_a, samples_b, tau, turn), (tau,))
    matrix = csr_array((overlaps.iou, (overlaps.row, overlaps.column)), shape=(len(a), len(b)))
    matrix.eliminate_zeros()
    return matrix


def covered_lengths(a: Samples, b: Samples, tau: float = TAU) -> tuple[csr_array, csr_array]:
    """Return ``|a| c(a|b)`` and ``|b| c(b|a)`` for every pair: the length of either that runs along the other.

    Returns:
        Two sparse float64 ``(A, B)``, px.
    """
    cover_a, cover_b = mutual_cover(a, b, tau)
    shape = (len(a), len(b))
    of_a = coo_array((a.weights[cover_a.sample], (a.polyline[cover_a.sample], b.polyline[cover_a.nearest])), shape)
    of_b = coo_array((b.weights[cover_b.sample], (a.polyline[cover_b.nearest], b.polyline[cover_b.sample])), shape)
    return of_a.tocsr(), of_b.tocsr()


def overlaps_at(a: Samples, b: Samples, cover_a: Cover, cover_b: Cover, taus: tuple[float, ...]) -> list[Overlaps]:
    """Return the overlaps of two sets of polylines for several distances at once.

    Args:
        a: A polylines.
        b: B polylines.
        cover_a: What covers a's samples, found for the greatest of ``taus`` or more.
        cover_b: What covers b's samples.
        taus: Greatest distances, px.
    """
    key_a = a.polyline[cover_a.sample] * len(b) + b.polyline[cover_a.nearest]
    key_b = a.polyline[cover_b.nearest] * len(b) + b.polyline[cover_b.sample]
    pairs, inverse = np.unique(np.concatenate([key_a, key_b]), return_inverse=True)
    pair_a, pair_b = inverse[: len(key_a)], inverse[len(key_a) :]
    row, column = np.divmod(pairs, max(len(b), 1))
    whole = a.lengths[row] + b.lengths[column]
    weight_a, weight_b = a.weights[cover_a.sample], b.weights[cover_b.sample]

    result = []
    for tau in taus:
        of_a = sums(pair_a, weight_a * cover_a.within(tau), len(pairs))
        of_b = sums(pair_b, weight_b * cover_b.within(tau), len(pairs))
        common = (of_a + of_b) / 2
        iou = np.divide(common, whole - common, out=np.zeros_like(common), where=common > 0)
        # a sum of samples may exceed the length by its rounding
        iou[iou > 1.0 - SLACK] = 1.0
        some = common > 0
        result.append(Overlaps(row, column, of_a, of_b, iou).select(some))
    return result
