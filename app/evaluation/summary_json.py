"""The result of an evaluation for programs: ``summary.json``, and one file per image. Numbers are not rounded."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.evaluation import clearlines_v2
from app.evaluation.bootstrap import or_none
from app.evaluation.error_types import ErrorType
from app.evaluation.image_record import ImageRecord
from app.evaluation.official_v1 import ImageScore as OfficialScore
from app.evaluation.official_v1_fixed import ImageScore as FixedScore
from app.evaluation.outcome import Outcome
from app.evaluation.protocols import Score
from app.evaluation.rejected_lines import reason_name
from app.evaluation.summary import Evaluation
from app.evaluation.tallies import THRESHOLD


def summary_content(evaluation: Evaluation) -> dict[str, Any]:
    """Return the content of ``summary.json``."""
    predictions, labels = evaluation.counted("predictions"), evaluation.counted("labels")
    return {
        "protocol": evaluation.protocol,
        "iou_threshold": THRESHOLD,
        "precision": evaluation.precision,
        "recall": evaluation.recall,
        "f1": evaluation.f1,
        "images": len(evaluation.names),
        "counts": {
            "labels": sum(labels.values()) - labels[Outcome.IGNORED],
            "predictions": sum(predictions.values()) - predictions[Outcome.IGNORED],
            "true_positives": predictions[Outcome.HIT],
            "ignored_labels": labels[Outcome.IGNORED],
            "ignored_predictions": predictions[Outcome.IGNORED],
            "images_without_recall": sum(score.recall is None for score in evaluation.scores),
        },
        "min_length": evaluation.min_length,
        "missing": list(evaluation.missing),
        "extra": list(evaluation.extra),
        "consequences": evaluation.consequences(),
        "totals": dict(evaluation.totals),
    }


def image_content(name: str, score: Score, record: ImageRecord) -> dict[str, Any]:
    """Return the content of one file of ``individual_results/``.

    Args:
        name: Name of the image.
        score: Its score under the protocol of the result.
        record: The same image under all protocols; short predictions, which the score leaves out, are in it.
    """
    outcomes = score.outcomes
    fields = _fields(score, record, record.scored_predictions)
    rows = [dict(zip(fields, row, strict=True)) for row in zip(*fields.values(), strict=True)]
    hits = int((outcomes.predictions == Outcome.HIT).sum())
    content = {
        "name": name,
        "protocol": score.protocol,
        "precision": score.precision,
        "recall": score.recall,
        "true_positives": hits,
        "predictions": int((outcomes.predictions != Outcome.IGNORED).sum()),
        "labels": int((outcomes.labels != Outcome.IGNORED).sum()),
        "prediction_outcomes": rows,
        "label_outcomes": _outcomes(outcomes.labels),
        "metrics": record.metrics(),
    }
    if score.protocol == clearlines_v2.PROTOCOL:
        content["label_error_types"] = _error_types(record.label_errors)
    return content


def _fields(score: Score, record: ImageRecord, index: NDArray[np.int64]) -> dict[str, list[Any]]:
    """Return what is said of each prediction, by name."""
    fields: dict[str, list[Any]] = {
        "index": index.tolist(),
        "outcome": _outcomes(score.outcomes.predictions),
    }
    if isinstance(score, OfficialScore | FixedScore):
        return {**fields, "best_iou": score.best_iou.tolist(), "best_label": _labels(score.best_label)}
    return {
        **fields,
        "liou": record.liou[index].tolist(),
        "best_label": _labels(record.best_label[index]),
        "offset": [or_none(value) for value in record.offset[index]],
        "angle": [or_none(value) for value in record.angle[index]],
        "error_type": _error_types(record.prediction_errors[index]),
        "rejected_as": [reason_name(place) for place in record.prediction_reasons[index].tolist()],
    }


def _outcomes(numbers: NDArray[np.int8]) -> list[str]:
    return [Outcome(number).name.lower() for number in numbers.tolist()]


def _error_types(numbers: NDArray[np.int8]) -> list[str | None]:
    return [ErrorType(number).name.lower() if number else None for number in numbers.tolist()]


def _labels(labels: NDArray[np.int64]) -> list[int | None]:
    return [None if label < 0 else label for label in labels.tolist()]
