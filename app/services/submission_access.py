"""Which submissions a viewer sees, and how much of each."""

from __future__ import annotations

from sqlalchemy import ColumnElement, and_, or_, select
from sqlalchemy.orm import Session, contains_eager

from app.db.models import Method, Split, SplitVersion, Submission
from app.errors import Forbidden, NotFound
from app.services.access import Viewer, can_maintain, can_see_details, owns


def visible_submissions(viewer: Viewer) -> ColumnElement[bool]:
    """Return the condition that a submission is shown to the viewer at all.

    A maintainer sees all; everyone sees their own, in whatever state; others see what is public and scored.
    """
    if can_maintain(viewer):
        return Submission.id.is_not(None)
    shown = and_(Submission.visibility == "public", Submission.status == "scored")
    return shown if viewer.name is None else or_(shown, Submission.person == viewer.name)


def get_submission(session: Session, viewer: Viewer, submission_id: int, *, lock: bool = False) -> Submission:
    """Return a submission that the viewer may see, with its split version, split and method loaded.

    Args:
        session: Any session.
        viewer: Who asks.
        submission_id: Its id.
        lock: Whether to hold its row; needs a writing session.

    Raises:
        NotFound: When there is none, or it isn't shown to the viewer.
    """
    query = (
        select(Submission)
        .join(Submission.split_version)
        .join(SplitVersion.split)
        .join(Submission.method)
        .options(
            contains_eager(Submission.split_version).contains_eager(SplitVersion.split),
            contains_eager(Submission.method),
        )
        .where(Submission.id == submission_id, Split.deleted_at.is_(None), visible_submissions(viewer))
    )
    found = session.scalars(query.with_for_update(of=Submission) if lock else query).one_or_none()
    if found is None:
        raise NotFound(f"there is no submission {submission_id}")
    return found


def get_detailed(session: Session, viewer: Viewer, submission_id: int) -> Submission:
    """Return a submission whose details the viewer may see: errors as ``get_submission``."""
    submission = get_submission(session, viewer, submission_id)
    if not can_see_details(viewer, submission.split_version.split.visibility):
        raise NotFound("there is nothing at this address", hint="a hidden split shows totals alone")
    return submission


def require_author(viewer: Viewer, person: str | None) -> None:
    """Refuse changes by anyone but the author and maintainers.

    Raises:
        Forbidden: For others.
    """
    if not is_mine(viewer, person) and not can_maintain(viewer):
        raise Forbidden("this belongs to someone else", expected="its author, or a maintainer")


def is_mine(viewer: Viewer, person: str | None) -> bool:
    """Whether what is stored under that name is the viewer's own."""
    return owns(viewer, person)


def shown_person(viewer: Viewer, method: Method, person: str | None) -> str | None:
    """Return whose a submission or method is, unless the method is anonymous and the viewer someone else."""
    hidden = method.anonymous and not is_mine(viewer, person) and not can_maintain(viewer)
    return None if hidden else person
