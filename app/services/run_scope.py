"""Which images a run takes."""

from __future__ import annotations

from collections.abc import Sequence

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import Dataset, Image, Run, RunImage
from app.errors import Conflict, InvalidInput
from app.services.run_queue import UNFINISHED


def wanted_images(session: Session, dataset: Dataset, image_ids: Sequence[int] | None) -> list[int]:
    """Return the ids of the images that a run takes, by name.

    Args:
        session: Any session.
        dataset: The dataset.
        image_ids: Only these; all that aren't deleted when left out.

    Raises:
        InvalidInput: On ids that are no images of the dataset.
        Conflict: When the dataset has no images.
    """
    alive = select(Image.id).where(Image.dataset_id == dataset.id, Image.deleted_at.is_(None)).order_by(Image.name)
    there = session.scalars(alive).all()
    if image_ids is None:
        if not there:
            raise Conflict("the dataset has no images", hint="add images first")
        return list(there)
    asked = set(image_ids)
    unknown = sorted(asked.difference(there))
    if unknown or not asked:
        raise InvalidInput(
            f"image {unknown[0]} isn't in this dataset" if unknown else "no image is named",
            where="image_ids",
            expected="ids of images of the dataset",
            details={"images": unknown[:100]},
        )
    return [image_id for image_id in there if image_id in asked]


def refuse_busy_images(session: Session, dataset: Dataset, wanted: set[int]) -> None:
    """Refuse images that another run hasn't finished with: two results would overtake each other.

    Raises:
        Conflict: When there are any.
    """
    rows = session.execute(
        select(RunImage.run_id, RunImage.image_id)
        .join(Run, Run.id == RunImage.run_id)
        .where(
            Run.dataset_id == dataset.id,
            Run.status.in_(UNFINISHED),
            Run.deleted_at.is_(None),
        )
    )
    busy = {run_id for run_id, image_id in rows if image_id in wanted}
    if busy:
        raise Conflict(
            f"run {min(busy)} is at work on these images",
            hint="wait until it is done, or cancel it",
            details={"runs": sorted(busy)},
        )
