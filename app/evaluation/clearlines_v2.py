"""Protocol clearlines-v2, the rank key: segments matched one-to-one by line IoU, in the same way for every direction.

1. Every segment is sampled at 1 px of arc length (`app.evaluation.resampling`).
2. Line IoU of all pairs (`app.evaluation.line_iou`), tau = 3 px.
3. One-to-one matching of predictions and labels that count, over pairs with line IoU >= 0.5: as many pairs as possible,
   then the greatest sum (`app.evaluation.matching`).
4. An unmatched prediction whose highest line IoU over all labels is at least 0.5 and belongs to an ignored label is
   ignored itself: neither true nor false positive, and in no other number.

Every number of an image is additive (`app.evaluation.tallies`), average precision aside, which needs the ranking.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from app.errors import TooLarge
from app.evaluation.assignment import rivalry
from app.evaluation.average_precision import Ranked, rank_predictions
from app.evaluation.covering import TAU, mutual_cover
from app.evaluation.extent import Extent, measure_extent
from app.evaluation.ground_truth import GroundTruth
from app.evaluation.line_iou import Overlaps, overlaps_at
from app.evaluation.localization import Localization, localize
from app.evaluation.matching import Matches
from app.evaluation.metrics import precision, recall
from app.evaluation.outcome import Outcome, Outcomes, label_outcomes, prediction_outcomes
from app.evaluation.resampling import Samples, resample
from app.evaluation.tallies import GRID_TAUS, GRID_THRESHOLDS, LAYOUT, THRESHOLD
from app.vision.segments import Segments

PROTOCOL = "clearlines-v2"

MAXIMUM_LENGTH = 1 << 23
"""Arc length that the predictions, or the labels, of one image may have together, px: a sample each is taken of it."""


@dataclass(frozen=True, eq=False)
class ImageScore:
    """Score of one image with P predictions and L labels.

    Attributes:
        outcomes: What became of each prediction and label.
        matches: True positives: prediction (``row``), label (``column``) and their line IoU (``value``).
        best_liou: float64 ``(P,)``, highest line IoU of each prediction over all labels, ignored ones included.
        best_label: int64 ``(P,)``, the first label with it; -1 where it is 0.
        localization: How exactly the true positives lie, in the order of ``matches``.
        overlaps: All pairs of a prediction (``row``) and a label (``column``) that run along one another somewhere.
        extent: How far predictions and labels are covered by the other side as a whole.
        ranked: What average precision is made of; ``None`` where predictions have no scores.
        tallies: float64 ``(K,)``, see `app.evaluation.tallies.LAYOUT`.
    """

    outcomes: Outcomes
    matches: Matches
    best_liou: NDArray[np.float64]
    best_label: NDArray[np.int64]
    localization: Localization
    overlaps: Overlaps
    extent: Extent
    ranked: Ranked | None
    tallies: NDArray[np.float64]
    protocol: str = PROTOCOL

    @property
    def precision(self) -> float:
        """True positives / (true + false positives)."""
        return float(precision(*self._counts()))

    @property
    def recall(self) -> float:
        """True positives / labels that count."""
        return float(recall(*self._counts()))

    def _counts(self) -> tuple[float, float, float]:
        part = LAYOUT.unpack(self.tallies)
        return float(part["tp"]), float(part["fp"]), float(part["fn"])


def score_image(truth: GroundTruth, predictions: Segments) -> ImageScore:
    """Score the predictions of one image.

    Args:
        truth: The L labels of the image.
        predictions: P segments, px; those that are too short to count are left out already
            (`app.evaluation.ground_truth.long_enough`).

    Raises:
        TooLarge: When the labels or the predictions are longer than `MAXIMUM_LENGTH` together.
    """
    _check_length("labels", truth.segments)
    _check_length("predictions", predictions)
    found, labels = resample(predictions), resample(truth.segments)
    covers = mutual_cover(found, labels, max(TAU, *GRID_TAUS))
    overlaps = dict(zip(GRID_TAUS, overlaps_at(found, labels, *covers, GRID_TAUS), strict=True))
    rivalries = {tau: rivalry(pairs, truth.ignored, len(predictions)) for tau, pairs in overlaps.items()}

    decisive = rivalries[TAU]
    matches, excused = decisive.matches(THRESHOLD), decisive.excused(THRESHOLD)
    hit, label_found = np.zeros(len(predictions), bool), np.zeros(len(truth), bool)
    hit[matches.row], label_found[matches.column] = True, True
    outcomes = Outcomes(prediction_outcomes(hit, excused), label_outcomes(label_found, truth.ignored))

    counting = outcomes.predictions != Outcome.IGNORED, ~truth.ignored
    extent = measure_extent(found, labels, covers, overlaps[TAU], counting)
    localization = localize(found, labels, covers[0], matches)
    grid = np.array([[rivalries[tau].counts(threshold) for threshold in GRID_THRESHOLDS] for tau in GRID_TAUS])
    return ImageScore(
        outcomes=outcomes,
        matches=matches,
        best_liou=decisive.best_liou,
        best_label=decisive.best_label,
        localization=localization,
        overlaps=overlaps[TAU],
        extent=extent,
        ranked=rank_predictions(decisive, predictions, labels=int(counting[1].sum()), threshold=THRESHOLD),
        tallies=LAYOUT.pack(
            {
                "tp": len(matches.row),
                "fp": (outcomes.predictions == Outcome.FALSE_ALARM).sum(),
                "fn": (outcomes.labels == Outcome.MISS).sum(),
                "grid_tp": grid[..., 0],
                "grid_fp": grid[..., 1],
                **_lengths(extent, labels, counting),
                **_pieces(extent, matches, counting[1]),
                **_places(localization),
                "liou_sum": matches.value.sum(),
            }
        ),
    )


def _check_length(side: str, segments: Segments) -> None:
    length = float(segments.lengths().sum())
    if not length <= MAXIMUM_LENGTH:
        raise TooLarge(
            f"segments of one image are {length:.3g} px long together",
            where=side,
            expected=f"at most {MAXIMUM_LENGTH} px",
            hint="do segments go back and forth, or beyond the image?",
        )


def _lengths(
    extent: Extent, labels: Samples, counting: tuple[NDArray[np.bool_], NDArray[np.bool_]]
) -> dict[str, ArrayLike]:
    predictions_count, labels_count = counting
    return {
        "labelled": labels.lengths[labels_count].sum(),
        "labelled_covered": extent.label_covered[labels_count].sum(),
        "predicted": extent.prediction_counted[predictions_count].sum(),
        "predicted_covered": extent.prediction_covered[predictions_count].sum(),
    }


def _pieces(extent: Extent, matches: Matches, labels_count: NDArray[np.bool_]) -> dict[str, ArrayLike]:
    detected = extent.detected & labels_count
    return {
        "detected": detected.sum(),
        "predictions_on_detected": extent.pieces[detected].sum(),
        "merging": (extent.merged[matches.row] >= 2).sum(),
    }


def _places(localization: Localization) -> dict[str, ArrayLike]:
    return {
        "sampled": localization.sampled.sum(),
        "offset_sum": (localization.offset_mean * localization.sampled).sum(),
        "offset_histogram": localization.histogram,
        "bias_sum": localization.bias.sum(),
        "angle_sum": localization.angle.sum(),
        "translation_sum": np.abs(localization.bias).sum(),
    }
