"""Lists of submissions: of a split or a method, newest first, page by page."""

from __future__ import annotations

from sqlalchemy import Select, func, select
from sqlalchemy.orm import Session, contains_eager

from app.db.models import SUBMISSION_STATES, Method, Split, SplitVersion, Submission
from app.errors import InvalidInput
from app.services.access import Viewer
from app.services.paging import Order, Page, checked_limit, page_of
from app.services.submission_access import visible_submissions
from app.services.submission_views import SubmissionView, submission_views

NEWEST = Order("newest", Submission.created_at, Submission.id, descending=True)


def list_submissions(
    session: Session,
    viewer: Viewer,
    split: Split,
    *,
    mine: bool = False,
    status: str | None = None,
    limit: int = 100,
    cursor: str | None = None,
) -> Page[SubmissionView]:
    """Return a split's submissions that the viewer may see, newest first.

    Args:
        session: Any session.
        viewer: Who asks.
        split: The split.
        mine: Only the viewer's own.
        status: Only those in this state.
        limit: Of a page.
        cursor: Of the page before.

    Raises:
        InvalidInput: On a state, limit or cursor that can't be.
    """
    limit = checked_limit(limit)
    query = _visible(viewer).where(SplitVersion.split_id == split.id)
    if mine:
        own = Submission.person.is_(None) if viewer.name is None else Submission.person == viewer.name
        query = query.where(own)
    if status is not None:
        if status not in SUBMISSION_STATES:
            raise InvalidInput(f"{status!r:.60} is no state", where="status", expected=", ".join(SUBMISSION_STATES))
        query = query.where(Submission.status == status)
    total = session.scalar(select(func.count()).select_from(query.with_only_columns(Submission.id).subquery())) or 0
    if cursor:
        query = query.where(NEWEST.after(cursor))
    rows = session.scalars(query.order_by(*NEWEST.clauses()).limit(limit + 1)).all()
    page = page_of(rows, limit, NEWEST, lambda row: (row.created_at, row.id), total)
    return Page(tuple(submission_views(session, viewer, page.items)), page.next_cursor, page.total)


def submissions_of_method(session: Session, viewer: Viewer, method: Method) -> list[SubmissionView]:
    """Return a method's submissions on all splits that the viewer may see, newest first."""
    query = _visible(viewer).where(Submission.method_id == method.id).order_by(*NEWEST.clauses())
    return submission_views(session, viewer, session.scalars(query).all())


def _visible(viewer: Viewer) -> Select[Submission]:
    return (
        select(Submission)
        .join(Submission.split_version)
        .join(SplitVersion.split)
        .join(Submission.method)
        .options(
            contains_eager(Submission.split_version).contains_eager(SplitVersion.split),
            contains_eager(Submission.method),
        )
        .where(Split.deleted_at.is_(None), visible_submissions(viewer))
    )
