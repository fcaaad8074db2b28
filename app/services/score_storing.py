"""Scores go into the database: image by image as they come, then their totals. Storing again changes nothing."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import datetime
from typing import Any

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import ImageScore, Score, Submission
from app.evaluation.submission_scoring import ImageRecord
from app.services.submission_states import finish


def store_images(session: Session, score_id: int, records: Mapping[int, ImageRecord], now: datetime) -> None:
    """Store the records of some images.

    Args:
        session: A writing session.
        score_id: Of the score; when it is gone, or made already, nothing is stored.
        records: By split image.
        now: When.
    """
    score = session.get(Score, score_id, with_for_update=True)
    if score is None or score.status not in ("queued", "running"):
        return
    stored = set(session.scalars(select(ImageScore.split_image_id).where(ImageScore.score_id == score_id)))
    session.add_all(_row(score_id, image, record) for image, record in records.items() if image not in stored)
    submission = session.get(Submission, score.submission_id, with_for_update=True)
    if submission is not None and submission.status == "scoring":
        submission.heartbeat_at = now


def store_totals(session: Session, score_id: int, totals: dict[str, Any], now: datetime) -> None:
    """Store the totals of a score and bring its submission to its next state.

    Args:
        session: A writing session.
        score_id: Of the score; when it is gone, or made already, nothing is stored.
        totals: As ``score_totals`` returns them.
        now: When.
    """
    score = session.get(Score, score_id, with_for_update=True)
    if score is None or score.status not in ("queued", "running"):
        return
    key = totals["protocols"][score.protocol]["totals"]["f1"]
    score.f1, score.f1_low, score.f1_high = key["value"], key["low"], key["high"]
    score.totals = totals
    score.status = "done"
    score.done_at = now
    score.milliseconds = (now - score.created_at).total_seconds() * 1000
    session.flush()
    submission = session.get(Submission, score.submission_id, with_for_update=True)
    if submission is not None:
        finish(session, submission, now)


def _row(score_id: int, image: int, record: ImageRecord) -> ImageScore:
    metrics = record.metrics()
    return ImageScore(
        score_id=score_id,
        split_image_id=image,
        f1=metrics["f1"],
        precision=metrics["precision"],
        recall=metrics["recall"],
        tp=int(metrics["tp"] or 0),
        fp=int(metrics["fp"] or 0),
        fn=int(metrics["fn"] or 0),
        metrics=metrics,
        record=record.as_npz(),
    )
