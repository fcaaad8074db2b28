"""Splits: make, find, change, delete and restore them; each freezing is a new version, and old ones stay."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import SPLIT_VISIBILITIES, Dataset, Image, Split, SplitImage, SplitVersion
from app.errors import Conflict, InvalidInput, NotFound
from app.services.datasets import get_dataset
from app.services.events import record_event
from app.services.freezing import freeze
from app.services.given import UNCHANGED, Unchanged, checked_name, checked_text
from app.services.slugs import free_slug, slug_of
from app.storage import BlobStore

MAX_MIN_LENGTH = 100_000.0
MAX_DAILY_LIMIT = 100_000
DAILY_LIMIT = 20
HIDDEN_DAILY_LIMIT = 5


@dataclass(frozen=True)
class SplitPlan:
    """What a split is to be.

    Attributes:
        min_length: Labels of less arc length, px, are ignored.
        visibility: ``open`` or ``hidden``; never changed later.
        closes_at: From then on nothing is taken any more.
        daily_limit: Submissions per person and day; a default that fits the visibility when left out.
        image_ids: Which images; all whose review is done when left out.
    """

    name: str
    min_length: float = 0.0
    visibility: str = "open"
    description: str | None = None
    closes_at: datetime | None = None
    daily_limit: int | None = None
    image_ids: Sequence[int] | None = None


@dataclass(frozen=True)
class SplitChanges:
    """What to change of a split; a field that is left out stays as it is."""

    name: str | Unchanged = UNCHANGED
    description: str | Unchanged | None = UNCHANGED
    closes_at: datetime | Unchanged | None = UNCHANGED
    daily_limit: int | Unchanged = UNCHANGED


def get_split(session: Session, slug: str, *, deleted: bool = False) -> Split:
    """Return a split; one that is deleted only when ``deleted`` says so.

    Raises:
        NotFound: When there is none of that slug.
    """
    split = session.scalars(select(Split).where(Split.slug == slug)).one_or_none() if slug.isascii() else None
    if split is None:
        raise NotFound(f"there is no split {slug}", hint="GET /api/splits lists them")
    if split.deleted_at is not None and not deleted:
        raise NotFound(f"the split {split.name} is deleted", hint="restore it first", details={"slug": slug})
    return split


def current_version(session: Session, split: Split) -> SplitVersion:
    """Return the newest version of a split: what submissions are scored against."""
    query = select(SplitVersion).where(SplitVersion.split_id == split.id).order_by(SplitVersion.number.desc())
    return session.scalars(query.limit(1)).one()


def get_version(session: Session, split: Split, number: int | None) -> SplitVersion:
    """Return a version of a split, the newest one when no number is given.

    Raises:
        NotFound: When there is none of that number.
    """
    if number is None:
        return current_version(session, split)
    query = select(SplitVersion).where(SplitVersion.split_id == split.id, SplitVersion.number == number)
    version = session.scalars(query).one_or_none()
    if version is None:
        raise NotFound(f"{split.name} has no version {number}", where="version")
    return version


def is_closed(split: Split, now: datetime) -> bool:
    """Whether the split's deadline is over."""
    return split.closes_at is not None and split.closes_at <= now


def create_split(
    session: Session, blobs: BlobStore, dataset_slug: str, plan: SplitPlan, now: datetime, *, person: str | None = None
) -> Split:
    """Make a split and freeze its first version.

    Raises:
        NotFound: When there is no such dataset, or it has no image of a given id.
        InvalidInput: Naming the field that can't be.
        Conflict: When a split has the name.
        NotFrozen: With a reason for each image that can't be frozen.
    """
    dataset = get_dataset(session, dataset_slug)
    name = checked_name(plan.name)
    if plan.visibility not in SPLIT_VISIBILITIES:
        raise InvalidInput(
            f"{plan.visibility!r:.60} is not possible", where="visibility", expected=", ".join(SPLIT_VISIBILITIES)
        )
    if not 0 <= plan.min_length <= MAX_MIN_LENGTH:
        raise InvalidInput(f"{plan.min_length} is out of range", where="min_length", expected="a length in px")
    _require_free_name(session, name)
    default = HIDDEN_DAILY_LIMIT if plan.visibility == "hidden" else DAILY_LIMIT
    split = Split(
        dataset_id=dataset.id,
        slug=free_slug(slug_of(name), set(session.scalars(select(Split.slug)))),
        name=name,
        description=checked_text(plan.description, "description"),
        min_length=plan.min_length,
        visibility=plan.visibility,
        closes_at=plan.closes_at,
        daily_limit=_checked_limit(default if plan.daily_limit is None else plan.daily_limit),
        created_at=now,
        created_by=person,
    )
    session.add(split)
    session.flush()
    version = freeze(session, blobs, split, dataset, plan.image_ids, now, person=person)
    _record(session, "split.frozen", split, now, person, version=version.number, truth_hash=version.truth_hash)
    return split


