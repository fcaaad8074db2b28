"""Protocol official-v1-fixed: the boxes and the threshold of official-v1, matched one-to-one.

What the paper's numbers would have been had each label counted once. Pairs with a box IoU of at least 0.5 are matched
so that the sum of their IoU is the greatest (Hungarian method). It still compares boxes, not lines.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.evaluation import metrics as formula
from app.evaluation.boxes import iou_blocks, padded_boxes
from app.evaluation.ground_truth import GroundTruth
from app.evaluation.layout import Layout
from app.evaluation.matching import Matches, match_pairs
from app.evaluation.official_v1 import IOU_THRESHOLD
from app.evaluation.outcome import Outcomes, label_outcomes, prediction_outcomes
from app.vision.segments import Segments

PROTOCOL = "official-v1-fixed"

LAYOUT = Layout(
    (
        ("tp", ()),
        ("fp", ()),
        ("fn", ()),
        ("images", ()),
        ("precision_sum", ()),
        ("recall_sum", ()),
        ("images_with_recall", ()),
    )
)
"""What stands where in the tallies of an image, float64 ``(K,)``."""

METRICS = (
    "fixed_precision",
    "fixed_recall",
    "fixed_f1",
    "fixed_macro_precision",
    "fixed_macro_recall",
    "fixed_macro_f1",
)
"""What `metrics` returns."""


@dataclass(frozen=True, eq=False)
class ImageScore:
    """Score of one image with P predictions and L labels.

    Attributes:
        precision: True positives / predictions; without predictions 0, or 1 where there is no label either.
        recall: True positives / labels; without labels 1 where there is no prediction either, else ``None``.
        outcomes: What became of each prediction and label.
        matches: True positives: prediction (``row``), label (``column``) and box IoU (``value``).
        best_iou: float64 ``(P,)``, highest box IoU of each prediction over all labels, ignored ones included.
        best_label: int64 ``(P,)``, the first label with it; -1 where it is 0.
        tallies: float64 ``(K,)``, see `LAYOUT`.
    """

    precision: float
    recall: float | None
    outcomes: Outcomes
    matches: Matches
    best_iou: NDArray[np.float64]
    best_label: NDArray[np.int64]
    tallies: NDArray[np.float64]
    protocol: str = PROTOCOL


def score_image(truth: GroundTruth, predictions: Segments) -> ImageScore:
    """Score the predictions of one image.

    An unmatched prediction whose highest IoU over all labels is at least 0.5 and belongs to an ignored label is left
    out.

    Args:
        truth: The labels of the image.
        predictions: The detector's segments, px.
    """
    best_iou, best_label, (row, column, iou) = _overlaps(truth.segments, predictions)
    counts = ~truth.ignored[column]
    matches = match_pairs(row[counts], column[counts], iou[counts], IOU_THRESHOLD, most_pairs=False)
    hit, found = np.zeros(len(predictions), bool), np.zeros(len(truth), bool)
    hit[matches.row], found[matches.column] = True, True
    ignored = ~hit & (best_iou >= IOU_THRESHOLD) & np.append(truth.ignored, False)[best_label]

    tp = len(matches.row)
    fp = len(predictions) - tp - int(ignored.sum())
    fn = len(truth) - int(truth.ignored.sum()) - tp
    precision = float(formula.precision(tp, fp, fn))
    recall = None if fp and not tp + fn else float(formula.recall(tp, fp, fn))
    tallies = LAYOUT.pack(
        {
            "tp": tp,
            "fp": fp,
            "fn": fn,
            "images": 1,
            "precision_sum": precision,
            "recall_sum": recall or 0.0,
            "images_with_recall": recall is not None,
        }
    )
    outcomes = Outcomes(prediction_outcomes(hit, ignored), label_outcomes(found, truth.ignored))
    return ImageScore(precision, recall, outcomes, matches, best_iou, best_label, tallies)


def metrics(tallies: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
    """Return precision, recall and F1, micro and macro, from tallies that were added up.

    Micro counts all images' segments together: ``P = TP / (TP + FP)``, ``R = TP / (TP + FN)``,
    ``F1 = 2 TP / (2 TP + FP + FN)``. Macro is as in official-v1: P and R are averaged over the images (R over those
    where it is defined) and F1 = 2PR / (P + R) is taken of the averages.

    Args:
        tallies: float64 ``(..., K)``.

    Returns:
        float64 ``(...)`` by name.

    Example:
        Two images: 1 of 1 prediction right with 2 labels, 1 of 3 right with 1 label.

        >>> counted = {"images": 1, "images_with_recall": 1, "tp": 1}
        >>> one = LAYOUT.pack({**counted, "fp": 0, "fn": 1, "precision_sum": 1, "recall_sum": 1 / 2})
        >>> two = LAYOUT.pack({**counted, "fp": 2, "fn": 0, "precision_sum": 1 / 3, "recall_sum": 1})
        >>> found = metrics(one + two)
        >>> found["fixed_precision"].item(), found["fixed_macro_precision"].round(3).item()
        (0.5, 0.667)
    """
    part = LAYOUT.unpack(np.asarray(tallies, np.float64))
    counts = part["tp"], part["fp"], part["fn"]
    precision = formula.quotient(part["precision_sum"], part["images"])
    recall = formula.quotient(part["recall_sum"], part["images_with_recall"], empty=0.0)
    return {
        "fixed_precision": formula.precision(*counts),
        "fixed_recall": formula.recall(*counts),
        "fixed_f1": formula.f1(*counts),
        "fixed_macro_precision": precision,
        "fixed_macro_recall": recall,
        "fixed_macro_f1": formula.harmonic_mean(precision, recall),
    }


def _overlaps(
    labels: Segments, predictions: Segments
) -> tuple[NDArray[np.float64], NDArray[np.int64], tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]]:
    """Return the best IoU of each prediction and its label, and all pairs that reach the threshold."""
    best_iou = np.zeros(len(predictions))
    best_label = np.full(len(predictions), -1, np.int64)
    rows, columns, values = [np.zeros(0, np.int64)], [np.zeros(0, np.int64)], [np.zeros(0)]
    if len(labels):
        for block, iou in iou_blocks(padded_boxes(predictions), padded_boxes(labels)):
            best = iou.argmax(axis=1)
            best_iou[block] = iou[np.arange(len(best)), best]
            best_label[block] = np.where(best_iou[block] > 0, best, -1)
            row, column = np.nonzero(iou >= IOU_THRESHOLD)
            rows.append(row + block.start)
            columns.append(column)
            values.append(iou[row, column])
    return best_iou, best_label, (np.concatenate(rows), np.concatenate(columns), np.concatenate(values))
