"""How much of labels and predictions is covered, and in how many pieces: M4 and M5 of clearlines-v2."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.evaluation.covering import SLACK, TAU, Cover
from app.evaluation.line_iou import Overlaps
from app.evaluation.resampling import Samples, sums

LYING_SHARE = 0.5
"""Share of a segment that must run along another one for it to lie on it."""


@dataclass(frozen=True, eq=False)
class Extent:
    """How far P predictions and L labels cover one another, all of the other side together.

    Attributes:
        prediction_covered: float64 ``(P,)``, length of each prediction that counting labels cover, px.
        prediction_counted: float64 ``(P,)``, length of each prediction without what ignored labels alone cover, px.
        label_covered: float64 ``(L,)``, length of each label that counting predictions cover, px.
        pieces: int64 ``(L,)``, counting predictions that lie on each label.
        detected: bool ``(L,)``, whether those cover half of the label or more together.
        merged: int64 ``(P,)``, counting labels that each prediction covers by half or more.
    """

    prediction_covered: NDArray[np.float64]
    prediction_counted: NDArray[np.float64]
    label_covered: NDArray[np.float64]
    pieces: NDArray[np.int64]
    detected: NDArray[np.bool_]
    merged: NDArray[np.int64]


def measure_extent(
    predictions: Samples,
    labels: Samples,
    covers: tuple[Cover, Cover],
    overlaps: Overlaps,
    counting: tuple[NDArray[np.bool_], NDArray[np.bool_]],
) -> Extent:
    """Measure how far predictions and labels cover one another.

    Args:
        predictions: P polylines.
        labels: L polylines.
        covers: What covers the samples of predictions, and those of labels; entries beyond tau are left out.
        overlaps: Of all pairs, at tau.
        counting: Which predictions ``(P,)`` and which labels ``(L,)`` count.
    """
    counts, counts_label = counting
    of_predictions, of_labels = (cover.select(cover.within(TAU)) for cover in covers)

    by_counting = counts_label[labels.polyline[of_predictions.nearest]]
    covered = _marked(predictions, of_predictions.sample[by_counting])
    touched = _marked(predictions, of_predictions.sample)

    by_prediction = predictions.polyline[of_labels.nearest]
    label_covered = _marked(labels, of_labels.sample[counts[by_prediction]])

    lying = _reach(overlaps.row_length, predictions.lengths[overlaps.row]) & counts[overlaps.row]
    spanned = _reach(overlaps.column_length, labels.lengths[overlaps.column]) & counts_label[overlaps.column]
    lying_pairs = overlaps.row[lying] * len(labels) + overlaps.column[lying]
    from_lying = np.isin(by_prediction * len(labels) + labels.polyline[of_labels.sample], lying_pairs)
    covered_by_lying = _length(labels, _marked(labels, of_labels.sample[from_lying]))
    return Extent(
        prediction_covered=_length(predictions, covered),
        prediction_counted=_length(predictions, covered | ~touched),
        label_covered=_length(labels, label_covered),
        pieces=np.bincount(overlaps.column[lying], minlength=len(labels)),
        detected=_reach(covered_by_lying, labels.lengths),
        merged=np.bincount(overlaps.row[spanned], minlength=len(predictions)),
    )


def _reach(length: NDArray[np.float64], whole: NDArray[np.float64]) -> NDArray[np.bool_]:
    return (length >= (LYING_SHARE - SLACK) * whole) & (whole > 0)


def _marked(samples: Samples, which: NDArray[np.int64]) -> NDArray[np.bool_]:
    marked = np.zeros(len(samples.points), bool)
    marked[which] = True
    return marked


def _length(samples: Samples, marked: NDArray[np.bool_]) -> NDArray[np.float64]:
    return sums(samples.polyline[marked], samples.weights[marked], len(samples))
