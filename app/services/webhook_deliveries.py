"""Which webhooks are due, as the rows say, and what came of each."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from typing import Any

from sqlalchemy import select
from sqlalchemy.orm import Session, joinedload

from app.db.models import Score, SplitVersion, Submission
from app.services.submission_log import add_to_log

SENT = "webhook "
"""How the line of the log begins that says what came of it."""
FAILED = f"{SENT}failed: "
"""How that line begins when nobody could be told."""
TOLD = ("scored", "failed")


@dataclass(frozen=True)
class Delivery:
    """A webhook to be sent."""

    submission_id: int
    url: str
    content: dict[str, Any]


def deliveries_due(session: Session, *, since: datetime) -> list[Delivery]:
    """Return the webhooks of submissions that came to an end since then, and whose log has no word of it yet."""
    rows = session.scalars(
        select(Submission)
        .where(Submission.webhook_url.is_not(None), Submission.status.in_(TOLD), Submission.created_at >= since)
        .options(joinedload(Submission.split_version).joinedload(SplitVersion.split), joinedload(Submission.method))
        .order_by(Submission.id)
    ).all()
    return [
        Delivery(row.id, row.webhook_url or "", _content(session, row))
        for row in rows
        if not any(str(line.get("text", "")).startswith(SENT) for line in row.log or ())
    ]


def record_delivery(session: Session, delivery: Delivery, outcome: str, now: datetime) -> None:
    """Write into the submission's log what came of its webhook."""
    submission = session.get(Submission, delivery.submission_id, with_for_update=True)
    if submission is not None:
        add_to_log(submission, outcome or f"{SENT}not sent: the server stopped", now)


def _content(session: Session, submission: Submission) -> dict[str, Any]:
    """Return what is told: what the author may see on any split, rounded as the board rounds it."""
    score = session.scalars(
        select(Score)
        .where(Score.submission_id == submission.id, Score.status == "done")
        .order_by(Score.id.desc())
        .limit(1)
    ).one_or_none()
    split = submission.split_version.split
    return {
        "submission": submission.id,
        "split": split.slug,
        "method": submission.method.slug,
        "label": submission.label,
        "status": submission.status,
        "f1": None if score is None or score.f1 is None else round(score.f1, 3),
        "protocol": None if score is None else score.protocol,
        "protocol_version": None if score is None else score.protocol_version,
    }
