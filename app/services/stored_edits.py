"""Edits as they are asked for and stored; one that is sent again is known by its client id."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any
from uuid import UUID

import numpy as np
from numpy.typing import NDArray
from sqlalchemy import select
from sqlalchemy.orm import Session, undefer

from app.db.models import Edit, Image, Review, Segment
from app.errors import Conflict
from app.services.carrying import stored_polyline
from app.services.counts import VerdictCounts, verdict_counts
from app.services.images import get_image
from app.services.stale_verdicts import last_decision_id


@dataclass(frozen=True, eq=False)
class EditGiven:
    """An edit as a client asks for it.

    Attributes:
        client_id: Made by the client; the same one again is the same edit. The group that its decisions carry.
        kind: One of `app.db.models.EDIT_KINDS`.
        replaces: Ids of the segments that go.
        adds: float ``(n, 2)`` px of the segments that come; ``None`` where they are left to the server.
        seen: Id of the image's last decision that the person knew; later ones of others aren't overruled silently.
    """

    client_id: UUID | str
    kind: str
    replaces: tuple[int, ...]
    adds: tuple[NDArray[Any], ...] | None
    seen: int | None = None


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


def stored_edit(session: Session, image_id: int, given: EditGiven) -> StoredEdit | None:
    """Return an edit that is stored already, by its client id; ``None`` when it is new.

    Raises:
        NotFound: When there is no such image, or it is deleted.
        Conflict: When its client id is known with another content.
    """
    image = get_image(session, image_id)
    known = session.scalar(select(Edit).where(Edit.client_id == str(given.client_id)))
    if known is None:
        return None
    _require_same(session, image, known, given)
    return told(session, image, known)


def edits_of_image(session: Session, image_id: int) -> Sequence[Edit]:
    """Return an image's edits, oldest first, undone ones too.

    Raises:
        NotFound: When there is no such image, or it is deleted.
    """
    get_image(session, image_id)
    return session.scalars(select(Edit).where(Edit.image_id == image_id).order_by(Edit.id)).all()


def told(session: Session, image: Image, edit: Edit) -> StoredEdit:
    """Return an edit with what is current on its image."""
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


def _require_same(session: Session, image: Image, known: Edit, given: EditGiven) -> None:
    said = (known.image_id, known.kind, tuple(known.replaced))
    same_points = given.adds is None or _adds(session, known, given.adds)
    if said != (image.id, given.kind, tuple(given.replaces)) or not same_points:
        raise Conflict(
            "another edit has this client_id",
            where="client_id",
            expected="a new UUID for each edit",
            details={"client_id": known.client_id},
        )


def _adds(session: Session, edit: Edit, polylines: Sequence[NDArray[Any]]) -> bool:
    """Whether these are the segments that an edit added."""
    query = select(Segment).where(Segment.id.in_(edit.added)).options(undefer(Segment.points))
    stored = {row.id: stored_polyline(row.points) for row in session.scalars(query)}
    added = [stored.get(key, np.zeros((0, 2), np.float32)) for key in edit.added]
    return len(added) == len(polylines) and all(
        np.array_equal(one, np.asarray(other, np.float32)) for one, other in zip(added, polylines, strict=True)
    )
