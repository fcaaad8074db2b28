"""Protocol official-v1: precision, recall and F1 as the evaluation script of the ClearLines paper computes them.

Source: ``evaluate.py`` that goes with Schroeder, Sabry, Olaverri-Monreal, "ClearLines - Camera Calibration from
Straight Lines", IEEE IV 2025. Per image, a prediction is a true positive when the IoU of its bounding box with that of
*any* label is at least 0.5; precision and recall are averaged over the images, and F1 is taken of the averages.
Nothing is matched one-to-one, so recall can exceed 1. It serves comparison with published numbers.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.errors import InvalidInput
from app.evaluation.boxes import iou_blocks, padded_boxes
from app.evaluation.ground_truth import GroundTruth
from app.evaluation.layout import Layout
from app.evaluation.metrics import harmonic_mean, quotient
from app.evaluation.outcome import Outcomes, label_outcomes, prediction_outcomes
from app.vision.segments import Segments

PROTOCOL = "official-v1"
IOU_THRESHOLD = 0.5

LAYOUT = Layout((("images", ()), ("precision_sum", ()), ("recall_sum", ()), ("images_with_recall", ())))
"""What stands where in the tallies of an image, float64 ``(K,)``."""

METRICS = ("official_precision", "official_recall", "official_f1")
"""What `metrics` returns."""


@dataclass(frozen=True, eq=False)
class ImageScore:
    """Score of one image.

    Attributes:
        precision: True positives / predictions; 0 where there are no predictions.
        recall: True positives / labels, may exceed 1; 0 where there is neither a label nor a prediction; ``None``
            where there are predictions but no labels (the script crashes there): left out of the mean.
        true_positives: Predictions whose best IoU over the labels is at least 0.5.
        predictions: Predictions that count.
        labels: Labels that count.
        best_iou: float64 ``(P,)``, highest box IoU of each prediction with a label that counts; 0 without any.
        best_label: int64 ``(P,)``, the first label with that IoU, as index into the ground truth; -1 where it is 0.
        outcomes: What became of each prediction and label; a label is found when its box has IoU >= 0.5 with any
            prediction.
    """

    precision: float
    recall: float | None
    true_positives: int
    predictions: int
    labels: int
    best_iou: NDArray[np.float64]
    best_label: NDArray[np.int64]
    outcomes: Outcomes
    protocol: str = PROTOCOL

    @property
    def tallies(self) -> NDArray[np.float64]:
        """What is added up over images, float64 ``(K,)``, see `LAYOUT`."""
        return LAYOUT.pack(
            {
                "images": 1,
                "precision_sum": self.precision,
                "recall_sum": self.recall or 0.0,
                "images_with_recall": self.recall is not None,
            }
        )


@dataclass(frozen=True)
class Totals:
    """Score of a set of images.

    Attributes:
        precision: Mean over all images.
        recall: Mean over the images whose recall is defined; 0 where there is none.
        f1: ``2PR / (P + R)`` of the means; 0 where both are 0 (the script divides by zero there).
        images: Number of images.
        true_positives: Sum over the images.
        predictions: Sum over the images.
        labels: Sum over the images.
        without_recall: Images that the mean recall leaves out.
    """

    precision: float
    recall: float
    f1: float
    images: int
    true_positives: int
    predictions: int
    labels: int
    without_recall: int
    protocol: str = PROTOCOL


def score_image(truth: GroundTruth, predictions: Segments) -> ImageScore:
    """Score the predictions of one image.

    An ignored label takes no part, except that a prediction which reaches IoU 0.5 with it and with no other label is
    left out. Without ignored labels the result is that of the script.

    Args:
        truth: The labels of the image.
        predictions: The detector's segments, px.
    """
    best_iou, best_label, on_ignored, found = _best_overlaps(truth, predictions)
    hit = best_iou >= IOU_THRESHOLD
    ignored = on_ignored & ~hit
    true_positives = int(hit.sum())
    predicted = len(predictions) - int(ignored.sum())
    labelled = len(truth) - int(truth.ignored.sum())
    return ImageScore(
        precision=true_positives / predicted if predicted else 0.0,
        recall=_recall(true_positives, labelled, predicted),
        true_positives=true_positives,
        predictions=predicted,
        labels=labelled,
        best_iou=best_iou,
        best_label=best_label,
        outcomes=Outcomes(prediction_outcomes(hit, ignored), label_outcomes(found, truth.ignored)),
    )


def total(scores: Sequence[ImageScore]) -> Totals:
    """Average the scores of images.

    Raises:
        InvalidInput: When there are no images.
    """
    if not scores:
        raise InvalidInput("there are no images to average over", expected="at least one image")
    recalls = [score.recall for score in scores if score.recall is not None]
    precision = sum(score.precision for score in scores) / len(scores)
    recall = sum(recalls) / len(recalls) if recalls else 0.0
    return Totals(
        precision=precision,
        recall=recall,
        f1=2 * (precision * recall) / (precision + recall) if precision + recall > 0 else 0.0,
        images=len(scores),
        true_positives=sum(score.true_positives for score in scores),
        predictions=sum(score.predictions for score in scores),
        labels=sum(score.labels for score in scores),
        without_recall=len(scores) - len(recalls),
    )


def metrics(tallies: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
    """Return precision, recall and F1 from tallies ``(..., K)`` that were added up, as `total` does for one set."""
    part = LAYOUT.unpack(np.asarray(tallies, np.float64))
    precision = quotient(part["precision_sum"], part["images"])
    recall = quotient(part["recall_sum"], part["images_with_recall"], empty=0.0)
    return {
        "official_precision": precision,
        "official_recall": recall,
        "official_f1": harmonic_mean(precision, recall),
    }


def _recall(true_positives: int, labelled: int, predicted: int) -> float | None:
    if labelled:
        return true_positives / labelled
    return None if predicted else 0.0


def _best_overlaps(
    truth: GroundTruth, predictions: Segments
) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.bool_], NDArray[np.bool_]]:
    """Return per prediction the best IoU, its label and whether an ignored label is reached; per label, if found."""
    count = len(predictions)
    best_iou = np.zeros(count)
    best_label = np.full(count, -1, np.int64)
    on_ignored = np.zeros(count, bool)
    found = np.zeros(len(truth), bool)
    any_ignored = bool(truth.ignored.any())
    if not len(truth):
        return best_iou, best_label, on_ignored, found
    for rows, iou in iou_blocks(padded_boxes(predictions), padded_boxes(truth.segments)):
        reached = iou >= IOU_THRESHOLD
        found |= reached.any(axis=0)
        on_ignored[rows] = any_ignored and reached[:, truth.ignored].any(axis=1)
        counting = np.where(truth.ignored, 0.0, iou) if any_ignored else iou
        best = counting.argmax(axis=1)
        best_iou[rows] = counting[np.arange(len(best)), best]
        best_label[rows] = np.where(best_iou[rows] > 0, best, -1)
    return best_iou, best_label, on_ignored, found
