"""Edits by hand: segments replaced by others, all or nothing, undone and done again as groups of decisions.

Of the segments that edits name, one is current while the edit that added it stands, if any did, and no edit that stands
replaced it. Nothing is ever deleted: what an edit replaced is retired, and so is what it added once it is undone.
"""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime
from uuid import NAMESPACE_URL, uuid5

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import Decision, Edit, Image, Review, Segment, SegmentState
from app.errors import Conflict, InvalidInput
from app.services.candidates import is_current, refresh_counts
from app.services.decision_batch import Wish
from app.services.edited_points import SHAPES, checked_polylines
from app.services.images import get_image
from app.services.manual_segments import manual_rows
from app.services.stale_edits import stale_edit
from app.services.stale_verdicts import require_fresh
from app.services.stored_edits import EditGiven, StoredEdit, stored_edit, told


def store_edit(session: Session, image_id: int, given: EditGiven, person: str | None, now: datetime) -> StoredEdit:
    """Replace segments by others; sending an edit again changes nothing.

    What a hand draws or shapes is kept; the parts of a cut have the verdict of what was cut.

    Args:
        session: A writing session.
        image_id: The image.
        given: The edit.
        person: Who makes it.
        now: Time of the request.

    Raises:
        NotFound: When there is no such image, or it is deleted.
        InvalidInput: On another number of segments than the kind has, or polylines that make no segment.
        TooLarge: On too many points.
        StaleEdit: When a segment that it replaces isn't current any more.
        StaleVerdict: When someone else decided differently on one of them after ``seen``.
        Conflict: When its client id is known with another content.
    """
    get_image(session, image_id)
    image = session.get_one(Image, image_id, with_for_update=True, populate_existing=True)
    known = stored_edit(session, image_id, given)
    if known is not None:
        return known
    client_id = str(given.client_id)
    decided = select(Decision.id).where(Decision.image_id == image.id, Decision.group_id == client_id)
    if session.scalar(decided.limit(1)) is not None:
        raise Conflict("decisions have this client_id as their group", where="client_id", expected="a new UUID")
    segments = checked_polylines(given.kind, given.adds or (), image)
    verdict = _verdict_of(given.kind, _verdicts_of_current(session, image, given))
    if given.seen is not None:
        wishes = [Wish(client_id, client_id, key, verdict) for key in given.replaces]
        require_fresh(session, image.id, wishes, {}, given.seen, person, where="replaces")
    rows = manual_rows(session, image, segments)
    session.add_all(rows)
    session.flush()
    edit = Edit(
        image_id=image.id,
        person=person,
        kind=given.kind,
        client_id=client_id,
        replaced=list(given.replaces),
        added=[row.id for row in rows],
        created_at=now,
    )
    session.add(edit)
    set_current(session, retired=edit.replaced, current=(), now=now)
    _decide(session, edit, verdict, person, now)
    image.revision += 1
    refresh_counts(session, [image.id])
    _reopen(session, image, verdict, now)
    return told(session, image, edit)


def require_number(kind: str, replaces: Sequence[int]) -> None:
    """Check that an edit replaces as many segments as its kind does, none twice.

    Raises:
        InvalidInput: When it doesn't.
    """
    number = SHAPES[kind][0]
    if len(replaces) != number or len(set(replaces)) != number:
        raise InvalidInput(f"{len(set(replaces))} segments", where="replaces", expected=f"a {kind} replaces {number}")


def set_current(session: Session, *, retired: Sequence[int], current: Sequence[int], now: datetime) -> None:
    """Retire some segments and make others current; those that are gone for good are passed over."""
    for ids, moment in ((retired, now), (current, None)):
        for segment in session.scalars(select(Segment).where(Segment.id.in_(ids))) if ids else ():
            segment.retired_at = moment
    session.flush()


def _verdicts_of_current(session: Session, image: Image, given: EditGiven) -> list[str]:
    """Return the verdicts of the segments that an edit replaces."""
    require_number(given.kind, given.replaces)
    if not given.replaces:
        return []
    rows = session.execute(
        select(Segment.id, is_current(), SegmentState.verdict)
        .outerjoin(SegmentState, SegmentState.segment_id == Segment.id)
        .where(Segment.id.in_(given.replaces), Segment.image_id == image.id)
    ).all()
    foreign = set(given.replaces) - {row[0] for row in rows}
    if foreign:
        raise InvalidInput(
            f"segment {min(foreign)} isn't of image {image.id}", where="replaces", expected="segments of this image"
        )
    stale = sorted(key for key, current, _ in rows if not current)
    if stale:
        raise stale_edit(session, image, stale)
    return [verdict or "undecided" for _, _, verdict in rows]


def _verdict_of(kind: str, replaced: Sequence[str]) -> str:
    if kind == "cut":
        return replaced[0]
    return "ambiguous" if "ambiguous" in replaced else "keep"


def _decide(session: Session, edit: Edit, verdict: str, person: str | None, now: datetime) -> None:
    decisions = [
        Decision(
            image_id=edit.image_id,
            segment_id=key,
            person=person,
            verdict=verdict,
            previous="undecided",
            kind="judge",
            client_id=str(uuid5(NAMESPACE_URL, f"edit/{edit.client_id}/{key}")),
            group_id=edit.client_id,
            created_at=now,
        )
        for key in edit.added
    ]
    session.add_all(decisions)
    session.flush()
    session.add_all(
        SegmentState(segment_id=each.segment_id, verdict=each.verdict, decision_id=each.id) for each in decisions
    )


def _reopen(session: Session, image: Image, verdict: str, now: datetime) -> None:
    review = session.get(Review, image.id)
    if review is not None and review.status == "done" and verdict == "undecided":
        review.status = "open"
        review.updated_at = now
