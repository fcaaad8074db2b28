"""Which labelled lines can still be found from what a stage of detection left."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from app.evaluation.line_iou import MAXIMUM_TURN, TAU, line_iou_matrix
from app.evaluation.resampling import Samples, resample
from app.vision import Segments
from app.vision.edges import EdgeMap

from .strict_score import THRESHOLD, covered_samples

LEAST_COVERED = 0.6
"""Share of a line's length that must be there, in whatever pieces."""


def are_supported(labels: Segments, edges: EdgeMap) -> NDArray[np.bool_]:
    """Whether edge points of either pass lie along most of each line, bool ``(L,)``.

    A sample of a line counts where a point lies within 3 px whose edge runs within 15 degrees of the line.
    """
    samples = resample(labels)
    places, directions = [], []
    for axis, points in enumerate(edges.points):
        along, slope = points["along"].astype(np.float64), points["slope"].astype(np.float64)
        place = np.stack([along, points["across"]], axis=1)
        direction = np.stack([np.ones_like(slope), slope], axis=1) / np.hypot(1, slope)[:, None]
        # of the pass along y, what runs along it is y
        places.append(place[:, ::-1] if axis else place)
        directions.append(direction[:, ::-1] if axis else direction)
    direction = np.concatenate(directions)
    near = KDTree(samples.points).sparse_distance_matrix(KDTree(np.concatenate(places)), TAU, output_type="ndarray")
    cosine = np.abs((samples.tangents[near["i"]] * direction[near["j"]]).sum(axis=1))
    there = np.zeros(len(samples.points), np.bool_)
    there[near["i"][cosine >= np.cos(MAXIMUM_TURN)]] = True
    return _shares(there, samples) >= LEAST_COVERED


def are_covered(labels: Segments, pieces: Segments) -> NDArray[np.bool_]:
    """Whether pieces cover most of each line, together, bool ``(L,)``."""
    return _shares(covered_samples(labels, pieces), resample(labels)) >= LEAST_COVERED


def are_found(labels: Segments, segments: Segments) -> NDArray[np.bool_]:
    """Whether any one segment is each line by the measure of the strict score, bool ``(L,)``."""
    if not len(segments) or not len(labels):
        return np.zeros(len(labels), np.bool_)
    best = line_iou_matrix(segments, labels).max(axis=0).toarray().ravel()
    return best >= THRESHOLD - 1e-9


def _shares(there: NDArray[np.bool_], samples: Samples) -> NDArray[np.float64]:
    sums = np.bincount(samples.polyline, weights=there, minlength=len(samples))
    return sums / np.diff(samples.offsets)
