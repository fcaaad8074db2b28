"""M8: in what way each false positive and each false negative of clearlines-v2 is wrong.

After TIDE (Bolya, Foley, Hays and Hoffman, "A general toolbox for identifying object detection errors", ECCV 2020),
with the types that lines call for. Each error has exactly one type: the first one below that fits. A segment runs
along another one where that covers it (`app.evaluation.covering`); tau is 3 px, t is 0.5.

A false positive p is

- *duplicate* if its line IoU with a label is at least t: another prediction took that label;
- *fragment* if half of it or more runs along a label, but less than half of that label along it; *over-extended* if
  half of a label or more runs along it, but less than half of it along that label: it runs on beyond the label's end,
  or over several labels. Where both fit, the label that it shares the greatest length with decides;
- *offset* or *wrong angle* if half of it or more lies within 4 tau of a label, in whatever direction. With g the one
  whose mean distance is least, and a straight line fitted to the signed distances of p from g, it has a *wrong angle*
  if that line's slope alone leads further than tau away from g and accounts for more of the distances (root mean
  square) than their mean does, or if more than half of the points are turned by more than 15 degrees; else it is
  *offset*, across the label or along it;
- *background* otherwise: nothing like it was labelled.

A false negative g is

- *fragmented* if two or more predictions, of each of which half or more runs along g, cover half of g or more together,
  while none has a line IoU of t with it;
- *missed* otherwise.

Ignored labels serve as g too: a piece of a line that nobody could judge is no background.

Example:
    Of a horizontal label of 400 px: a second copy is a duplicate, its left 150 px alone are a fragment, a line of
    1000 px over it is over-extended, the label moved down by 8 px is offset, turned about its middle by 3 degrees it
    has a wrong angle.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from app.evaluation.clearlines_v2 import ImageScore
from app.evaluation.covering import MAXIMUM_TURN, SLACK, TAU, Cover, mutual_cover
from app.evaluation.extent import LYING_SHARE
from app.evaluation.ground_truth import GroundTruth
from app.evaluation.line_iou import Overlaps
from app.evaluation.outcome import Outcome
from app.evaluation.resampling import Samples, resample
from app.evaluation.tallies import THRESHOLD
from app.vision.segments import Segments

NEAR = 4 * TAU
"""Greatest distance, px, at which a prediction can still be a label's, only out of place."""

FEWEST_PIECES = 2

_STEP = 3.0  # px between the points whose distances are taken
_ANY_TURN = float(np.pi / 2)


class ErrorType(IntEnum):
    """In what way a segment is wrong."""

    NONE = 0
    DUPLICATE = 1
    FRAGMENT = 2
    OVER_EXTENDED = 3
    OFFSET = 4
    WRONG_ANGLE = 5
    BACKGROUND = 6
    MISSED = 7
    FRAGMENTED = 8


FALSE_POSITIVES = tuple(ErrorType(number) for number in range(ErrorType.DUPLICATE, ErrorType.MISSED))
FALSE_NEGATIVES = (ErrorType.MISSED, ErrorType.FRAGMENTED)


@dataclass(frozen=True, eq=False)
class ErrorTypes:
    """The type of every error of one image.

    Attributes:
        predictions: int8 ``(P,)``, ``NONE`` for true positives and ignored ones.
        labels: int8 ``(L,)``, ``NONE`` for found and ignored ones.
    """

    predictions: NDArray[np.int8]
    labels: NDArray[np.int8]

    def counts(self) -> NDArray[np.float64]:
        """Return how many errors there are of each type but ``NONE``, in its order, float64 ``(E,)``."""
        both = np.concatenate([self.predictions, self.labels])
        return np.bincount(both, minlength=len(ErrorType))[1:].astype(np.float64)


def error_types(truth: GroundTruth, predictions: Segments, score: ImageScore) -> ErrorTypes:
    """Tell the type of every error of an image.

    Args:
        truth: The L labels of the image.
        predictions: The P predictions that were scored, px.
        score: Their score.
    """
    wrong = np.flatnonzero(score.outcomes.predictions == Outcome.FALSE_ALARM)
    along = _along_a_label(score.overlaps, predictions.lengths(), truth.segments.lengths())
    types = np.zeros(len(predictions), np.int8)
    types[wrong] = along[wrong]
    types[wrong[score.best_liou[wrong] >= THRESHOLD - SLACK]] = ErrorType.DUPLICATE
    left = wrong[types[wrong] == ErrorType.NONE]
    types[left] = _beside_a_label(predictions.select(left), truth.segments)

    reached = np.zeros(len(truth), bool)
    reached[score.overlaps.column[score.overlaps.iou >= THRESHOLD - SLACK]] = True
    missed = score.outcomes.labels == Outcome.MISS
    in_pieces = score.extent.detected & (score.extent.pieces >= FEWEST_PIECES) & ~reached
    of_labels = np.select([missed & in_pieces, missed], [ErrorType.FRAGMENTED, ErrorType.MISSED], ErrorType.NONE)
    return ErrorTypes(types, of_labels.astype(np.int8))


