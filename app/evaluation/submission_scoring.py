"""A submission scored under every protocol at once: parts of its images, then its totals with their uncertainty.

Pure, and made to be cut up: parts can be scored anywhere in any order. What comes back of each image is small and
picklable (`ImageRecord`), and the totals need these records alone.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.errors import InvalidInput, TooLarge
from app.evaluation import clearlines_v2
from app.evaluation.calibration_score import CalibrationScore, score_calibration
from app.evaluation.error_types import ErrorType, error_types
from app.evaluation.image_record import ImageRecord
from app.evaluation.outcome import Outcome
from app.evaluation.protocols import PROTOCOLS, Score
from app.evaluation.rejected_lines import NO_REASON, reason_tallies, reasons_of
from app.evaluation.split_image import ScoredImage, SplitImageInfo
from app.evaluation.strata import stratum_tallies
from app.evaluation.submission_totals import measure_of, score_totals
from app.vision.conversion import OpenCVLens

__all__ = [
    "ImageRecord",
    "ScoredImage",
    "SplitImageInfo",
    "measure_of",
    "score_cameras",
    "score_image",
    "score_part",
    "score_totals",
]


def score_part(images: Sequence[ScoredImage], min_length: float = 0.0) -> list[ImageRecord]:
    """Score images under all protocols.

    Args:
        images: Some of a submission's images.
        min_length: Predictions of less arc length are left out, px. (That labels of less are ignored, the truth says.)

    Returns:
        One record per image, in the order given.

    Raises:
        TooLarge: When the segments of an image are too long together to be sampled.
    """
    return [score_image(image, min_length)[0] for image in images]


def score_image(image: ScoredImage, min_length: float = 0.0) -> tuple[ImageRecord, dict[str, Score]]:
    """Score an image under all protocols.

    Args:
        image: Truth and predictions.
        min_length: As in `score_part`.

    Returns:
        The record, and by protocol the score of those predictions that are long enough.

    Raises:
        TooLarge: When the segments of a side are too long together to be sampled.
    """
    truth, submitted = image.truth, image.predictions
    kept = np.flatnonzero(submitted.lengths() >= min_length)
    predictions = submitted.select(kept)
    try:
        score = clearlines_v2.score_image(truth, predictions)
    except TooLarge as error:
        where = f"{image.info.name}, {error.where}"
        raise TooLarge(error.message, where=where, expected=error.expected, hint=error.hint) from error
    others = (protocol for name, protocol in PROTOCOLS.items() if name != score.protocol)
    scores: dict[str, Score] = {other.name: other.score_image(truth, predictions) for other in others}
    scores[score.protocol] = score

    kinds = error_types(truth, predictions, score)
    matches = score.matches
    best_label, liou = score.best_label.copy(), score.best_liou.copy()
    best_label[matches.row], liou[matches.row] = matches.column, matches.value
    offset, angle = np.full((2, len(predictions)), np.nan)
    offset[matches.row], angle[matches.row] = score.localization.offset_mean, score.localization.angle

    rejected = None if image.rejected is None else image.rejected.of_least(min_length)
    wrong = np.flatnonzero(score.outcomes.predictions == Outcome.FALSE_ALARM)
    reasons = np.full(len(predictions), NO_REASON, np.int8)
    reasons[wrong] = reasons_of(rejected, predictions.select(wrong))

    def of_all(values: NDArray[Any], otherwise: float) -> NDArray[Any]:
        filled = np.full(len(submitted), otherwise, values.dtype)
        filled[kept] = values
        return filled

    record = ImageRecord(
        tallies={name: each.tallies for name, each in scores.items()},
        scored_predictions=kept,
        prediction_outcomes=of_all(score.outcomes.predictions, Outcome.IGNORED),
        label_outcomes=score.outcomes.labels,
        best_label=of_all(best_label, -1),
        liou=of_all(liou, 0.0),
        offset=of_all(offset, np.nan),
        angle=of_all(angle, np.nan),
        prediction_errors=of_all(kinds.predictions, ErrorType.NONE),
        label_errors=kinds.labels,
        strata=stratum_tallies(truth.segments, predictions, score.outcomes, image.info.size),
        ranked=score.ranked,
        prediction_reasons=of_all(reasons, NO_REASON),
        reasons=reason_tallies(rejected, reasons),
    )
    return record, scores


def score_cameras(images: Sequence[ScoredImage]) -> list[CalibrationScore]:
    """Calibrate each camera from the segments submitted for its images (M10).

    Images without camera or size are left out, and so is a reference that isn't OpenCV's model with four or five
    coefficients.

    Args:
        images: All images of a submission.

    Returns:
        One score per camera and image size, by name.
    """
    by_camera: dict[tuple[str, tuple[int, int]], list[ScoredImage]] = {}
    for image in images:
        if image.info.camera and image.info.size:
            by_camera.setdefault((image.info.camera, image.info.size), []).append(image)
    scores = []
    for (camera, size), of_camera in sorted(by_camera.items(), key=lambda item: item[0]):
        reference = next((image.info.reference for image in of_camera if image.info.reference), None)
        truths, predictions = [image.truth for image in of_camera], [image.predictions for image in of_camera]
        lens = _lens(reference)
        scores.append(score_calibration(camera, truths, predictions, size, reference=lens))
    return scores


def _lens(reference: Mapping[str, Any] | None) -> OpenCVLens | None:
    if reference is None:
        return None
    try:
        return OpenCVLens(reference["K"], reference["D"])
    except (InvalidInput, KeyError):
        return None
