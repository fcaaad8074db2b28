"""The work of submissions as rows: validations, parts of images, totals; claimed, kept alive, put back.

Which images of a score are done is told by the rows of ``image_scores``. Which are being worked on, only the dispatcher
knows: when it dies they are simply not done.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from datetime import datetime

from sqlalchemy import ColumnElement, Select, func, or_, select, update
from sqlalchemy.orm import Session

from app.db.models import ImageScore, Score, Split, SplitImage, SplitVersion, Submission
from app.errors import ClearLinesError
from app.formats.submission_files import ExpectedImage
from app.services.submission_log import add_to_log
from app.services.submission_states import SubmissionClaim, fail_or_retry, open_score

PART_IMAGES = 4
"""Images that one task scores: few enough for progress that moves, enough to be worth sending."""
WAITING = ("received", "queued", "scoring")
IN_TURN = (func.coalesce(Submission.queued_at, Submission.created_at), Submission.id)
"""First come, first served; what is scored anew queues up anew."""


@dataclass(frozen=True)
class ValidationClaim:
    """An upload to be validated."""

    claim: SubmissionClaim
    upload_sha256: str
    upload_name: str
    split_version_id: int


@dataclass(frozen=True)
class PartClaim:
    """Some images of a submission to be scored.

    Attributes:
        images: Ids of split images, in the split's order.
        truth_sha256: Blob of the truth.
        segments_sha256: Blob of the submission's segments.
        min_length: Of the split, px.
    """

    claim: SubmissionClaim
    score_id: int
    images: tuple[int, ...]
    truth_sha256: str
    segments_sha256: str
    min_length: float


@dataclass(frozen=True)
class TotalsClaim:
    """A submission whose images are all scored, to be added up."""

    claim: SubmissionClaim
    score_id: int
    segments_sha256: str
    truth_sha256: str
    min_length: float


ScoringClaim = ValidationClaim | PartClaim | TotalsClaim


@dataclass(frozen=True)
class InHand:
    """What the dispatcher works on already.

    Attributes:
        images: Pairs of score and split image.
        totals: Scores that are being added up.
    """

    images: Collection[tuple[int, int]] = ()
    totals: Collection[int] = ()


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


def release_lost_submissions(
    session: Session, max_attempts: int, now: datetime, *, silent_since: datetime | None = None
) -> int:
    """Queue the work again that a dispatcher left behind when it died.

    Args:
        session: A writing session.
        max_attempts: What was lost so often is given up: it may be what kills the server.
        now: When.
        silent_since: Only work without a heartbeat since then; all of it when left out.

    Returns:
        How many submissions were taken back.
    """
    query = select(Submission).where(Submission.status.in_(("validating", "scoring")))
    if silent_since is not None:
        query = query.where(or_(Submission.heartbeat_at.is_(None), Submission.heartbeat_at < silent_since))
    rows = session.scalars(query.with_for_update(skip_locked=True)).all()
    for row in rows:
        error = lost_work_error(row.attempts)
        if row.status == "scoring":
            fail_or_retry(session, SubmissionClaim(row.id, row.attempts), error, now, max_attempts=max_attempts)
        elif row.attempts < max_attempts:
            row.status = "received"
        else:
            row.status, row.error = "invalid", error
            add_to_log(row, f"invalid: {error['message']}", now)
        row.heartbeat_at = None
    return len(rows)


def beat_submissions(session: Session, submission_ids: Collection[int], now: datetime) -> None:
    """Say that this work is alive."""
    session.execute(
        update(Submission)
        .where(Submission.id.in_(submission_ids), Submission.status.in_(("validating", "scoring")))
        .values(heartbeat_at=now)
        .execution_options(synchronize_session=False)
    )


def put_submission_back(session: Session, claim: SubmissionClaim) -> None:
    """Queue a submission again that was stopped on purpose; the attempt isn't counted."""
    submission = session.get(Submission, claim.submission_id, with_for_update=True)
    if submission is None or submission.attempts != claim.attempts:
        return
    before = {"validating": "received", "scoring": "queued"}.get(submission.status)
    if before is not None:
        submission.status = before
        submission.attempts -= 1
        submission.heartbeat_at = None


def charge_submission(session: Session, claim: SubmissionClaim, now: datetime) -> SubmissionClaim | None:
    """Count a new attempt of work that killed its worker; ``None`` when nobody wants it any more."""
    submission = session.get(Submission, claim.submission_id, with_for_update=True)
    at_work = submission is not None and submission.status in ("validating", "scoring")
    if submission is None or not at_work or submission.attempts != claim.attempts:
        return None
    add_to_log(submission, f"attempt {submission.attempts} failed: the process that worked on it was killed", now)
    submission.attempts += 1
    submission.heartbeat_at = now
    return SubmissionClaim(submission.id, submission.attempts)


def lost_work_error(attempts: int) -> dict[str, str]:
    """Return the reason of a submission whose work ended with the process that did it."""
    times = "time" if attempts == 1 else "times"
    return ClearLinesError(
        f"the process that worked on it was killed, {attempts} {times}",
        hint="most often memory ran out: are there far more segments than lines?",
    ).as_dict() | {"code": "worker-died"}


def expected_images(session: Session, version_id: int) -> list[ExpectedImage]:
    """Return names and sizes of the images of a split version, in its order."""
    rows = session.execute(
        select(SplitImage.name, SplitImage.width, SplitImage.height)
        .where(SplitImage.version_id == version_id)
        .order_by(SplitImage.ordinal)
    )
    return [ExpectedImage(row.name, row.width, row.height) for row in rows]


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
