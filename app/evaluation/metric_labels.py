"""What the metrics are called where people read them, and in which unit."""

from __future__ import annotations

import math
from typing import NamedTuple


class MetricLabel(NamedTuple):
    """Name of a metric for people; values are multiplied by ``factor`` to be in ``unit``."""

    text: str
    unit: str = ""
    factor: float = 1.0


_DEGREES = 180 / math.pi

METRIC_LABELS: dict[str, MetricLabel] = {
    "f1": MetricLabel("F1 (M1, the rank key)"),
    "precision": MetricLabel("precision"),
    "recall": MetricLabel("recall"),
    "mean_f1": MetricLabel("mean F1 over tau and t (M2)"),
    "ap": MetricLabel("average precision (M3)"),
    "completeness": MetricLabel("completeness (M4)"),
    "correctness": MetricLabel("correctness"),
    "quality": MetricLabel("quality"),
    "fragmentation": MetricLabel("predictions per detected label (M5)"),
    "merge": MetricLabel("merging true positives"),
    "redundancy": MetricLabel("redundancy"),
    "offset_mean": MetricLabel("offset, mean (M6)", "px"),
    "offset_median": MetricLabel("offset, median", "px"),
    "offset_p95": MetricLabel("offset, 95th percentile", "px"),
    "bias": MetricLabel("bias", "px"),
    "angle_error": MetricLabel("rotation error (M7)", "deg", _DEGREES),
    "translation_error": MetricLabel("translation error", "px"),
    "mean_liou": MetricLabel("line IoU of true positives"),
    "calibration_rms": MetricLabel("straightness of the labels (M10)", "px"),
    "calibration_grid": MetricLabel("difference to the reference lens", "px"),
    "fixed_f1": MetricLabel("F1, micro"),
    "fixed_precision": MetricLabel("precision, micro"),
    "fixed_recall": MetricLabel("recall, micro"),
    "fixed_macro_f1": MetricLabel("F1, macro"),
    "fixed_macro_precision": MetricLabel("precision, macro"),
    "fixed_macro_recall": MetricLabel("recall, macro"),
    "official_f1": MetricLabel("F1"),
    "official_precision": MetricLabel("precision"),
    "official_recall": MetricLabel("recall"),
}
"""By key, in the order of a list; counts aren't in it."""
