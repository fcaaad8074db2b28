"""Change what is known of images: name, camera, source, sequence; one or many at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from sqlalchemy import select, update
from sqlalchemy.orm import Session

from app.db.models import Camera, Dataset, Image
from app.errors import InvalidInput
from app.formats.naming import check_image_name, composed
from app.services.batches import in_batches
from app.services.cameras import camera_for, checked_camera_name
from app.services.events import record_event
from app.services.given import UNCHANGED, Unchanged
from app.services.images import NAME_LENGTH, NAMES_SHOWN, WORD_LENGTH, images_of, is_named, name_conflict


@dataclass(frozen=True)
class ImageChanges:
    """What to change; a field that is left out stays as it is.

    Attributes:
        camera: Name of the camera, which is made if new.
        source: Where the images come from; ``None`` clears it.
        sequence: The drive they belong to; ``None`` clears it.
    """

    camera: str | Unchanged = UNCHANGED
    source: str | Unchanged | None = UNCHANGED
    sequence: str | Unchanged | None = UNCHANGED


def update_images(
    session: Session,
    dataset: Dataset,
    ids: Sequence[int],
    changes: ImageChanges,
    now: datetime,
    *,
    person: str | None = None,
) -> int:
    """Change images of a dataset; all of them or none.

    Returns:
        How many.

    Raises:
        NotFound: Naming the ids that no image of the dataset has.
        InvalidInput: Naming the images whose size isn't the camera's; or on words that are empty or too long.
    """
    images = images_of(session, dataset, ids)
    values: dict[str, Any] = {}
    if changes.camera is not UNCHANGED:
        values["camera_id"] = _camera_of_all(session, dataset, images, changes.camera, now).id
    for column, word in (("source", changes.source), ("sequence", changes.sequence)):
        if word is not UNCHANGED:
            values[column] = _checked_word(word, column)
    if not values:
        return 0
    for batch in in_batches([image.id for image in images]):
        session.execute(update(Image).where(Image.id.in_(batch)).values(values))
    details = {
        "ids": [image.id for image in images],
        **{name: value for name, value in vars(changes).items() if value is not UNCHANGED},
    }
    record_event(session, "images.changed", now, dataset_id=dataset.id, person=person, details=details)
    return len(images)


def rename_image(session: Session, image: Image, name: str, now: datetime, *, person: str | None = None) -> Image:
    """Give an image another name (path without extension); its file name follows.

    Raises:
        InvalidInput: When it is no path under a root.
        Conflict: When another image of the dataset has that name.
    """
    name = composed(name.strip())
    check_image_name(name, where="name")
    if len(name) > NAME_LENGTH - 10:
        raise InvalidInput("the name is too long", where="name", expected=f"at most {NAME_LENGTH - 10} characters")
    if name == image.name:
        return image
    present = select(Image).where(Image.dataset_id == image.dataset_id, Image.deleted_at.is_(None))
    extension = image.file_name[len(image.name) :]
    if other := session.scalars(present.where(is_named(name), Image.id != image.id)).first():
        raise name_conflict(other.file_name, f"{name}{extension}")
    details = {"image_id": image.id, "from": image.name, "to": name}
    record_event(session, "image.renamed", now, dataset_id=image.dataset_id, person=person, details=details)
    image.name, image.file_name = name, f"{name}{extension}"
    session.flush()
    return image


def _camera_of_all(session: Session, dataset: Dataset, images: Sequence[Image], name: str, now: datetime) -> Camera:
    name = checked_camera_name(name)
    query = select(Camera).where(Camera.dataset_id == dataset.id, Camera.name == name)
    present = session.scalars(query).one_or_none()
    first = present or min(images, key=lambda image: image.name)
    others = sorted(image.name for image in images if (image.width, image.height) != (first.width, first.height))
    if others:
        shown = ", ".join(others[:NAMES_SHOWN]) + (" ..." if len(others) > NAMES_SHOWN else "")
        raise InvalidInput(
            f"the camera {name} takes images of {first.width} x {first.height} px, which these aren't: {shown}",
            where="camera",
            expected="images of one size per camera",
            details={"images": others[:1000]},
        )
    return camera_for(session, dataset, name, first.width, first.height, now)


def _checked_word(word: str | None, where: str) -> str | None:
    word = composed(word.strip()) if word else None
    if word and (len(word) > WORD_LENGTH or not word.isprintable()):
        raise InvalidInput(
            "the text is too long or has control characters", where=where, expected=f"at most {WORD_LENGTH} characters"
        )
    return word or None
