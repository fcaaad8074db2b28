"""Undo and redo of edits: decisions that undo or redo an edit's group change what is current with it."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime
from itertools import groupby

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import Edit, Image, Segment
from app.services.decision_batch import Wish
from app.services.edits import set_current
from app.services.stale_edits import stale_edit


def replay_edits(session: Session, image: Image, wishes: Sequence[Wish], now: datetime) -> None:
    """Undo and redo the edits whose groups decisions are about, in order; what is so already stays so.

    Args:
        session: A writing session that holds the image's row.
        image: The image.
        wishes: Decisions that are stored in this transaction.
        now: Time of the request.

    Raises:
        StaleEdit: When another edit builds on what would go, or what would be replaced again isn't current.
    """
    replays = [(wish.target_group_id, wish.kind) for wish in wishes if wish.kind in ("undo", "redo")]
    moves = [move for move, _ in groupby(replays)]  # one after the other: undone, done again and undone is undone
    if not moves:
        return
    groups = {group for group, _ in moves if group is not None}
    edits = session.scalars(select(Edit).where(Edit.image_id == image.id, Edit.client_id.in_(groups)))
    by_group = {edit.client_id: edit for edit in edits}
    for group, kind in moves:
        edit = by_group.get(group or "")
        if edit is None or (edit.undone_at is not None) == (kind == "undo"):
            continue
        going, coming = (edit.added, edit.replaced) if kind == "undo" else (edit.replaced, edit.added)
        _require_current(session, image, going)
        set_current(session, retired=going, current=coming, now=now)
        edit.undone_at = now if kind == "undo" else None
        image.revision += 1
    session.flush()


def edited_away(session: Session, image_id: int) -> set[int]:
    """Return the segments of an image that an edit has put away: no late verdict makes these current again."""
    away: set[int] = set()
    for edit in session.scalars(select(Edit).where(Edit.image_id == image_id)):
        away.update(edit.replaced if edit.undone_at is None else edit.added)
    return away


def _require_current(session: Session, image: Image, segment_ids: Sequence[int]) -> None:
    query = select(Segment.id).where(Segment.id.in_(segment_ids), Segment.retired_at.is_not(None))
    stale = sorted(session.scalars(query)) if segment_ids else []
    if stale:
        raise stale_edit(session, image, stale)
