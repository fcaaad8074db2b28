"""What became of every segment of every image of a submission, as one document to keep."""

from __future__ import annotations

from typing import Any

import numpy as np
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import ImageScore, Score, SplitImage, Submission
from app.evaluation.bootstrap import or_none
from app.evaluation.image_record import ImageRecord
from app.evaluation.outcome import Outcome
from app.services.scored_images import error_name


def matches_of(session: Session, submission: Submission, score: Score) -> dict[str, Any]:
    """Return outcomes, matched labels and error types of all images, for JSON."""
    rows = session.execute(
        select(SplitImage.name, ImageScore.record)
        .join(SplitImage, SplitImage.id == ImageScore.split_image_id)
        .where(ImageScore.score_id == score.id)
        .order_by(SplitImage.ordinal)
    )
    return {
        "submission": submission.id,
        "protocol": score.protocol,
        "protocol_version": score.protocol_version,
        "truth_hash": score.truth_hash,
        "submission_hash": score.submission_hash,
        "images": [{"name": row.name, **_image(ImageRecord.from_npz(row.record))} for row in rows],
    }


def _image(record: ImageRecord) -> dict[str, Any]:
    hits = np.flatnonzero(record.prediction_outcomes == Outcome.HIT).tolist()
    return {
        "matches": [
            {
                "prediction": index,
                "label": int(record.best_label[index]),
                "liou": float(record.liou[index]),
                "offset": or_none(record.offset[index]),
                "angle": or_none(record.angle[index]),
            }
            for index in hits
        ],
        "predictions": _outcomes(record.prediction_outcomes, record.prediction_errors),
        "labels": _outcomes(record.label_outcomes, record.label_errors),
    }


def _outcomes(outcomes: np.ndarray, errors: np.ndarray) -> list[dict[str, str | None]]:
    return [
        {"outcome": Outcome(outcome).name.lower(), "error_type": error_name(error)}
        for outcome, error in zip(outcomes.tolist(), errors.tolist(), strict=True)
    ]
