"""Datasets: make, rename, delete and restore them."""

from __future__ import annotations

import unicodedata
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime, timedelta

from sqlalchemy import or_, select
from sqlalchemy.orm import Session

from app.db.models import Dataset
from app.errors import Conflict, InvalidInput, NotFound
from app.services.events import record_event
from app.services.given import checked_text
from app.services.slugs import free_slug, slug_of

NAME_LENGTH = 200
CARD_TEXTS = ("description", "licence", "citation")


@dataclass(frozen=True)
class Deleted:
    """How much was deleted, and until when it can be restored."""

    deleted: int
    deleted_at: datetime
    restorable_until: datetime


def get_dataset(session: Session, slug: str) -> Dataset:
    """Return a dataset that isn't deleted.

    Raises:
        NotFound: When there is none of that slug.
    """
    found = _of_slug(session, slug)
    if found is None:
        raise NotFound(f"there is no dataset {slug}", hint="the list of datasets shows their slugs")
    if found.deleted_at is not None:
        raise NotFound(f"the dataset {found.name} is deleted", hint="restore it first", details={"slug": slug})
    return found


def create_dataset(session: Session, name: str, now: datetime, *, person: str | None = None) -> Dataset:
    """Make an empty dataset; its slug comes from its name.

    Raises:
        InvalidInput: When the name is empty or too long.
        Conflict: When a dataset of that name exists.
    """
    name = checked_dataset_name(name)
    _require_free_name(session, name)
    dataset = Dataset(slug=_take_slug(session, slug_of(name)), name=name, created_at=now)
    session.add(dataset)
    session.flush()
    record_event(session, "dataset.created", now, dataset_id=dataset.id, person=person, details={"name": name})
    return dataset


def rename_dataset(session: Session, slug: str, name: str, now: datetime, *, person: str | None = None) -> Dataset:
    """Give a dataset another name; the slug stays, so that links to it stay good.

    Raises:
        NotFound: When there is no such dataset.
        InvalidInput: When the name is empty or too long.
        Conflict: When another dataset has that name.
    """
    dataset = get_dataset(session, slug)
    name = checked_dataset_name(name)
    if name != dataset.name:
        _require_free_name(session, name)
        details = {"from": dataset.name, "to": name}
        record_event(session, "dataset.renamed", now, dataset_id=dataset.id, person=person, details=details)
        dataset.name = name
        session.flush()
    return dataset


def describe_dataset(
    session: Session, slug: str, texts: Mapping[str, str | None], now: datetime, *, person: str | None = None
) -> Dataset:
    """Change what a dataset's card says.

    Args:
        session: A writing session.
        slug: Of the dataset.
        texts: New values of some of ``CARD_TEXTS``; ``None`` clears one.
        now: When.
        person: Who does it.

    Raises:
        NotFound: When there is no such dataset.
        InvalidInput: When a text is too long or holds a NUL character.
    """
    dataset = get_dataset(session, slug)
    changed: list[str] = []
    for field in CARD_TEXTS:
        text = checked_text(texts.get(field), field)
        if field not in texts or text == getattr(dataset, field):
            continue
        setattr(dataset, field, text)
        changed.append(field)
    if changed:
        session.flush()
        record_event(
            session, "dataset.described", now, dataset_id=dataset.id, person=person, details={"fields": changed}
        )
    return dataset


def delete_dataset(
    session: Session, slug: str, now: datetime, *, grace: timedelta, person: str | None = None
) -> Deleted:
    """Hide a dataset with all it holds; until the grace period is over it can be restored."""
    dataset = get_dataset(session, slug)
    dataset.deleted_at = now
    session.flush()
    record_event(session, "dataset.deleted", now, dataset_id=dataset.id, person=person, details={"name": dataset.name})
    return Deleted(1, now, now + grace)


def restore_dataset(session: Session, slug: str, now: datetime, *, person: str | None = None) -> Dataset:
    """Bring a deleted dataset back with all it holds.

    Raises:
        NotFound: When there is none of that slug any more.
        Conflict: When it isn't deleted, or another one took its name meanwhile.
    """
    dataset = _of_slug(session, slug, lock=True)
    if dataset is None:
        raise NotFound(f"there is no dataset {slug}", hint="after the grace period a deleted one is gone for good")
    if dataset.deleted_at is None:
        raise Conflict(f"the dataset {dataset.name} isn't deleted")
    _require_free_name(session, dataset.name, hint="rename the other one first")
    dataset.deleted_at = None
    session.flush()
    record_event(session, "dataset.restored", now, dataset_id=dataset.id, person=person, details={"name": dataset.name})
    return dataset


def _of_slug(session: Session, slug: str, *, lock: bool = False) -> Dataset | None:
    if not slug.isascii():  # no slug; and what a terminal gives may be no text that a database takes
        return None
    query = select(Dataset).where(Dataset.slug == slug)
    return session.scalars(query.with_for_update(key_share=True) if lock else query).one_or_none()


def checked_dataset_name(name: str) -> str:
    """Return the name in Unicode's composed form, with single spaces.

    Raises:
        InvalidInput: When it is empty, too long, or has control characters.
    """
    name = " ".join(unicodedata.normalize("NFC", name).split())
    if not name or len(name) > NAME_LENGTH or not name.isprintable():
        raise InvalidInput(
            "a dataset needs a name" if not name else "the name is too long or holds control characters",
            where="name",
            expected=f"1 to {NAME_LENGTH} characters",
        )
    return name


def _require_free_name(session: Session, name: str, hint: str = "choose another name") -> None:
    query = select(Dataset.slug).where(Dataset.name == name, Dataset.deleted_at.is_(None))
    if taken := session.scalars(query).one_or_none():
        raise Conflict(f"a dataset named {name} exists already", where="name", hint=hint, details={"slug": taken})


def _take_slug(session: Session, base: str) -> str:
    """Return a free slug; a deleted dataset gives its own up and gets a numbered one."""
    rows = session.scalars(select(Dataset).where(or_(Dataset.slug == base, Dataset.slug.startswith(f"{base}-")))).all()
    by_slug = {row.slug: row for row in rows}
    alive = {slug for slug, row in by_slug.items() if row.deleted_at is None}
    slug = free_slug(base, alive)
    if slug in by_slug:
        by_slug[slug].slug = free_slug(base, set(by_slug))
        session.flush()
    return slug
