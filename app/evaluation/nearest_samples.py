"""The nearest sample of every polyline that passes near a sample, for two sets of polylines at once.

Samples are taken eight at a time: runs of neighbours whose circles come near each other are found by a tree, and only
in those pairs of runs are distances taken. The result is that of comparing all samples with all.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from app.evaluation.resampling import Samples

_RUN = 8  # samples
_PAIRS_LISTED = 1 << 18  # pairs of runs held at once: about 100 MB with all that is made of them
_PAIRS_AT_ONCE = 1 << 11  # pairs of runs whose distances are in the processor's cache together


@dataclass(frozen=True, eq=False)
class Nearest:
    """N times a sample of one set, and the sample of a polyline of the other set that is nearest to it.

    Attributes:
        sample: int64 ``(N,)``.
        nearest: int64 ``(N,)``.
    """

    sample: NDArray[np.int64]
    nearest: NDArray[np.int64]


def nearest_samples(a: Samples, b: Samples, reach: float) -> Iterator[tuple[Nearest, Nearest]]:
    """Find, for each sample of a and each polyline of b within reach, the polyline's nearest sample; and the reverse.

    Args:
        a: A polylines.
        b: B polylines.
        reach: Samples further apart are left out, px.

    Yields:
        For some whole polylines of a at a time: samples of theirs with samples of b, and samples of b with theirs.
    """
    if not len(a) or not len(b):
        return
    runs_a, runs_b = _Runs.of(a), _Runs.of(b)
    tree = KDTree(runs_b.centers)
    for block in _blocks(runs_a, tree, reach + runs_a.radius + runs_b.radius):
        pairs = KDTree(runs_a.centers[block]).sparse_distance_matrix(
            tree, reach + runs_a.radius + runs_b.radius, output_type="ndarray"
        )
        if len(pairs):
            yield _compare(a, runs_a.samples[block[pairs["i"]]], b, runs_b.samples[pairs["j"]], reach)


@dataclass(frozen=True, eq=False)
class _Runs:
    """R runs of eight neighbouring samples at most; short ones repeat their last sample.

    Attributes:
        samples: int64 ``(R, 8)``.
        centers: float64 ``(R, 2)``.
        radius: No sample is further from its run's centre, px.
        first_of_polyline: int64 ``(S,)``, the first run of each polyline.
    """

    samples: NDArray[np.int64]
    centers: NDArray[np.float64]
    radius: float
    first_of_polyline: NDArray[np.int64]

    @classmethod
    def of(cls, samples: Samples) -> _Runs:
        """Cut polylines into runs."""
        counts = np.diff(samples.offsets)
        runs = -(-counts // _RUN)
        first = np.cumsum(runs) - runs
        polyline = np.repeat(np.arange(len(samples)), runs)
        begin = samples.offsets[polyline] + (np.arange(len(polyline)) - first[polyline]) * _RUN
        index = np.minimum(begin[:, None] + np.arange(_RUN), samples.offsets[polyline + 1][:, None] - 1)
        points = samples.points[index]
        low, high = points.min(axis=1), points.max(axis=1)
        radius = np.hypot(*(high - low).T).max() / 2
        return cls(index, (low + high) / 2, float(radius), first)


def _blocks(runs: _Runs, tree: KDTree, distance: float) -> list[NDArray[np.int64]]:
    """Split the runs into those of a few whole polylines, so that a pile of lines can't fill the memory."""
    every = np.arange(len(runs.centers))
    near = np.asarray(tree.query_ball_point(runs.centers, distance, return_length=True), dtype=np.int64)
    per_polyline = np.add.reduceat(near, runs.first_of_polyline)
    block = np.cumsum(per_polyline) // _PAIRS_LISTED
    return np.split(every, runs.first_of_polyline[np.flatnonzero(np.diff(block)) + 1])


def _compare(
    a: Samples, runs_a: NDArray[np.int64], b: Samples, runs_b: NDArray[np.int64], reach: float
) -> tuple[Nearest, Nearest]:
    """Compare all samples of paired runs, both int64 ``(M, 8)``."""
    to_a, to_b = [], []
    for start in range(0, len(runs_a), _PAIRS_AT_ONCE):
        # pairs lie along the last axis, where numpy is quickest
        of_a, of_b = runs_a[start : start + _PAIRS_AT_ONCE].T, runs_b[start : start + _PAIRS_AT_ONCE].T
        square = np.zeros((_RUN, _RUN, of_a.shape[1]))
        for axis in (0, 1):
            difference = a.points[of_a, axis][:, None] - b.points[of_b, axis]
            square += difference * difference
        to_b.append(_least(square, of_a, of_b, reach))
        to_a.append(_least(square.transpose(1, 0, 2), of_b, of_a, reach))
    return _nearest_per_polyline(to_b, b), _nearest_per_polyline(to_a, a)


_Candidates = tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]


def _least(
    square: NDArray[np.float64], samples: NDArray[np.int64], others: NDArray[np.int64], reach: float
) -> _Candidates:
    """Return, for each sample of a run, the nearest sample of the other run and its squared distance, within reach."""
    least = square.min(axis=1)
    row, pair = np.nonzero(least <= reach * reach)
    column = square[row, :, pair].argmin(axis=1)
    return samples[row, pair], others[column, pair], least[row, pair]


def _nearest_per_polyline(candidates: list[_Candidates], others: Samples) -> Nearest:
    """Keep, for each sample and polyline of ``others``, the nearest of the candidates."""
    sample, other, square = (np.concatenate(parts) for parts in zip(*candidates, strict=True))
    key = sample * len(others) + others.polyline[other]
    order = np.argsort(key)
    key, square = key[order], square[order]
    starts = np.flatnonzero(np.diff(key, prepend=-1))
    least = np.repeat(np.minimum.reduceat(square, starts), np.diff(starts, append=len(key))) if len(key) else square
    nearest = np.flatnonzero(square <= least)
    nearest = order[nearest[np.diff(key[nearest], prepend=-1) != 0]]
    return Nearest(sample[nearest], other[nearest])
