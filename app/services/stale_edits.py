"""Edits of what isn't there any more are refused, with what took its place."""

from __future__ import annotations

from collections.abc import Sequence

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import Edit, Image
from app.errors import Conflict


class StaleEdit(Conflict):
    """What is to be edited isn't there any more: somebody else edited it, or a run replaced it."""

    code = "stale-edit"


def stale_edit(session: Session, image: Image, stale: Sequence[int]) -> StaleEdit:
    """Return the error that says which segments aren't current any more, and what took their place."""
    edits = session.scalars(select(Edit).where(Edit.image_id == image.id, Edit.undone_at.is_(None))).all()
    instead = [
        {"segment_id": key, "edit": edit.client_id, "kind": edit.kind, "person": edit.person, "replaced_by": edit.added}
        for key in stale
        for edit in edits
        if key in edit.replaced
    ]
    return StaleEdit(
        "the segment was changed elsewhere meanwhile",
        where=f"segment {stale[0]}",
        expected="a current segment of the image",
        hint="look at what is there now and edit that",
        details={"stale": list(stale), "current": instead, "revision": image.revision},
    )
