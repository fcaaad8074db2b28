"""The work of submissions as rows: which waits, and which the dispatcher takes next.

Which images of a score are done is told by the rows of ``image_scores``. Which are being worked on, only the dispatcher
knows: when it dies they are simply not done.
"""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime

from sqlalchemy import ColumnElement, Select, func, select
from sqlalchemy.orm import Session

from app.db.models import ImageScore, Score, Split, SplitImage, SplitVersion, Submission
from app.services.scoring_claims import InHand, PartClaim, ScoringClaim, TotalsClaim, ValidationClaim
from app.services.submission_log import add_to_log
from app.services.submission_states import SubmissionClaim, open_score

PART_IMAGES = 4
"""Images that one task scores: few enough for progress that moves, enough to be worth sending."""
WAITING = ("received", "queued", "scoring")
IN_TURN = (func.coalesce(Submission.queued_at, Submission.created_at), Submission.id)
"""First come, first served; what is scored anew queues up anew."""


def has_scoring_work(session: Session) -> bool:
    """Whether any submission waits, or is worked on."""
    states = (*WAITING, "validating")
    return session.scalar(_alive(Submission.status.in_(states)).limit(1)) is not None


def claim_scoring(session: Session, limit: int, in_hand: InHand, now: datetime) -> list[ScoringClaim]:
    """Take up to ``limit`` pieces of work, oldest submission first; the submissions are at work from here on.

    Args:
        session: A writing session.
        limit: Pieces to take.
        in_hand: What isn't to be taken again.
        now: When.
    """
    claims: list[ScoringClaim] = []
    waiting = _alive(Submission.status.in_(WAITING)).order_by(*IN_TURN).limit(limit + len(in_hand.images) + 1)
    for submission_id in session.scalars(waiting).all():
        if len(claims) >= limit:
            break
        submission = session.get_one(Submission, submission_id, with_for_update=True, populate_existing=True)
        if submission.status == "received":
            claims.append(_validation(submission, now))
        elif submission.status in ("queued", "scoring"):
            claims += _scoring(session, submission, limit - len(claims), in_hand, now)
    return claims


def _alive(*conditions: ColumnElement[bool]) -> Select[int]:
    return (
        select(Submission.id)
        .join(SplitVersion, SplitVersion.id == Submission.split_version_id)
        .join(Split, Split.id == SplitVersion.split_id)
        .where(Split.deleted_at.is_(None), *conditions)
    )


def _validation(submission: Submission, now: datetime) -> ValidationClaim:
    submission.status = "validating"
    submission.attempts += 1
    submission.heartbeat_at = now
    return ValidationClaim(
        SubmissionClaim(submission.id, submission.attempts),
        submission.upload_sha256 or "",
        submission.upload_name or "",
        submission.split_version_id,
    )


def _scoring(
    session: Session, submission: Submission, limit: int, in_hand: InHand, now: datetime
) -> Sequence[ScoringClaim]:
    score = open_score(session, submission.id)
    if score is None:
        return []
    version = session.get_one(SplitVersion, score.split_version_id)
    split = session.get_one(Split, version.split_id)
    left = _images_left(session, score)
    if submission.status == "queued":
        submission.status = "scoring"
        submission.attempts += 1
        score.status = "running"
        add_to_log(submission, f"scoring began, attempt {submission.attempts}", now)
    submission.heartbeat_at = now
    claim = SubmissionClaim(submission.id, submission.attempts)
    segments = submission.segments_sha256 or ""
    if not left:
        if score.id in in_hand.totals:
            return []
        return [TotalsClaim(claim, score.id, segments, version.truth_sha256, split.min_length)]
    mine = {image for owner, image in in_hand.images if owner == score.id}
    free = [image for image in left if image not in mine]
    return [
        PartClaim(
            claim,
            score.id,
            tuple(free[start : start + PART_IMAGES]),
            version.truth_sha256,
            segments,
            split.min_length,
        )
        for start in range(0, len(free), PART_IMAGES)
    ][:limit]


def _images_left(session: Session, score: Score) -> Sequence[int]:
    done = select(ImageScore.split_image_id).where(ImageScore.score_id == score.id)
    return session.scalars(
        select(SplitImage.id)
        .where(SplitImage.version_id == score.split_version_id, SplitImage.id.not_in(done))
        .order_by(SplitImage.ordinal)
    ).all()
