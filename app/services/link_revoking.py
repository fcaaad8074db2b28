"""Links that make accounts or choose passwords, ended before anybody has used them."""

from __future__ import annotations

from datetime import datetime

from sqlalchemy import ColumnElement, update
from sqlalchemy.orm import Session

from app.db.models import Invitation


def revoke_links_to(session: Session, user_id: int, now: datetime) -> None:
    """End the links that let the holder of an account choose a new password."""
    _revoke(session, now, Invitation.user_id == user_id, Invitation.kind == "reset")


def revoke_links_by(session: Session, name: str, now: datetime) -> None:
    """End all links that somebody made: who isn't trusted any more may have kept one, for an account as good as theirs.

    Args:
        session: A writing session.
        name: Of the account, or of the service's token.
        now: When.
    """
    _revoke(session, now, Invitation.created_by == name)


def _revoke(session: Session, now: datetime, *which: ColumnElement[bool]) -> None:
    unused = (Invitation.used_at.is_(None), Invitation.revoked_at.is_(None))
    session.execute(update(Invitation).where(*which, *unused).values(revoked_at=now))
