"""Strict scores of detections: one-to-one by line IoU of at least 0.5, counted over all images together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from app.evaluation.line_iou import covered_lengths, line_iou_matrix
from app.evaluation.matching import match_one_to_one
from app.evaluation.resampling import Samples, resample
from app.vision import Segments

THRESHOLD = 0.5


@dataclass(frozen=True, eq=False)
class Counts:
    """Counts of N images.

    Attributes:
        hits: Matched pairs, ``(N,)``.
        predictions: Segments found, ``(N,)``.
        labels: Lines labelled, ``(N,)``.
        covered: Samples of the labels, one per px, that any prediction covers, ``(N,)``.
        samples: Samples of the labels, ``(N,)``.
    """

    hits: NDArray[np.int64]
    predictions: NDArray[np.int64]
    labels: NDArray[np.int64]
    covered: NDArray[np.int64]
    samples: NDArray[np.int64]

    @property
    def once(self) -> NDArray[np.int64]:
        """Weights ``(N,)`` that count every image once."""
        return np.ones_like(self.hits)

    def precision(self, weights: NDArray[np.int64]) -> float:
        """Share of the segments found that are matched, image i counted ``weights[i]`` times."""
        return float(weights @ self.hits / max(weights @ self.predictions, 1))

    def recall(self, weights: NDArray[np.int64]) -> float:
        """Share of the labels that are matched."""
        return float(weights @ self.hits / max(weights @ self.labels, 1))

    def length_recall(self, weights: NDArray[np.int64]) -> float:
        """Share of the labelled length that any segment covers."""
        return float(weights @ self.covered / max(weights @ self.samples, 1))


def count(found: Sequence[Segments], labels: Sequence[Segments], overlaps: Sequence[csr_array]) -> Counts:
    """Count hits and misses image by image.

    Args:
        found: N times the segments found, px; short ones are left out already.
        labels: N times the labelled lines, px.
        overlaps: N times their line IoU, see `overlap`.
    """
    covered = [covered_samples(truth, segments) for segments, truth in zip(found, labels, strict=True)]
    return Counts(
        np.array([len(match_one_to_one(matrix, THRESHOLD).row) for matrix in overlaps], np.int64),
        np.array([len(segments) for segments in found], np.int64),
        np.array([len(truth) for truth in labels], np.int64),
        np.array([mask.sum() for mask in covered], np.int64),
        np.array([len(mask) for mask in covered], np.int64),
    )


def overlap(found: Sequence[Segments], labels: Sequence[Segments]) -> list[csr_array]:
    """Return the line IoU of segments found and labelled lines, image by image."""
    return [line_iou_matrix(segments, truth) for segments, truth in zip(found, labels, strict=True)]


def covered_samples(labels: Segments, found: Segments) -> NDArray[np.bool_]:
    """Whether any of the segments found covers the labels' samples, one per px of arc length, bool ``(N,)``."""
    samples = resample(labels)
    # Every sample becomes a line of its own, standing twice at its place: a line has at least two samples, and
    # what any segment covers can't be added up over lines that share one
    lines = Samples(
        np.repeat(samples.points, 2, axis=0),
        np.repeat(samples.tangents, 2, axis=0),
        np.repeat(np.arange(len(samples.points)), 2),
        np.arange(0, 2 * len(samples.points) + 1, 2),
        np.ones(len(samples.points)),
    )
    return covered_lengths(lines, resample(found))[0].sum(axis=1) > 0
