"""The additive numbers of protocol clearlines-v2: added up over images, they give every metric of a set.

A bootstrap draw of images is a row of weights, so that ``metrics(weights @ tallies)`` is the metrics of all draws.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from app.evaluation import metrics as formula
from app.evaluation.covering import TAU
from app.evaluation.layout import Layout

THRESHOLD = 0.5
"""Least line IoU of a true positive."""

GRID_TAUS = (1.0, 2.0, 3.0, 5.0)
"""Distances of M2, px."""

GRID_THRESHOLDS = tuple(round(0.5 + 0.05 * step, 2) for step in range(10))
"""Line IoU thresholds of M2."""

OFFSET_BINS = 300
"""Bins of the histogram of offsets from 0 to tau."""

_GRID = (len(GRID_TAUS), len(GRID_THRESHOLDS))

LAYOUT = Layout(
    (
        ("tp", ()),
        ("fp", ()),
        ("fn", ()),
        ("grid_tp", _GRID),
        ("grid_fp", _GRID),
        ("labelled", ()),  # lengths in px, of the labels and predictions that count
        ("labelled_covered", ()),
        ("predicted", ()),
        ("predicted_covered", ()),
        ("detected", ()),
        ("predictions_on_detected", ()),
        ("merging", ()),
        ("sampled", ()),  # length of the samples of true positives that lie along their label, px
        ("offset_sum", ()),
        ("offset_histogram", (OFFSET_BINS,)),
        ("bias_sum", ()),
        ("angle_sum", ()),
        ("translation_sum", ()),
        ("liou_sum", ()),
    )
)
"""What stands where in the tallies of an image, float64 ``(K,)``."""

METRICS = (
    "f1",
    "precision",
    "recall",
    "tp",
    "fp",
    "fn",
    "mean_f1",
    "f1_grid",
    "completeness",
    "correctness",
    "quality",
    "fragmentation",
    "merge",
    "redundancy",
    "offset_mean",
    "offset_median",
    "offset_p95",
    "bias",
    "angle_error",
    "translation_error",
    "mean_liou",
)
"""What `metrics` returns."""


def metrics(tallies: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
    """Return M1, M2, M4, M5, M6 and M7 from tallies that were added up.

    Args:
        tallies: float64 ``(..., K)``: of an image, of a set, or of many draws of a set.

    Returns:
        float64 ``(...)`` by name, NaN where a metric isn't defined; ``f1_grid`` is ``(..., 4, 10)``. Lengths are px,
        ``angle_error`` is rad.
    """
    part = LAYOUT.unpack(np.asarray(tallies, np.float64))
    tp, fp, fn = part["tp"], part["fp"], part["fn"]
    grid_tp = part["grid_tp"]
    grid = formula.f1(grid_tp, part["grid_fp"], (tp + fn)[..., None, None] - grid_tp)
    complete = formula.completeness(part["labelled_covered"], part["labelled"], part["predicted"])
    correct = formula.correctness(part["predicted_covered"], part["predicted"], part["labelled"])
    return {
        "f1": formula.f1(tp, fp, fn),
        "precision": formula.precision(tp, fp, fn),
        "recall": formula.recall(tp, fp, fn),
        "tp": tp,
        "fp": fp,
        "fn": fn,
        "mean_f1": formula.mean_f1(grid),
        "f1_grid": grid,
        "completeness": complete,
        "correctness": correct,
        "quality": formula.quality(complete, correct),
        "fragmentation": formula.fragmentation(part["predictions_on_detected"], part["detected"]),
        "merge": formula.merge(part["merging"], tp),
        "redundancy": formula.redundancy(part["predicted_covered"], part["labelled_covered"]),
        "offset_mean": formula.mean_offset(part["offset_sum"], part["sampled"]),
        "offset_median": formula.offset_quantile(part["offset_histogram"], 0.5, TAU),
        "offset_p95": formula.offset_quantile(part["offset_histogram"], 0.95, TAU),
        "bias": formula.per_true_positive(part["bias_sum"], tp),
        "angle_error": formula.per_true_positive(part["angle_sum"], tp),
        "translation_error": formula.per_true_positive(part["translation_sum"], tp),
        "mean_liou": formula.per_true_positive(part["liou_sum"], tp),
    }
