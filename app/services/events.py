"""The audit: what was imported, renamed, deleted, restored, exported, and by whom. Rows are only ever added."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.db.models import Dataset, Event
from app.services.paging import Order, Page, checked_limit, page_of

NEWEST_FIRST = Order("newest", Event.created_at, Event.id, descending=True)


@dataclass(frozen=True)
class Actor:
    """Who does what is audited.

    Attributes:
        person: Their name; ``None`` where nobody has said it.
        address: Where they ask from; ``None`` on the command line.
    """

    person: str | None
    address: str | None = None


@dataclass(frozen=True)
class EventEntry:
    """One line of the audit."""

    id: int
    kind: str
    person: str | None
    details: dict[str, Any]
    created_at: datetime


def record_event(
    session: Session,
    kind: str,
    now: datetime,
    *,
    dataset_id: int | None = None,
    person: str | None = None,
    address: str | None = None,
    details: Mapping[str, Any] | None = None,
) -> None:
    """Add a line to the audit, in the transaction of what it tells of.

    Args:
        session: A writing session.
        kind: What happened, ``dataset.renamed``.
        now: When.
        dataset_id: Where.
        person: Who did it.
        address: Where they asked from, on what concerns accounts.
        details: Facts; JSON-serialisable, nothing secret.
    """
    told = dict(details or {})
    session.add(Event(dataset_id=dataset_id, kind=kind, person=person, address=address, details=told, created_at=now))


def record_account_event(session: Session, kind: str, now: datetime, actor: Actor, /, **details: Any) -> None:
    """Add a line about an account, session, invitation or token to the audit.

    Args:
        session: A writing session.
        kind: What happened, ``user.disabled``.
        now: When.
        actor: Who did it.
        details: Facts; JSON-serialisable, nothing secret.
    """
    record_event(session, kind, now, person=actor.person, address=actor.address, details=details)


def list_events(session: Session, dataset: Dataset, *, limit: int = 100, cursor: str | None = None) -> Page[EventEntry]:
    """Return what happened in a dataset, newest first."""
    limit = checked_limit(limit)
    query = select(Event).where(Event.dataset_id == dataset.id)
    total = session.scalar(select(func.count()).select_from(query.subquery())) or 0
    if cursor:
        query = query.where(NEWEST_FIRST.after(cursor))
    rows = session.scalars(query.order_by(*NEWEST_FIRST.clauses()).limit(limit + 1)).all()
    page = page_of(rows, limit, NEWEST_FIRST, lambda event: (event.created_at, event.id), total)
    return page.map(lambda event: EventEntry(event.id, event.kind, event.person, event.details, event.created_at))
