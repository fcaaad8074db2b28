"""Precision and recall of the best k candidates, for every k."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

_SLACK = 1e-9  # an overlap that equals the threshold but for rounding reaches it


@dataclass(frozen=True, eq=False)
class Ranking:
    """Candidates of all images in one order, the best first.

    Attributes:
        key: What they are ordered by, falling, float64 ``(C,)``.
        image: The image of each, int64 ``(C,)``.
        gain: 1 where a candidate lets one more label be matched than those before it, int64 ``(C,)``.
        labels: Labels per image, int64 ``(N,)``.
    """

    key: NDArray[np.float64]
    image: NDArray[np.int64]
    gain: NDArray[np.int64]
    labels: NDArray[np.int64]

    def curve(self, weights: NDArray[np.int64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return recall and precision after each candidate, image i counted ``weights[i]`` times, float64 ``(C,)``.

        Candidates of one key come together: all of them have the values after the last.
        """
        weight = weights[self.image]
        hits, taken = np.cumsum(weight * self.gain), np.cumsum(weight)
        last = np.searchsorted(-self.key, -self.key, side="right") - 1
        return hits[last] / max(weights @ self.labels, 1), hits[last] / np.maximum(taken[last], 1)

    def area(self, weights: NDArray[np.int64]) -> float:
        """Area under precision over recall, from no recall to that of all candidates.

        Precision is taken at each label found, not interpolated: a straight line between two points of this curve can't
        be reached (Davis and Goadrich, ICML 2006).
        """
        precision = self.curve(weights)[1]
        return float((weights[self.image] * self.gain) @ precision / max(weights @ self.labels, 1))


def rank(
    keys: Sequence[NDArray[np.floating]], labels: Sequence[int], overlaps: Sequence[csr_array], threshold: float
) -> Ranking:
    """Order the candidates of N images.

    Args:
        keys: N times a number per candidate; the greatest come first.
        labels: Number of labels of each image.
        overlaps: N times the line IoU of candidates and labels.
        threshold: Least line IoU of a pair that may match.
    """
    image = np.repeat(np.arange(len(keys)), [len(key) for key in keys])
    gains = [
        gained(matrix, np.argsort(-key, kind="stable"), threshold) for key, matrix in zip(keys, overlaps, strict=True)
    ]
    key = np.concatenate(keys).astype(np.float64)
    order = np.argsort(-key, kind="stable")
    return Ranking(key[order], image[order], np.concatenate(gains)[order], np.array(labels, np.int64))


def gained(overlap: csr_array, order: NDArray[np.int64], threshold: float) -> NDArray[np.int64]:
    """Return which candidates of one image let one more label be matched than those before them, int64 ``(C,)``.

    A greatest one-to-one matching grows with every candidate by one augmenting path or not at all (Berge, 1957; Kuhn,
    1955), so the sum over the first k in order is the size of the greatest matching of those k.

    Args:
        overlap: Line IoU ``(C, L)``.
        order: Indices of the candidates, int64 ``(C,)``.
        threshold: Least line IoU of a pair that may match.
    """
    labels = [
        overlap.indices[begin:end][overlap.data[begin:end] >= threshold - _SLACK].tolist()
        for begin, end in zip(overlap.indptr[:-1], overlap.indptr[1:], strict=True)
    ]
    holder: dict[int, int] = {}

    def find_label(candidate: int, tried: set[int]) -> bool:
        for label in labels[candidate]:
            if label not in tried:
                tried.add(label)
                if label not in holder or find_label(holder[label], tried):
                    holder[label] = candidate
                    return True
        return False

    gain = np.zeros(len(labels), np.int64)
    for candidate in order.tolist():
        gain[candidate] = find_label(candidate, set())
    return gain
