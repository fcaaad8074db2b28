"""M3, average precision: only where predictions have scores.

Predictions are matched greedily from the highest score down, those of equal score together, as one group: the order of
equal scores means nothing, so no number may depend on it. Source: the 101-point interpolation of COCO (Lin et al.,
"Microsoft COCO", ECCV 2014); for line segments the structural AP of L-CNN (Zhou et al., ICCV 2019) is the precedent.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.errors import InvalidInput
from app.evaluation.assignment import Rivalry
from app.evaluation.covering import SLACK
from app.evaluation.line_iou import Overlaps
from app.evaluation.matching import match_pairs
from app.evaluation.metrics import quotient
from app.vision.segments import Segments

RECALL_LEVELS = np.linspace(0.0, 1.0, 101)
"""Where the precision is read."""

_BLOCK_CELLS = 1 << 22


@dataclass(frozen=True, eq=False)
class Ranked:
    """What became of the R predictions of one image that count, in a greedy matching by score.

    Attributes:
        scores: float32 ``(R,)``, falling.
        hit: bool ``(R,)``, whether it took a label.
        labels: Labels that count.
    """

    scores: NDArray[np.float32]
    hit: NDArray[np.bool_]
    labels: int


def rank_predictions(rivalry: Rivalry, predictions: Segments, *, labels: int, threshold: float) -> Ranked | None:
    """Match the predictions of one image greedily by score.

    A prediction takes the free label with its highest line IoU of at least the threshold. Predictions of equal score
    are matched at once: as many pairs as possible, then the greatest sum.

    Args:
        rivalry: Which labels the predictions compete for; those that take none and are excused aren't ranked.
        predictions: P segments.
        labels: Number of labels that count.
        threshold: Least line IoU.

    Returns:
        ``None`` where there are predictions without scores.
    """
    scores = predictions.scores
    if scores is None:
        if len(predictions):
            return None
        scores = np.zeros(0, np.float32)
    hit = _greedy(rivalry.pairs, scores, threshold)
    order = np.argsort(-scores, kind="stable")
    order = order[(hit | ~rivalry.excused(threshold))[order]]
    return Ranked(scores[order], hit[order], labels)


def average_precision(ranked: Sequence[Ranked], weights: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
    """Return the average precision of a set of images, or of many draws of it.

    ``AP = mean over r in {0, .01, ..., 1} of max {P(k) : R(k) >= r}``, where k runs over the scores that occur, P(k)
    and R(k) are the precision and recall of all predictions with that score or a higher one, and the maximum over
    nothing is 0. Without labels 0, or 1 where there is no prediction either.

    Args:
        ranked: I images.
        weights: ``(B, I)`` or ``(I,)``, how often each image counts; once if not given.

    Returns:
        float64 ``(B,)`` or ``()``.

    Example:
        >>> image = Ranked(np.float32([0.9, 0.8, 0.7]), np.array([True, False, True]), labels=2)
        >>> average_precision([image]).round(4).item()  # P is 1 up to R = .5, then 2/3
        0.835
    """
    every = np.ones((1, len(ranked))) if weights is None else np.atleast_2d(np.asarray(weights, np.float64))
    if every.ndim != 2 or every.shape[1] != len(ranked):
        raise InvalidInput(f"weights have shape {every.shape}", where="weights", expected=f"(B, {len(ranked)})")
    curve = _Curve.of(ranked)
    rows = max(1, _BLOCK_CELLS // max(1, len(curve.image)))
    values = np.concatenate([curve.average(every[start : start + rows]) for start in range(0, len(every), rows)])
    return values if weights is not None and np.ndim(weights) == 2 else values[0]


@dataclass(frozen=True, eq=False)
class _Curve:
    """The predictions of all images by falling score, and the places where a score occurs for the last time."""

    image: NDArray[np.int64]
    hit: NDArray[np.bool_]
    last: NDArray[np.int64]
    labels: NDArray[np.float64]

    @classmethod
    def of(cls, ranked: Sequence[Ranked]) -> _Curve:
        scores = np.concatenate([np.zeros(0, np.float32), *(image.scores for image in ranked)])
        hit = np.concatenate([np.zeros(0, bool), *(image.hit for image in ranked)])
        image = np.repeat(np.arange(len(ranked), dtype=np.int64), [len(image.scores) for image in ranked])
        order = np.argsort(-scores, kind="stable")
        last = np.flatnonzero(np.diff(scores[order], append=np.nan) != 0)
        labels = np.array([image.labels for image in ranked], np.float64)
        return cls(image[order], hit[order], last, labels)

    def average(self, weights: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the average precision for weights ``(B, I)``, float64 ``(B,)``."""
        labels = weights @ self.labels
        weight = weights[:, self.image]
        predicted = np.cumsum(weight, axis=1)[:, self.last]
        hits = np.cumsum(weight * self.hit, axis=1)[:, self.last]
        best_from = np.maximum.accumulate(quotient(hits, predicted, empty=0.0)[:, ::-1], axis=1)[:, ::-1]
        best_from = np.append(best_from, np.zeros((len(weights), 1)), axis=1)
        values = np.empty(len(weights))
        for draw, (hits_of_draw, labels_of_draw) in enumerate(zip(hits, labels, strict=True)):
            if not labels_of_draw:
                values[draw] = float(not predicted[draw].any())
                continue
            first = np.searchsorted(hits_of_draw, RECALL_LEVELS * labels_of_draw - SLACK)
            values[draw] = best_from[draw, first].mean()
        return values


def _greedy(overlaps: Overlaps, scores: NDArray[np.float32], threshold: float) -> NDArray[np.bool_]:
    """Whether each prediction takes a label, bool ``(P,)``."""
    hit = np.zeros(len(scores), bool)
    reaches = np.flatnonzero(overlaps.iou >= threshold - SLACK)
    order = reaches[np.argsort(-scores[overlaps.row[reaches]], kind="stable")]
    score = scores[overlaps.row[order]]
    rows, columns = overlaps.row, overlaps.column
    taken: set[int] = set()
    for group in np.split(order, np.flatnonzero(np.diff(score)) + 1):
        free = [edge for edge in group.tolist() if columns[edge] not in taken]
        if len(group) == 1:
            hit[rows[free]] = True
            taken.update(columns[free].tolist())
        elif free:
            matches = match_pairs(rows[free], columns[free], overlaps.iou[free], threshold)
            hit[matches.row] = True
            taken.update(matches.column.tolist())
    return hit
