"""How a submission goes from state to state; the rows are the only truth.

    received -> validating -> queued -> scoring -> scored
                    |                      |
                 invalid                 failed

A withdrawn submission keeps its scores, and comes back as scored or queued. A claim is a submission's id with its
number of attempts: what a worker gave is stored only while the row is still at that attempt.
"""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from typing import Any

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import Score, SplitVersion, Submission
from app.evaluation.protocols import PROTOCOLS, SCORER_VERSION
from app.services.submission_log import add_to_log

RANK_PROTOCOL = PROTOCOLS["clearlines-v2"]
"""What a score row is named after; the tables hold the numbers of the other protocols beside its own."""


@dataclass(frozen=True)
class SubmissionClaim:
    """A submission that a dispatcher works on, at one attempt."""

    submission_id: int
    attempts: int


@dataclass(frozen=True)
class ValidContent:
    """What validation found in an upload.

    Attributes:
        segments_sha256: The canonical form, stored already.
        submission_hash: Of names, points and scores, however the upload was packed.
        images: Images that it has a file for.
        warnings: What is allowed but may not be meant.
    """

    segments_sha256: str
    submission_hash: str
    images: int
    segments: int
    points: int
    has_scores: bool
    missing: tuple[str, ...]
    warnings: tuple[str, ...]


def claimed(session: Session, claim: SubmissionClaim, status: str) -> Submission | None:
    """Return the claim's row, locked, if the claim still holds."""
    submission = session.get(Submission, claim.submission_id, with_for_update=True)
    if submission is None or submission.status != status or submission.attempts != claim.attempts:
        return None
    return submission


def accept(session: Session, claim: SubmissionClaim, content: ValidContent, now: datetime) -> Submission | None:
    """Queue a submission whose upload can be scored; ``None`` when the claim doesn't hold any more."""
    submission = claimed(session, claim, "validating")
    if submission is None:
        return None
    submission.status = "queued"
    submission.attempts = 0
    submission.heartbeat_at = None
    submission.error = None
    submission.segments_sha256 = content.segments_sha256
    submission.submission_hash = content.submission_hash
    submission.n_images = content.images
    submission.n_segments = content.segments
    submission.n_points = content.points
    submission.has_scores = content.has_scores
    submission.missing = list(content.missing)
    submission.queued_at = now
    version = session.get_one(SplitVersion, submission.split_version_id)
    add_score(session, submission, version, now)
    add_to_log(submission, f"valid: {content.segments:,} segments of {content.images:,} images", now)
    for warning in content.warnings:
        add_to_log(submission, warning, now)
    return submission


def refuse(session: Session, claim: SubmissionClaim, error: dict[str, Any], now: datetime) -> Submission | None:
    """Mark a submission as invalid, with every reason; ``None`` when the claim doesn't hold any more."""
    submission = claimed(session, claim, "validating")
    if submission is None:
        return None
    submission.status = "invalid"
    submission.heartbeat_at = None
    submission.error = error
    add_to_log(submission, f"invalid: {error['message']}", now)
    return submission


def add_score(session: Session, submission: Submission, version: SplitVersion, now: datetime) -> Score:
    """Add the row of a score to be made, under the current version of the protocol; the one that is there, if it is."""
    known = session.scalars(
        select(Score).where(
            Score.submission_id == submission.id,
            Score.split_version_id == version.id,
            Score.protocol == RANK_PROTOCOL.name,
            Score.protocol_version == RANK_PROTOCOL.version,
        )
    ).one_or_none()
    if known is not None:
        return known
    score = Score(
        submission_id=submission.id,
        split_version_id=version.id,
        protocol=RANK_PROTOCOL.name,
        protocol_version=RANK_PROTOCOL.version,
        scorer_version=SCORER_VERSION,
        truth_hash=version.truth_hash,
        submission_hash=submission.submission_hash or "",
        status="queued",
        created_at=now,
    )
    session.add(score)
    session.flush()
    return score


def open_score(session: Session, submission_id: int) -> Score | None:
    """Return the score of a submission that is to be made or being made; the oldest, if there are several."""
    return session.scalars(
        select(Score)
        .where(Score.submission_id == submission_id, Score.status.in_(("queued", "running")))
        .order_by(Score.id)
        .limit(1)
    ).one_or_none()


def finish(session: Session, submission: Submission, now: datetime) -> None:
    """Bring a submission whose score was stored to its next state: scored, or the next score."""
    if submission.status == "withdrawn":
        return
    submission.heartbeat_at = None
    if open_score(session, submission.id) is not None:
        submission.status = "queued"
        submission.attempts = 0
        return
    submission.status = "scored"
    submission.scored_at = submission.scored_at or now
    submission.error = None
    add_to_log(submission, "scored", now)


def fail_or_retry(
    session: Session, claim: SubmissionClaim, error: dict[str, Any], now: datetime, *, max_attempts: int
) -> bool:
    """Queue a scoring again that failed, or give it up with its reason after the last attempt.

    Returns:
        Whether it is given up.
    """
    submission = claimed(session, claim, "scoring")
    if submission is None:
        return False
    submission.heartbeat_at = None
    add_to_log(submission, f"attempt {submission.attempts} failed: {error['message']}", now)
    if submission.attempts < max_attempts:
        submission.status = "queued"
        return False
    score = open_score(session, submission.id)
    if score is not None:
        score.status = "failed"
    has_numbers = session.scalar(
        select(Score.id).where(Score.submission_id == submission.id, Score.status == "done").limit(1)
    )
    # a new score of a scored submission that fails takes nothing away
    submission.status = "failed" if has_numbers is None else "scored"
    submission.error = error
    return True
