"""Leases: one of the pages that have an image open holds it, and says so again and again; the others see who it is.

A lease keeps people out of each other's way. It isn't what protects verdicts: a page that was cut off may still send
what was decided on it, and what is stale among that is refused (see ``app.services.stale_verdicts``).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta

from sqlalchemy import ColumnElement, and_, delete, exists, select
from sqlalchemy.orm import Session

from app.db.models import Image, Lease
from app.services.events import record_event
from app.services.images import get_image

LASTS = timedelta(seconds=60)


@dataclass(frozen=True)
class Present:
    """Someone who has the image open.

    Attributes:
        person: The name.
        since: When they opened it, or took it over.
        mine: Whether it is the person who asks, on whatever page.
    """

    person: str | None
    since: datetime
    mine: bool


@dataclass(frozen=True)
class LeaseState:
    """Who has an image open.

    Attributes:
        holder: Who may decide; ``None`` when nobody has it open.
        expires_at: Until when the page that asked counts as present.
        present: Everyone, each person once, who came first before the others.
    """

    holder: Present | None
    expires_at: datetime
    present: tuple[Present, ...]


def renew_lease(
    session: Session,
    image_id: int,
    client_id: str,
    person: str | None,
    now: datetime,
    *,
    take_over: bool = False,
) -> LeaseState:
    """Say that a page has an image open; it holds the image if nobody else does.

    Pages of one person are one holder: what a crashed tab held, the next one of the same person holds at once.

    Args:
        session: A writing session.
        image_id: The image.
        client_id: Of the page, made by it.
        person: Whose page it is.
        now: Time of the request.
        take_over: Hold it although another person does.

    Raises:
        NotFound: When there is no such image, or it is deleted.
    """
    get_image(session, image_id)
    image = session.get_one(Image, image_id, with_for_update=True)  # of two that come at once, the first one holds
    session.execute(delete(Lease).where(~_is_there(now)))
    leases = list(session.scalars(select(Lease).where(Lease.image_id == image_id)))
    mine = next((lease for lease in leases if lease.client_id == client_id), None)
    if mine is None:
        mine = Lease(image_id=image_id, client_id=client_id, holds=False, since=now)
        session.add(mine)
        leases.append(mine)
    elif mine.person != person:
        mine.holds = False  # another name was chosen on this page
    mine.person = person
    mine.expires_at = now + LASTS
    holder = next((lease for lease in leases if lease.holds), None)
    if holder is None:
        mine.holds = True
    elif take_over and holder.person != person:
        for lease in leases:
            lease.holds = lease is mine
        mine.since = now
        details = {"image": image_id, "from": holder.person}
        record_event(session, "image.taken-over", now, dataset_id=image.dataset_id, person=person, details=details)
    session.flush()
    return _state(leases, mine.expires_at, person)


def release_lease(session: Session, image_id: int, client_id: str, person: str | None) -> None:
    """Say that a page of this person is closed; that it was never open is no error.

    Raises:
        NotFound: When there is no such image, or it is deleted.
    """
    get_image(session, image_id)
    session.execute(
        delete(Lease).where(
            Lease.image_id == image_id, Lease.client_id == client_id, Lease.person.is_not_distinct_from(person)
        )
    )


def is_held_by_another(person: str | None, now: datetime) -> ColumnElement[bool]:
    """Return the condition on ``Image`` that somebody else holds it at this time."""
    return (
        exists()
        .where(
            Lease.image_id == Image.id,
            Lease.holds.is_(True),
            _is_there(now),
            Lease.person.is_distinct_from(person),
        )
        .correlate(Image)
    )


def _is_there(now: datetime) -> ColumnElement[bool]:
    """Return the condition that a lease isn't over; one that ends later than a lease can is of a clock put back."""
    return and_(Lease.expires_at > now, Lease.expires_at <= now + LASTS)


def _state(leases: Sequence[Lease], expires_at: datetime, person: str | None) -> LeaseState:
    holder = next((lease for lease in leases if lease.holds), None)
    first: dict[str | None, Lease] = {}
    for lease in sorted(leases, key=lambda lease: (lease.since, lease.client_id)):
        first.setdefault(lease.person, lease)
    return LeaseState(
        None if holder is None else _present(holder, person),
        expires_at,
        tuple(_present(lease, person) for lease in first.values()),
    )


def _present(lease: Lease, person: str | None) -> Present:
    return Present(lease.person, lease.since, lease.person == person)
