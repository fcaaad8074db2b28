"""Submissions are taken in: an upload becomes a row, within the day's limit; one that turns out invalid goes again."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any

from sqlalchemy import and_, exists, func, select
from sqlalchemy.orm import Session

from app.db.models import Method, Score, Split, SplitVersion, Submission
from app.db.session import Database
from app.errors import ClearLinesError, Conflict, TooMany
from app.formats.submission_limits import SubmissionLimits
from app.formats.submission_problems import InvalidSubmission
from app.services.access import Viewer, can_maintain
from app.services.blob_discarding import discard_blob
from app.services.blobs import add_blob_row
from app.services.events import record_event
from app.services.methods import MethodGiven, find_or_add_method
from app.services.splits import current_version, get_split, is_closed
from app.services.submission_intake import one_upload
from app.services.submission_log import add_to_log
from app.services.submissions import checked_label, checked_visibility
from app.services.uploads import UploadedFile
from app.services.webhook_sending import check_webhook_url
from app.storage import BlobStore

DAY = timedelta(days=1)
UPLOAD_TYPE = "application/octet-stream"


@dataclass(frozen=True)
class SubmissionGiven:
    """What an author says of a submission.

    Attributes:
        method: The method, found by its name or made.
        label: The author's word for this version of it.
        visibility: ``public`` or ``private``.
        webhook_url: Is told when the submission is scored.
    """

    method: MethodGiven
    label: str | None = None
    visibility: str = "public"
    webhook_url: str | None = None


def receive(
    database: Database,
    blobs: BlobStore,
    viewer: Viewer,
    slug: str,
    files: Sequence[UploadedFile],
    given: SubmissionGiven,
    now: datetime,
    limits: SubmissionLimits,
) -> int:
    """Store an upload and its row; a worker validates it next.

    Returns:
        The submission's id.

    Raises:
        NotFound: When there is no such split.
        Conflict: When the split is closed.
        TooMany: When the day's submissions are used up.
        InvalidInput: Naming the field that can't be.
        InvalidSubmission: When the upload is too large or its files' names can't be.
    """
    _checked(given)
    with database.read() as session:  # whoever may not submit isn't to fill the disk first
        _require_open(session, viewer, get_split(session, slug), now)
    with one_upload(files, limits) as upload:
        sha256 = blobs.put(upload.stream, limit=limits.upload_bytes)
        try:
            with database.write() as session:
                split = get_split(session, slug)
                session.refresh(split, with_for_update=True)  # of two at once the second one counts the first
                _require_open(session, viewer, split, now)
                add_blob_row(session, sha256, upload.size, UPLOAD_TYPE, now)
                submission = Submission(
                    split_version_id=current_version(session, split).id,
                    method_id=find_or_add_method(session, viewer, given.method, now).id,
                    label=checked_label(given.label),
                    person=viewer.name,
                    status="received",
                    visibility=given.visibility,
                    upload_sha256=sha256,
                    upload_name=upload.name,
                    webhook_url=given.webhook_url or None,
                    created_at=now,
                )
                add_to_log(submission, f"received {upload.name}, {upload.size:,} bytes", now)
                session.add(submission)
                session.flush()
                told = {"submission": submission.id, "split": split.slug, "bytes": upload.size}
                dataset_id = split.dataset_id
                record_event(
                    session, "submission.received", now, dataset_id=dataset_id, person=viewer.name, details=told
                )
                return submission.id
        except ClearLinesError:
            with database.write() as session:
                discard_blob(session, blobs, sha256)
            raise


def take_refused(database: Database, blobs: BlobStore, submission_id: int) -> InvalidSubmission | None:
    """Remove a submission that turned out invalid, with its files, and return what is wrong with it.

    Returns:
        ``None`` when it isn't invalid.
    """
    with database.write() as session:
        submission = session.get(Submission, submission_id, with_for_update=True)
        if submission is None or submission.status != "invalid":
            return None
        error = dict(submission.error or {})
        # whoever hands in for the same method at this moment comes before or after, never between
        method = session.get_one(Method, submission.method_id, with_for_update=True)
        upload = submission.upload_sha256
        session.delete(submission)
        session.flush()
        if session.scalar(select(Submission.id).where(Submission.method_id == method.id).limit(1)) is None:
            session.delete(method)
        discard_blob(session, blobs, upload)
    return refused_error(error)


def refused_error(error: dict[str, Any]) -> InvalidSubmission:
    """Return the stored reason of an invalid submission as an error; one without a list of complaints gets one."""
    message = str(error.get("message", "the submission can't be used"))
    told = {name: error.get(name) for name in ("where", "expected", "hint")}
    details = error.get("details") or {}
    if "errors" not in details:
        problem = {"file": told["where"], "segment": None, "point": None, "message": message}
        details = {"errors": [{**problem, "expected": told["expected"], "hint": told["hint"]}], "count": 1}
    return InvalidSubmission(message, **told, details=details)


def used_today(session: Session, split: Split, person: str | None, now: datetime) -> int:
    """Return how many submissions of the last day count for a person; failed and invalid ones don't.

    A withdrawn one counts however far it got, unless it failed before: it can be restored, and is scored then.
    """
    given_up = exists().where(Score.submission_id == Submission.id, Score.status == "failed")
    failed_before = and_(Submission.status == "withdrawn", Submission.scored_at.is_(None), given_up)
    counts = and_(Submission.status.not_in(("failed", "invalid")), ~failed_before)
    mine = Submission.person.is_(None) if person is None else Submission.person == person
    query = (
        select(func.count())
        .select_from(Submission)
        .join(SplitVersion, SplitVersion.id == Submission.split_version_id)
        .where(SplitVersion.split_id == split.id, mine, Submission.created_at > now - DAY, counts)
    )
    return session.scalar(query) or 0


def _require_open(session: Session, viewer: Viewer, split: Split, now: datetime) -> None:
    if can_maintain(viewer):
        return
    if is_closed(split, now):
        raise Conflict(f"{split.name} takes no more submissions", hint="its deadline is over")
    if used_today(session, split, viewer.name, now) >= split.daily_limit:
        times = "submission" if split.daily_limit == 1 else "submissions"
        raise TooMany(
            f"{split.daily_limit} {times} of a day are used up",
            where=split.slug,
            hint="those that failed don't count; POST .../validate checks files at any time",
        )


def _checked(given: SubmissionGiven) -> None:
    checked_visibility(given.visibility)
    checked_label(given.label)
    if given.webhook_url:
        check_webhook_url(given.webhook_url)
