"""The audit as admins read it: who did what, when, and from where on what concerns accounts."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from typing import Any

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import Dataset, Event
from app.errors import InvalidInput
from app.services.concealing import no_such_dataset
from app.services.events import NEWEST_FIRST
from app.services.paging import checked_limit, write_cursor


@dataclass(frozen=True)
class AuditFilter:
    """What to show of the audit; what is ``None`` filters nothing.

    Attributes:
        person: Who did it.
        kind: How the kind begins: ``user.`` or ``user.disabled``.
        dataset: Slug; of one that is deleted and not purged too.
        since: From this time on.
        until: Before this time.
    """

    person: str | None = None
    kind: str | None = None
    dataset: str | None = None
    since: datetime | None = None
    until: datetime | None = None


@dataclass(frozen=True)
class AuditEntry:
    """One line of the audit.

    Attributes:
        dataset: Slug of the dataset that it concerns.
    """

    id: int
    created_at: datetime
    kind: str
    person: str | None
    address: str | None
    dataset: str | None
    details: dict[str, Any]


@dataclass(frozen=True)
class AuditPage:
    """Some lines, newest first; they aren't counted, since that would take the longer the more there are."""

    items: tuple[AuditEntry, ...]
    next_cursor: str | None


def read_audit(session: Session, wanted: AuditFilter, *, limit: int = 100, cursor: str | None = None) -> AuditPage:
    """Return lines of the audit, newest first.

    Raises:
        InvalidInput: When the limit, the cursor or a time can't be.
        NotFound: When there is no such dataset.
    """
    limit = checked_limit(limit)
    query = select(Event, Dataset.slug).outerjoin(Dataset, Dataset.id == Event.dataset_id)
    if wanted.person is not None:
        query = query.where(Event.person == wanted.person)
    if wanted.kind is not None:
        query = query.where(Event.kind.startswith(wanted.kind, autoescape=True))
    if wanted.dataset is not None:
        query = query.where(Event.dataset_id == _dataset_id(session, wanted.dataset))
    if wanted.since is not None:
        query = query.where(Event.created_at >= _zoned(wanted.since, "since"))
    if wanted.until is not None:
        query = query.where(Event.created_at < _zoned(wanted.until, "until"))
    if cursor:
        query = query.where(NEWEST_FIRST.after(cursor))
    rows = session.execute(query.order_by(*NEWEST_FIRST.clauses()).limit(limit + 1)).all()
    items = tuple(_entry(event, slug) for event, slug in rows[:limit])
    more = len(rows) > limit
    return AuditPage(items, write_cursor(NEWEST_FIRST.name, items[-1].created_at, items[-1].id) if more else None)


def _dataset_id(session: Session, slug: str) -> int:
    query = select(Dataset.id).where(Dataset.slug == slug).order_by(Dataset.deleted_at.is_not(None), Dataset.id.desc())
    found = session.scalars(query.limit(1)).one_or_none() if slug.isascii() else None
    if found is None:
        raise no_such_dataset(slug)
    return found


def _zoned(time: datetime, where: str) -> datetime:
    if time.tzinfo is None:
        raise InvalidInput("the time has no zone", where=where, expected="like 2026-01-31T12:00:00Z")
    return time


def _entry(event: Event, slug: str | None) -> AuditEntry:
    return AuditEntry(event.id, event.created_at, event.kind, event.person, event.address, slug, event.details)
