"""Where the samples of true positives lie beside their labels: offsets and angles, M6 and M7 of clearlines-v2."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.evaluation.covering import TAU, Cover, dot
from app.evaluation.matching import Matches
from app.evaluation.resampling import Samples, sums
from app.evaluation.tallies import OFFSET_BINS


@dataclass(frozen=True, eq=False)
class Localization:
    """How exactly M true positives lie on their labels, over those of their samples that the label covers.

    Attributes:
        sampled: float64 ``(M,)``, length of those samples, px.
        offset_mean: float64 ``(M,)``, mean distance to the label's curve, px.
        offset_p95: float64 ``(M,)``, 95th percentile of it, px.
        bias: float64 ``(M,)``, mean offset along the label's normal that points right and down, px.
        angle: float64 ``(M,)``, size of the mean angle between tangents, rad.
        histogram: float64 ``(H,)``, length of the samples by distance, H equal bins from 0 to tau; of all together.
    """

    sampled: NDArray[np.float64]
    offset_mean: NDArray[np.float64]
    offset_p95: NDArray[np.float64]
    bias: NDArray[np.float64]
    angle: NDArray[np.float64]
    histogram: NDArray[np.float64]


def localize(
    predictions: Samples, labels: Samples, cover: Cover, matches: Matches, width: int = OFFSET_BINS
) -> Localization:
    """Measure how exactly matched predictions lie on their labels.

    Args:
        predictions: P polylines.
        labels: L polylines.
        cover: What covers the samples of predictions; entries beyond tau are left out.
        matches: M pairs of a prediction (row) and a label (column).
        width: Bins of the histogram.
    """
    count = len(matches.row)
    match_of_prediction = np.full(len(predictions), -1, np.int64)
    match_of_prediction[matches.row] = np.arange(count)
    pair = match_of_prediction[predictions.polyline[cover.sample]]
    label_of_match = np.append(matches.column, -1)  # the last one is of the predictions without a match
    chosen = (label_of_match[pair] == labels.polyline[cover.nearest]) & cover.within(TAU)
    cover, pair = cover.select(chosen), pair[chosen]

    weight = predictions.weights[cover.sample]
    sampled = sums(pair, weight, count)

    def mean(values: NDArray[np.float64]) -> NDArray[np.float64]:
        return sums(pair, weight * values, count) / sampled

    tangent = labels.tangents[cover.nearest]
    normal = np.stack([-tangent[:, 1], tangent[:, 0]], axis=1)
    offset = dot(predictions.points[cover.sample] - labels.points[cover.nearest], normal)
    points_left_or_up = sums(pair, weight * normal.sum(axis=1), count) < 0
    bins = np.minimum(cover.distance * (width / TAU), width - 1).astype(np.int64)
    return Localization(
        sampled=sampled,
        offset_mean=mean(cover.distance),
        offset_p95=_percentile_95(pair, cover.distance, count),
        bias=np.where(points_left_or_up, -mean(offset), mean(offset)),
        angle=np.abs(mean(_turn(predictions.tangents[cover.sample], tangent))),
        histogram=sums(bins, weight, width),
    )


def _turn(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the angle from lines along ``b`` to lines along ``a``, which have no direction, in [-pi/2, pi/2]."""
    cosine = dot(a, b)
    sine = b[:, 0] * a[:, 1] - b[:, 1] * a[:, 0]
    return np.arctan2(np.where(cosine < 0, -sine, sine), np.abs(cosine))


def _percentile_95(group: NDArray[np.int64], value: NDArray[np.float64], groups: int) -> NDArray[np.float64]:
    """Return the 95th percentile of each group's values, linear between neighbours as in numpy."""
    order = np.lexsort((value, group))
    counts = np.bincount(group, minlength=groups)
    position = (np.cumsum(counts) - counts) + 0.95 * (counts - 1)
    below = np.floor(position).astype(np.int64)
    above = np.ceil(position).astype(np.int64)
    ranked = value[order]
    return ranked[below] + (position - below) * (ranked[above] - ranked[below])
