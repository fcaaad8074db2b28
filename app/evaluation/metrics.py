"""The metrics of protocol clearlines-v2 as formulas over counts and lengths that were added up over images.

Every function takes arrays of any shape and works element by element, so that one call serves a set of images and the
2000 draws of a bootstrap alike. A quotient without a denominator is NaN, unless the docstring says otherwise.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Numbers = NDArray[np.float64]


def quotient(over: ArrayLike, under: ArrayLike, empty: ArrayLike = np.nan) -> Numbers:
    """Return ``over / under``, and ``empty`` where ``under`` is 0."""
    above, below, otherwise = np.broadcast_arrays(
        np.asarray(over, np.float64), np.asarray(under, np.float64), np.asarray(empty, np.float64)
    )
    return np.divide(above, below, out=otherwise.copy(), where=below != 0)


def f1(tp: ArrayLike, fp: ArrayLike, fn: ArrayLike) -> Numbers:
    """M1, the rank key: ``F1 = 2 TP / (2 TP + FP + FN)``; 1 where there is neither a label nor a prediction.

    Source: van Rijsbergen, "Information Retrieval" (1979), the harmonic mean of precision and recall.

    Example:
        >>> f1(tp=8, fp=2, fn=4).item()  # P = .8, R = .667
        0.7272727272727273
        >>> f1(0, 0, 0).item()
        1.0
    """
    tp = np.asarray(tp, np.float64)
    return quotient(2 * tp, 2 * tp + np.add(fp, fn), empty=1.0)


def precision(tp: ArrayLike, fp: ArrayLike, fn: ArrayLike) -> Numbers:
    """``P = TP / (TP + FP)``; without predictions 0, or 1 where there is no label either.

    Example:
        >>> precision(8, 2, 4).item(), precision(0, 0, 4).item(), precision(0, 0, 0).item()
        (0.8, 0.0, 1.0)
    """
    return quotient(tp, np.add(tp, fp), empty=np.where(np.asarray(fn) == 0, 1.0, 0.0))


def recall(tp: ArrayLike, fp: ArrayLike, fn: ArrayLike) -> Numbers:
    """``R = TP / (TP + FN)``; without labels 0, or 1 where there is no prediction either.

    Example:
        >>> recall(8, 2, 2).item(), recall(0, 2, 0).item(), recall(0, 0, 0).item()
        (0.8, 0.0, 1.0)
    """
    return precision(tp, fn, fp)


def harmonic_mean(a: ArrayLike, b: ArrayLike) -> Numbers:
    """``2ab / (a + b)``: F1 of a precision and a recall that are given as such; 0 where both are.

    Example:
        >>> harmonic_mean(1.0, 0.5).round(3).item()
        0.667
    """
    return quotient(2 * np.multiply(a, b), np.add(a, b), empty=0.0)


def mean_f1(grid: ArrayLike) -> Numbers:
    """M2: the mean of F1 over a grid ``(..., T, t)`` of distances tau and thresholds t.

    The grid is tau in {1, 2, 3, 5} px by t in {.50, .55, ..., .95}. Source: the averaging of COCO (Lin et al., 2014)
    over IoU thresholds.

    Example:
        >>> mean_f1([[1.0, 0.5], [0.5, 0.0]]).item()
        0.5
    """
    return np.asarray(grid, np.float64).mean(axis=(-2, -1))


def completeness(labelled_covered: ArrayLike, labelled: ArrayLike, predicted: ArrayLike) -> Numbers:
    """M4: ``C =`` labelled length that any prediction covers ``/`` labelled length.

    Without a label 0, or 1 where there is no prediction either. Source: Heipke et al., "Evaluation of automatic road
    extraction" (1997); with the condition on direction of Wiedemann (2003).

    Example:
        >>> completeness(labelled_covered=300.0, labelled=400.0, predicted=350.0).item()
        0.75
    """
    return quotient(labelled_covered, labelled, empty=np.where(np.asarray(predicted) == 0, 1.0, 0.0))


def correctness(predicted_covered: ArrayLike, predicted: ArrayLike, labelled: ArrayLike) -> Numbers:
    """M4: ``K =`` predicted length that any label covers ``/`` predicted length.

    Without a prediction 0, or 1 where there is no label either. Source: as `completeness`.

    Example:
        >>> correctness(predicted_covered=300.0, predicted=600.0, labelled=400.0).item()
        0.5
    """
    return completeness(predicted_covered, predicted, labelled)


def quality(complete: ArrayLike, correct: ArrayLike) -> Numbers:
    """M4: ``Q = C K / (C + K - C K)``; 0 where both are.

    Source: Wiedemann, "External evaluation of road networks" (2003).

    Example:
        >>> quality(0.75, 0.5).item()
        0.42857142857142855
    """
    product = np.multiply(complete, correct)
    return quotient(product, np.add(complete, correct) - product, empty=0.0)


def fragmentation(predictions_on_detected: ArrayLike, detected: ArrayLike) -> Numbers:
    """M5: predictions per detected label, at least 1; NaN where no label is detected.

    A prediction lies on a label that covers half of it or more. A label is detected when the predictions that lie on it
    cover half of it or more together, in however many pieces. Source: after the gaps and redundancy of Heipke et al.
    (1997).

    Example:
        >>> fragmentation(predictions_on_detected=5, detected=2).item()  # one label in one piece, one in four
        2.5
    """
    return quotient(predictions_on_detected, detected)


def merge(merging: ArrayLike, tp: ArrayLike) -> Numbers:
    """M5: share of true positives that cover two labels or more, each by half or more; NaN without true positives.

    Example:
        >>> merge(merging=1, tp=4).item()
        0.25
    """
    return quotient(merging, tp)


def redundancy(predicted_covered: ArrayLike, labelled_covered: ArrayLike) -> Numbers:
    """M5: surplus matched length, ``(matched predicted - matched labelled) / matched predicted``.

    0 where each label is found once, 4/5 for five copies, negative where one prediction stands for several labels side
    by side; NaN where nothing is matched. Source: Heipke et al. (1997).

    Example:
        >>> redundancy(predicted_covered=500.0, labelled_covered=100.0).item()
        0.8
    """
    return quotient(np.subtract(predicted_covered, labelled_covered), predicted_covered)


def mean_offset(offset_sum: ArrayLike, sampled: ArrayLike) -> Numbers:
    """M6: mean distance of the samples of true positives from their labels' curves, px, over samples that are covered.

    Source: the localisation measures of Pautrat et al., "DeepLSD" (CVPR 2023). NaN without true positives.

    Example:
        >>> mean_offset(offset_sum=60.0, sampled=200.0).item()
        0.3
    """
    return quotient(offset_sum, sampled)


def offset_quantile(histogram: ArrayLike, share: float, tau: float) -> Numbers:
    """M6: quantile of those distances, px, from their histogram; exact to the width of a bin (0.01 px at tau = 3).

    Source: as `mean_offset`. Within a bin, distances are taken to be spread evenly.

    Args:
        histogram: ``(..., H)``, length of samples in H equal bins from 0 to ``tau`` px.
        share: 0.5 for the median, 0.95 for the 95th percentile.
        tau: Where the last bin ends, px.

    Example:
        >>> offset_quantile([0.0, 4, 0, 0], 0.5, tau=4.0).item()  # all in the bin from 1 to 2 px
        1.5
    """
    counts = np.asarray(histogram, np.float64)
    reached = np.cumsum(counts, axis=-1)
    wanted = share * reached[..., -1:]
    at = np.minimum((reached < wanted).sum(axis=-1, keepdims=True), counts.shape[-1] - 1)
    inside = np.take_along_axis(counts, at, axis=-1)
    before = np.take_along_axis(reached, at, axis=-1) - inside
    position = (at + quotient(wanted - before, inside))[..., 0]
    return position * (tau / counts.shape[-1])


def per_true_positive(total: ArrayLike, tp: ArrayLike) -> Numbers:
    """M6 and M7: mean over true positives of a measure of each: its bias, rotation error, translation error, line IoU.

    - bias (px): its mean signed offset along the label's normal that points right and down, so that a detector whose
      points are all off by (0.1, 0.1) px shows it; it changes sign when the image is turned by 180 degrees.
    - rotation error (rad): the size of its mean signed angle to the label's tangents.
    - translation error (px): the size of its mean signed offset along the label's normals.
    - line IoU with the label it is matched to.

    The last three are the fine-grained metrics that the README of the ClearLines dataset names. NaN without true
    positives.

    Example:
        >>> per_true_positive(total=1.8, tp=2).item()
        0.9
    """
    return quotient(total, tp)