def freeze_again(
    session: Session,
    blobs: BlobStore,
    slug: str,
    image_ids: Sequence[int] | None,
    now: datetime,
    *,
    person: str | None = None,
) -> Split:
    """Freeze a split's labels anew: a new version; the old one and its scores stay.

    Args:
        session: A writing session.
        blobs: Where the truth goes.
        slug: Of the split.
        image_ids: Which images; those of the newest version that the dataset still has when left out.
        now: When.
        person: Who freezes.

    Raises:
        NotFound: When there is no such split, or its dataset is gone.
        NotFrozen: With a reason for each image that can't be frozen; or when no label has changed.
    """
    split = get_split(session, slug)
    session.refresh(split, with_for_update=True)
    dataset = None if split.dataset_id is None else session.get(Dataset, split.dataset_id)
    if dataset is None or dataset.deleted_at is not None:
        raise NotFound("the dataset that the split was made from is gone", where=slug, hint="its old versions stay")
    if image_ids is None:
        still_there = (
            select(Image.id)
            .join(SplitImage, SplitImage.image_id == Image.id)
            .where(SplitImage.version_id == current_version(session, split).id, Image.deleted_at.is_(None))
        )
        image_ids = session.scalars(still_there).all()
    version = freeze(session, blobs, split, dataset, image_ids, now, person=person)
    _record(session, "split.frozen", split, now, person, version=version.number, truth_hash=version.truth_hash)
    return split


def change_split(
    session: Session, slug: str, changes: SplitChanges, now: datetime, *, person: str | None = None
) -> Split:
    """Change what is said of a split; its truth, minimum length and visibility stay as they are.

    Raises:
        NotFound: When there is no such split.
        InvalidInput: Naming the field that can't be.
        Conflict: When another split has the name.
    """
    split = get_split(session, slug)
    if changes.name is not UNCHANGED:
        name = checked_name(changes.name)
        if name != split.name:
            _require_free_name(session, name)
        split.name = name
    if changes.description is not UNCHANGED:
        split.description = checked_text(changes.description, "description")
    if changes.closes_at is not UNCHANGED:
        split.closes_at = changes.closes_at
    if changes.daily_limit is not UNCHANGED:
        split.daily_limit = _checked_limit(changes.daily_limit)
    session.flush()
    told = {name: str(value) for name, value in vars(changes).items() if value is not UNCHANGED}
    _record(session, "split.changed", split, now, person, **told)
    return split


def delete_split(session: Session, slug: str, now: datetime, *, person: str | None = None) -> Split:
    """Hide a split with its submissions; it can be restored at any time, since published scores name it."""
    split = get_split(session, slug)
    split.deleted_at = now
    session.flush()
    _record(session, "split.deleted", split, now, person)
    return split


def restore_split(session: Session, slug: str, now: datetime, *, person: str | None = None) -> Split:
    """Bring a deleted split back.

    Raises:
        NotFound: When there is none of that slug.
        Conflict: When it isn't deleted, or another one took its name meanwhile.
    """
    split = get_split(session, slug, deleted=True)
    if split.deleted_at is None:
        raise Conflict(f"the split {split.name} isn't deleted")
    _require_free_name(session, split.name, hint="rename the other one first")
    split.deleted_at = None
    session.flush()
    _record(session, "split.restored", split, now, person)
    return split


def _checked_limit(limit: int) -> int:
    if not 1 <= limit <= MAX_DAILY_LIMIT:
        raise InvalidInput(f"{limit} is out of range", where="daily_limit", expected=f"1 to {MAX_DAILY_LIMIT}")
    return limit


def _require_free_name(session: Session, name: str, hint: str = "choose another name") -> None:
    taken = session.scalar(select(Split.slug).where(Split.name == name, Split.deleted_at.is_(None)).limit(1))
    if taken is not None:
        raise Conflict(f"a split named {name} exists already", where="name", hint=hint, details={"slug": taken})


def _record(session: Session, kind: str, split: Split, now: datetime, person: str | None, **details: Any) -> None:
    told = {"split": split.slug, **details}
    record_event(session, kind, now, dataset_id=split.dataset_id, person=person, details=told)
