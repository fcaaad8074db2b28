"""Which database this is."""

from __future__ import annotations

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import Installation


def instance_of(session: Session) -> str:
    """Return the name that tells this database from every other one; made with its tables, never changed."""
    return session.scalars(select(Installation.instance)).one()
