"""Submissions, once they are there: withdrawn and restored, changed, scored anew."""

from __future__ import annotations

import contextlib
from datetime import datetime
from typing import Any

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import SUBMISSION_VISIBILITIES, Score, SplitVersion, Submission
from app.errors import Conflict, Forbidden, InvalidInput
from app.services.access import Viewer, can_maintain
from app.services.events import record_event
from app.services.splits import UNCHANGED, Unchanged, get_split, get_version
from app.services.submission_access import get_submission, require_author
from app.services.submission_log import add_to_log
from app.services.submission_states import add_score, open_score

LABEL_LENGTH = 200


def withdraw(session: Session, viewer: Viewer, submission_id: int, now: datetime) -> Submission:
    """Take a submission off the board; its scores stay, and it can come back.

    Raises:
        NotFound: When there is no such submission.
        Forbidden: For others than its author and maintainers.
        Conflict: When it is withdrawn already, or never got so far.
    """
    submission = get_submission(session, viewer, submission_id, lock=True)
    require_author(viewer, submission.person)
    if submission.status in ("withdrawn", "invalid"):
        raise Conflict(f"the submission is {submission.status} already")
    submission.status, submission.withdrawn_at, submission.heartbeat_at = "withdrawn", now, None
    add_to_log(submission, "withdrawn", now)
    _record(session, "submission.withdrawn", submission, viewer, now)
    return submission


def restore(session: Session, viewer: Viewer, submission_id: int, now: datetime) -> Submission:
    """Bring a withdrawn submission back to where it was.

    Raises:
        NotFound: When there is no such submission.
        Forbidden: For others than its author and maintainers.
        Conflict: When it isn't withdrawn.
    """
    submission = get_submission(session, viewer, submission_id, lock=True)
    require_author(viewer, submission.person)
    if submission.status != "withdrawn":
        raise Conflict("the submission isn't withdrawn")
    submission.withdrawn_at = None
    submission.attempts = 0
    if submission.segments_sha256 is None:
        submission.status = "received"
    elif open_score(session, submission.id) is not None:
        submission.status = "queued"
    else:
        done = select(Score.id).where(Score.submission_id == submission.id, Score.status == "done").limit(1)
        submission.status = "failed" if session.scalar(done) is None else "scored"
    if submission.status == "scored":  # its last work may have been done while it was withdrawn
        submission.scored_at = submission.scored_at or now
    add_to_log(submission, "restored", now)
    _record(session, "submission.restored", submission, viewer, now)
    return submission


def rescore(
    session: Session, viewer: Viewer, submission_id: int, split_version: int | None, now: datetime
) -> Submission:
    """Score a submission anew: under the current version of the protocol, or a split version. Old numbers stay.

    Args:
        session: A writing session.
        viewer: Who asks.
        submission_id: Which one.
        split_version: Number of the version; the newest when left out. Images that the submission has no file for count
            as empty.
        now: When.

    Raises:
        NotFound: When there is no such submission or version.
        Forbidden: For others than maintainers.
        Conflict: When this very score is there already, or the submission can't be scored now.
    """
    submission = get_submission(session, viewer, submission_id, lock=True)
    if not can_maintain(viewer):
        raise Forbidden("only a maintainer may have it scored anew", expected="the role maintainer")
    if submission.status not in ("scored", "failed"):
        raise Conflict(f"the submission is {submission.status}", expected="one that is scored or failed")
    version = get_version(session, submission.split_version.split, split_version)
    score = add_score(session, submission, version, now)
    if score.status == "done":
        message = "the submission has this score already"
        raise Conflict(message, hint="there is a new one under another version of the protocol or the split")
    score.status = "queued"
    submission.status, submission.attempts, submission.queued_at, submission.error = "queued", 0, now, None
    add_to_log(submission, f"queued to be scored on version {version.number}", now)
    _record(session, "submission.rescored", submission, viewer, now, version=version.number)
    return submission


def rescore_all(session: Session, viewer: Viewer, slug: str, split_version: int | None, now: datetime) -> int:
    """Score all scored submissions of a split anew, as `rescore`, but for those that have the very score already.

    Args:
        session: A writing session.
        viewer: Who asks.
        slug: Of the split.
        split_version: Number of the version; the newest when left out.
        now: When.

    Returns:
        Number of submissions that were queued.

    Raises:
        NotFound: When there is no such split or version.
        Forbidden: For others than maintainers.
    """
    split = get_split(session, slug)
    version = get_version(session, split, split_version)
    of_split = (
        select(Submission.id)
        .join(SplitVersion, SplitVersion.id == Submission.split_version_id)
        .where(SplitVersion.split_id == split.id, Submission.status == "scored")
        .order_by(Submission.id)
    )
    queued = 0
    for submission_id in session.scalars(of_split).all():
        with contextlib.suppress(Conflict):
            rescore(session, viewer, submission_id, version.number, now)
            queued += 1
    return queued


def change_submission(
    session: Session,
    viewer: Viewer,
    submission_id: int,
    now: datetime,
    *,
    visibility: str | Unchanged = UNCHANGED,
    label: str | Unchanged | None = UNCHANGED,
) -> Submission:
    """Change who sees a submission, or its label.

    Raises:
        NotFound: When there is no such submission.
        Forbidden: For others than its author and maintainers.
        InvalidInput: Naming the field that can't be.
    """
    submission = get_submission(session, viewer, submission_id, lock=True)
    require_author(viewer, submission.person)
    told: dict[str, Any] = {}
    if visibility is not UNCHANGED:
        submission.visibility = checked_visibility(visibility)
        add_to_log(submission, f"made {visibility}", now)
        told["visibility"] = submission.visibility
    if label is not UNCHANGED:
        submission.label = told["label"] = checked_label(label)
    _record(session, "submission.changed", submission, viewer, now, **told)
    return submission


def checked_visibility(visibility: str) -> str:
    """Return who sees a submission.

    Raises:
        InvalidInput: When it is neither ``public`` nor ``private``.
    """
    if visibility not in SUBMISSION_VISIBILITIES:
        expected = " or ".join(SUBMISSION_VISIBILITIES)
        raise InvalidInput(f"{visibility!r:.60} is not possible", where="visibility", expected=expected)
    return visibility


def checked_label(label: str | None) -> str | None:
    """Return a label with single spaces; ``None`` for an empty one.

    Raises:
        InvalidInput: When it is too long or has control characters.
    """
    label = " ".join((label or "").split()) or None
    if label is not None and (len(label) > LABEL_LENGTH or not label.isprintable()):
        raise InvalidInput("this can't be a label", where="label", expected=f"at most {LABEL_LENGTH} characters")
    return label


def _record(session: Session, kind: str, submission: Submission, viewer: Viewer, now: datetime, **details: Any) -> None:
    told = {"submission": submission.id, "split": submission.split_version.split.slug, **details}
    dataset_id = submission.split_version.split.dataset_id
    record_event(session, kind, now, dataset_id=dataset_id, person=viewer.name, details=told)
