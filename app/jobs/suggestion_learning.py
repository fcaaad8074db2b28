"""What a worker does to learn from decisions: arrays in, a model and how good it is out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.jobs.tasks import errors_that_travel
from app.review.calibration import CalibrationReport
from app.review.feature_weights import feature_weights
from app.review.learning_curve import PRIOR_THRESHOLDS, gains, learning_curve, recommended_thresholds
from app.review.prior import prior_model
from app.review.training import TrainingSet, train

SEED = 0
WANTED_ERROR = 0.05
"""Share of what is accepted at the recommended thresholds that is expected to be wrong."""


@dataclass(frozen=True)
class Trained:
    """A model of a dataset's decisions.

    Attributes:
        version: Of its features.
        parameters: ``SuggestionModel.as_dict``.
        report: ``thresholds``, ``calibration``, ``gain`` and ``weights``: how good it is on images that it hadn't seen.
    """

    version: str
    parameters: dict[str, Any]
    report: dict[str, Any]


def train_task(features: NDArray[np.float32], kept: NDArray[np.bool_], image_index: NDArray[np.int64]) -> Trained:
    """Learn from decisions.

    Args:
        features: float32 ``(N, F)``.
        kept: bool ``(N,)``, whether a person kept the candidate.
        image_index: int64 ``(N,)``, from 0 for the image that was finished first.

    Raises:
        ClearLinesError: Always one of the tree, with the reason.
    """
    with errors_that_travel("suggestions", "learning from decisions"):
        examples = TrainingSet(features, kept, image_index)
        prior = prior_model()
        trained = train(examples, seed=SEED, prior=prior)
        curve = learning_curve(examples, seed=SEED, prior=prior)
        thresholds = recommended_thresholds(curve, WANTED_ERROR, PRIOR_THRESHOLDS)
        report = {
            "thresholds": thresholds._asdict(),
            "calibration": None if trained.report is None else _calibration(trained.report),
            "gain": [entry._asdict() for entry in gains(curve, examples, thresholds)],
            "weights": [entry._asdict() for entry in feature_weights(trained.model, examples.features)],
        }
        return Trained(trained.model.version, trained.model.as_dict(), report)


def _calibration(report: CalibrationReport) -> dict[str, Any]:
    """Return a report with the 95 % interval of each bin's share (Wilson, JASA 1927)."""
    from scipy.stats import binomtest  # takes long, and the server needs but the name of the task

    bins = []
    for each in report.bins:
        kept = round((each.observed or 0.0) * each.count)
        interval = binomtest(kept, each.count).proportion_ci(method="wilson") if each.count else None
        low, high = (None, None) if interval is None else (float(interval.low), float(interval.high))
        bins.append({**each._asdict(), "observed_low": low, "observed_high": high})
    return {**report._asdict(), "bins": bins}
