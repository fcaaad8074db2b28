"""One-to-one matching of segments."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import connected_components

from app.errors import InvalidInput
from app.evaluation.covering import SLACK, TAU
from app.evaluation.line_iou import line_iou_matrix
from app.vision.segments import Segments


class Matches(NamedTuple):
    """M pairs, in the order of ``row``.

    Attributes:
        row: int64 ``(M,)``, each index at most once.
        column: int64 ``(M,)``, each index at most once.
        value: float64 ``(M,)``, the pair's entry of the matrix.
    """

    row: NDArray[np.int64]
    column: NDArray[np.int64]
    value: NDArray[np.float64]


def match_one_to_one(matrix: csr_array | NDArray[np.float64], threshold: float) -> Matches:
    """Match rows and columns one-to-one: as many pairs as possible, and among those the greatest sum.

    The Hungarian method (Kuhn 1955; Jonker and Volgenant 1987) runs on each group of rows and columns that are linked
    to one another, as pairs below the threshold can't match.

    Args:
        matrix: Sparse or dense, ``(A, B)``, values in [0, 1].
        threshold: Pairs below it don't match; above 0.

    Raises:
        InvalidInput: When the threshold isn't in (0, 1].

    Example:
        >>> match_one_to_one(np.array([[0.9, 0.8], [0.8, 0.0]]), 0.5).column
        array([1, 0])
    """
    entries = coo_array(matrix)
    row, column = (coordinate.astype(np.int64) for coordinate in entries.coords)
    return match_pairs(row, column, entries.data.astype(np.float64), threshold)


def match_pairs(
    rows: NDArray[np.int64],
    columns: NDArray[np.int64],
    values: NDArray[np.float64],
    threshold: float,
    *,
    most_pairs: bool = True,
) -> Matches:
    """Match rows and columns one-to-one, given the pairs that are worth something; see `match_one_to_one`.

    Args:
        rows: int64 ``(E,)``.
        columns: int64 ``(E,)``; a pair of row and column is there once at most.
        values: float64 ``(E,)`` in [0, 1].
        threshold: Pairs below it don't match; above 0.
        most_pairs: Whether more pairs go before a greater sum; else the sum alone decides.

    Raises:
        InvalidInput: When the threshold isn't in (0, 1].
    """
    if not 0.0 < threshold <= 1.0:
        raise InvalidInput(f"a threshold of {threshold} matches nothing sensible", expected="above 0 and at most 1")
    reaches = values >= threshold - SLACK
    rows, columns, values = rows[reaches], columns[reaches], values[reaches]

    # most pairs rival no other one
    rivals = (np.bincount(rows)[rows] > 1) | (np.bincount(columns)[columns] > 1) if len(rows) else np.zeros(0, bool)
    matched = [np.flatnonzero(~rivals)]
    contested = np.flatnonzero(rivals)
    for group in _groups(rows[contested], columns[contested]):
        edges = contested[group]
        matched.append(edges[_assign(rows[edges], columns[edges], values[edges], most_pairs)])
    chosen = np.concatenate(matched)
    chosen = chosen[np.argsort(rows[chosen])]
    return Matches(rows[chosen], columns[chosen], values[chosen])


def match_segments(old: Segments, new: Segments, threshold: float = 0.5, tau: float = TAU) -> Matches:
    """Match the segments of two detections of one image by line IoU.

    Verdicts follow these pairs from an earlier run's candidates to a later run's.

    Args:
        old: Segments, px; the rows of the result.
        new: Segments, px; the columns.
        threshold: Least line IoU of a pair.
        tau: Greatest distance of lines that count as one, px.
    """
    return match_one_to_one(line_iou_matrix(old, new, tau), threshold)


def _groups(rows: NDArray[np.int64], columns: NDArray[np.int64]) -> list[NDArray[np.int64]]:
    """Split edges ``(E,)`` into those of each connected part of the graph."""
    if not len(rows):
        return []
    first_column = int(rows.max()) + 1  # columns are numbered after the rows
    vertices = first_column + int(columns.max()) + 1
    graph = coo_array((np.ones(len(rows), np.int8), (rows, columns + first_column)), shape=(vertices, vertices))
    _, label = connected_components(graph, directed=False)
    group = label[rows]
    order = np.argsort(group, kind="stable")
    return np.split(order, np.flatnonzero(np.diff(group[order])) + 1)


def _assign(
    rows: NDArray[np.int64], columns: NDArray[np.int64], values: NDArray[np.float64], most_pairs: bool
) -> NDArray[np.int64]:
    """Return the edges ``(E,)`` of one connected part that the best assignment uses."""
    if len(values) == 1:
        return np.zeros(1, np.int64)
    row_index, row = np.unique(rows, return_inverse=True)
    column_index, column = np.unique(columns, return_inverse=True)
    # one pair more outweighs whatever all values can add up to
    pair = min(len(row_index), len(column_index)) + 1.0 if most_pairs else 0.0
    gain = np.zeros((len(row_index), len(column_index)))
    edge = np.full(gain.shape, -1, np.int64)
    gain[row, column] = pair + values
    edge[row, column] = np.arange(len(values))
    used = edge[linear_sum_assignment(gain, maximize=True)]
    return used[used >= 0]