def _along_a_label(
    overlaps: Overlaps, lengths: NDArray[np.float64], label_lengths: NDArray[np.float64]
) -> NDArray[np.int8]:
    """Return ``FRAGMENT`` or ``OVER_EXTENDED`` for predictions that run along a label, int8 ``(P,)``, else ``NONE``."""
    types = np.zeros(len(lengths), np.int8)
    on_label = overlaps.row_length >= (LYING_SHARE - SLACK) * lengths[overlaps.row]
    under_prediction = overlaps.column_length >= (LYING_SHARE - SLACK) * label_lengths[overlaps.column]
    chosen = np.flatnonzero(on_label != under_prediction)
    common = (overlaps.row_length + overlaps.column_length)[chosen]
    chosen = chosen[np.argsort(common, kind="stable")]  # what comes last stays
    types[overlaps.row[chosen]] = np.where(on_label[chosen], ErrorType.FRAGMENT, ErrorType.OVER_EXTENDED)
    return types


def _beside_a_label(wrong: Segments, labels: Segments) -> NDArray[np.int8]:
    """Return ``OFFSET``, ``WRONG_ANGLE`` or ``BACKGROUND`` for predictions that run along no label, int8 ``(W,)``."""
    types = np.full(len(wrong), ErrorType.BACKGROUND, np.int8)
    if not len(wrong) or not len(labels):
        return types
    found, target = resample(wrong, _STEP), resample(labels, _STEP)
    near, _ = mutual_cover(found, target, NEAR, _ANY_TURN)
    near = _of_nearest_label(found, target, near)
    row = found.polyline[near.sample]
    is_near, angle = np.zeros((2, len(wrong)), bool)
    is_near[row] = True
    angle[row] = _is_turned(found, target, near)[row]
    types[is_near] = np.where(angle[is_near], ErrorType.WRONG_ANGLE, ErrorType.OFFSET)
    return types


def _of_nearest_label(found: Samples, target: Samples, near: Cover) -> Cover:
    """Keep the entries of the label that a prediction lies beside; none where less than half of it is near one."""
    pairs, pair = np.unique(
        found.polyline[near.sample] * len(target) + target.polyline[near.nearest], return_inverse=True
    )
    row = pairs // len(target)
    samples = np.diff(found.offsets)[row]
    count = np.bincount(pair, minlength=len(pairs))
    mean_distance = (np.bincount(pair, near.distance, len(pairs)) + (samples - count) * NEAR) / samples
    beside = np.flatnonzero(count >= (LYING_SHARE - SLACK) * samples)
    beside = beside[np.argsort(-mean_distance[beside], kind="stable")]  # what comes last stays
    chosen = np.full(len(found), -1, np.int64)
    chosen[row[beside]] = beside
    return near.select(chosen[row[pair]] == pair)


def _is_turned(found: Samples, target: Samples, near: Cover) -> NDArray[np.bool_]:
    """Whether what is wrong with each prediction is its angle rather than its distance, bool ``(W,)``."""
    row, count = found.polyline[near.sample], len(found)
    samples = np.maximum(np.bincount(row, minlength=count), 1)
    tangent = target.tangents[near.nearest]
    normal = np.stack([-tangent[:, 1], tangent[:, 0]], axis=1)
    offset = ((found.points[near.sample] - target.points[near.nearest]) * normal).sum(axis=1)
    position = near.sample.astype(np.float64)  # samples are at even steps

    def mean(values: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.bincount(row, values, count) / samples

    mean_offset = mean(offset)
    along = position - mean(position)[row]
    spread = mean(along**2)
    slope = np.divide(mean(along * offset), spread, out=np.zeros(count), where=spread > 0)
    cosine = np.abs((found.tangents[near.sample] * tangent).sum(axis=1))
    turned = mean((cosine < np.cos(MAXIMUM_TURN) - 1e-12).astype(np.float64))
    tilt = np.abs(slope) * np.sqrt(spread)
    # of a line that is centred, the end is sqrt(3) times its root mean square away
    return ((tilt > np.abs(mean_offset)) & (np.sqrt(3) * tilt > TAU)) | (turned > 0.5)
