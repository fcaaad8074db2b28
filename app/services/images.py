"""Images of a dataset: find, delete and restore them."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime, timedelta

from sqlalchemy import ColumnElement, func, select, update
from sqlalchemy.orm import Session

from app.db.models import Dataset, Image
from app.errors import Conflict, NotFound
from app.formats.naming import name_of
from app.services.batches import in_batches
from app.services.datasets import Deleted
from app.services.events import record_event

NAME_LENGTH = 500
WORD_LENGTH = 300
"""Longest source or sequence of an image."""

NAMES_SHOWN = 20
NAMES_AT_ONCE = 2_000


def get_image(session: Session, image_id: int, *, deleted: bool = False) -> Image:
    """Return an image that isn't deleted, nor its dataset.

    Args:
        session: Any session.
        image_id: Its id.
        deleted: Return it all the same if the image itself is deleted.

    Raises:
        NotFound: When there is none.
    """
    query = select(Image).join(Dataset).where(Image.id == image_id, Dataset.deleted_at.is_(None))
    image = session.scalars(query).one_or_none()
    if image is None:
        raise NotFound(f"there is no image {image_id}")
    if image.deleted_at is not None and not deleted:
        raise NotFound(f"the image {image.name} is deleted", hint="restore it first", details={"image_id": image_id})
    return image


def dataset_of(session: Session, image: Image) -> Dataset:
    """Return the dataset of an image."""
    return session.get_one(Dataset, image.dataset_id)


def images_of(session: Session, dataset: Dataset, ids: Sequence[int], *, deleted: bool = False) -> list[Image]:
    """Return images of a dataset, in any order.

    Raises:
        NotFound: Naming the ids that no (deleted) image of this dataset has.
    """
    wanted = sorted(set(ids))
    state = Image.deleted_at.is_not(None) if deleted else Image.deleted_at.is_(None)
    found: list[Image] = []
    for batch in in_batches(wanted):
        found += session.scalars(select(Image).where(Image.dataset_id == dataset.id, Image.id.in_(batch), state))
    missing = sorted(set(wanted) - {image.id for image in found})
    if missing:
        raise NotFound(
            f"{dataset.name} has no {'deleted ' if deleted else ''}image {', '.join(map(str, missing[:NAMES_SHOWN]))}",
            where="ids",
            details={"missing": missing[:1000]},
        )
    return found


def delete_images(
    session: Session,
    dataset: Dataset,
    ids: Sequence[int],
    now: datetime,
    *,
    grace: timedelta,
    person: str | None = None,
) -> Deleted:
    """Hide images with all that belongs to them; until the grace period is over they can be restored.

    Raises:
        NotFound: Naming the ids that no image of this dataset has; then none is deleted.
    """
    images = images_of(session, dataset, ids)
    _set_deleted(session, images, now)
    details = {"ids": [image.id for image in images]}
    record_event(session, "images.deleted", now, dataset_id=dataset.id, person=person, details=details)
    return Deleted(len(images), now, now + grace)


def restore_images(
    session: Session, dataset: Dataset, ids: Sequence[int], now: datetime, *, person: str | None = None
) -> int:
    """Bring deleted images back; all of them or none.

    Returns:
        How many.

    Raises:
        NotFound: Naming the ids that no deleted image of this dataset has.
        Conflict: Naming the images whose name or content another one took meanwhile.
    """
    images = images_of(session, dataset, ids, deleted=True)
    _require_free(session, dataset, images)
    _set_deleted(session, images, None)
    details = {"ids": [image.id for image in images]}
    record_event(session, "images.restored", now, dataset_id=dataset.id, person=person, details=details)
    return len(images)


def is_named(*names: str) -> ColumnElement[bool]:
    """Select images by name, in any case: on many systems ``a.png`` and ``A.png`` are one file.

    SQLite folds the case of ASCII letters alone, PostgreSQL that of all.
    """
    return Image.name.in_(names) | func.lower(Image.name).in_([func.lower(name) for name in names])


def name_conflict(first: str, second: str) -> Conflict:
    """Return the error of two files that would have one name."""
    return Conflict(
        f"two images of the name {name_of(second)}: {first}, which is here already, and {second}",
        where=second,
        expected="names (paths without extension) that differ",
        hint="rename one of them or put it into another folder",
        details={"images": [first, second]},
    )


def _set_deleted(session: Session, images: Sequence[Image], when: datetime | None) -> None:
    for batch in in_batches([image.id for image in images]):
        session.execute(update(Image).where(Image.id.in_(batch)).values(deleted_at=when))


def _require_free(session: Session, dataset: Dataset, images: Sequence[Image]) -> None:
    taken: list[str] = []
    names: set[str] = set()
    contents: set[str] = set()
    for batch in in_batches(images, NAMES_AT_ONCE):
        alive = select(Image.name, Image.sha256).where(Image.dataset_id == dataset.id, Image.deleted_at.is_(None))
        wanted = is_named(*(image.name for image in batch)) | Image.sha256.in_([image.sha256 for image in batch])
        for name, sha256 in session.execute(alive.where(wanted)):
            names.add(name.lower())
            contents.add(sha256)
    for image in sorted(images, key=lambda image: image.name):
        if image.name.lower() in names or image.sha256 in contents:
            taken.append(image.name)
        names.add(image.name.lower())
        contents.add(image.sha256)
    if taken:
        shown = ", ".join(taken[:NAMES_SHOWN])
        raise Conflict(
            f"other images have the name or content of {shown}{' ...' if len(taken) > NAMES_SHOWN else ''} by now",
            hint="delete or rename those first",
            details={"images": taken[:1000]},
        )
