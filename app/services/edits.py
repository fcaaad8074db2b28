"""Edits by hand: segments replaced by others, all or nothing, undone and done again as groups of decisions.

Of the segments that edits name, one is current while the edit that added it stands, if any did, and no edit that stands
replaced it. Nothing is ever deleted: what an edit replaced is retired, and so is what it added once it is undone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any
from uuid import NAMESPACE_URL, UUID, uuid5

import numpy as np
from numpy.typing import NDArray
from sqlalchemy import select
from sqlalchemy.orm import Session, undefer

from app.db.models import Decision, Edit, Image, Review, Segment, SegmentState
from app.errors import Conflict, InvalidInput
from app.services.candidates import is_current, refresh_counts
from app.services.carrying import stored_polyline
from app.services.counts import VerdictCounts, verdict_counts
from app.services.edited_points import SHAPES, checked_polylines
from app.services.images import get_image
from app.services.manual_segments import manual_rows
from app.services.stale_edits import stale_edit
from app.services.stale_verdicts import last_decision_id


@dataclass(frozen=True, eq=False)
class EditGiven:
    """An edit as a client asks for it.

    Attributes:
        client_id: Made by the client; the same one again is the same edit. The group that its decisions carry.
        kind: One of `app.db.models.EDIT_KINDS`.
        replaces: Ids of the segments that go.
        adds: float ``(n, 2)`` px of the segments that come.
    """

    client_id: UUID | str
    kind: str
    replaces: tuple[int, ...]
    adds: tuple[NDArray[Any], ...]


@dataclass(frozen=True)
class StoredEdit:
    """An edit, and what is current on its image afterwards."""

    id: int
    image_id: int
    client_id: str
    kind: str
    person: str | None
    replaced: tuple[int, ...]
    added: tuple[int, ...]
    created_at: datetime
    undone_at: datetime | None
    revision: int
    verdicts: VerdictCounts
    status: str
    last_decision_id: int


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
        Conflict: When its client id is known with another content.
    """
    get_image(session, image_id)
    image = session.get_one(Image, image_id, with_for_update=True, populate_existing=True)
    client_id = str(given.client_id)
    known = session.scalar(select(Edit).where(Edit.client_id == client_id))
    if known is not None:
        _require_same(session, image, known, given)
        return _told(session, image, known)
    decided = select(Decision.id).where(Decision.image_id == image.id, Decision.group_id == client_id)
    if session.scalar(decided.limit(1)) is not None:
        raise Conflict("decisions have this client_id as their group", where="client_id", expected="a new UUID")
    segments = checked_polylines(given.kind, given.adds, image)
    verdicts = _verdicts_of_current(session, image, given)
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
    verdict = _verdict_of(given.kind, verdicts)
    _decide(session, edit, verdict, person, now)
    image.revision += 1
    refresh_counts(session, [image.id])
    _reopen(session, image, verdict, now)
    return _told(session, image, edit)


def edits_of_image(session: Session, image_id: int) -> Sequence[Edit]:
    """Return an image's edits, oldest first, undone ones too.

    Raises:
        NotFound: When there is no such image, or it is deleted.
    """
    get_image(session, image_id)
    return session.scalars(select(Edit).where(Edit.image_id == image_id).order_by(Edit.id)).all()


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


def _require_same(session: Session, image: Image, known: Edit, given: EditGiven) -> None:
    stored = {
        row.id: stored_polyline(row.points)
        for row in session.scalars(select(Segment).where(Segment.id.in_(known.added)).options(undefer(Segment.points)))
    }
    added = [stored.get(key, np.zeros((0, 2), np.float32)) for key in known.added]
    same_points = len(added) == len(given.adds) and all(
        np.array_equal(one, np.asarray(other, np.float32)) for one, other in zip(added, given.adds, strict=True)
    )
    said = (known.image_id, known.kind, tuple(known.replaced))
    if said != (image.id, given.kind, tuple(given.replaces)) or not same_points:
        raise Conflict(
            "another edit has this client_id",
            where="client_id",
            expected="a new UUID for each edit",
            details={"client_id": known.client_id},
        )


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


def _told(session: Session, image: Image, edit: Edit) -> StoredEdit:
    review = session.get(Review, image.id)
    session.refresh(image)
    return StoredEdit(
        id=edit.id,
        image_id=image.id,
        client_id=edit.client_id,
        kind=edit.kind,
        person=edit.person,
        replaced=tuple(edit.replaced),
        added=tuple(edit.added),
        created_at=edit.created_at,
        undone_at=edit.undone_at,
        revision=image.revision,
        verdicts=verdict_counts(image.n_candidates, image.n_keep, image.n_reject, image.n_ambiguous),
        status="open" if review is None else review.status,
        last_decision_id=last_decision_id(session, image.id),
    )
