"""Attempts at the work of submissions: kept alive, given up when it kills whoever does it, put back when stopped."""

from __future__ import annotations

from collections.abc import Collection
from datetime import datetime

from sqlalchemy import or_, select, update
from sqlalchemy.orm import Session

from app.db.models import Submission
from app.errors import ClearLinesError
from app.services.submission_log import add_to_log
from app.services.submission_states import SubmissionClaim, fail_or_retry


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
