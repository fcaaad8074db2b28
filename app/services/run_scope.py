"""Which images a run takes."""

from __future__ import annotations

from collections.abc import Sequence

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import Dataset, Image, Run, RunImage
from app.errors import Conflict, InvalidInput
from app.services.batches import in_batches
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
    alive = select(Image.id).where(Image.dataset_id == dataset.id, Image.deleted_at.is_(None))
    if image_ids is None:
        there = session.scalars(alive.order_by(Image.name)).all()
        if not there:
            raise Conflict("the dataset has no images", hint="add images first")
        return list(there)
    asked = set(image_ids)
    names: dict[int, str] = {}
    for batch in in_batches(sorted(asked)):
        names.update(session.execute(alive.add_columns(Image.name).where(Image.id.in_(batch))).all())
    unknown = sorted(asked.difference(names))
    if unknown or not asked:
        raise InvalidInput(
            f"image {unknown[0]} isn't in this dataset" if unknown else "no image is named",
            where="image_ids",
            expected="ids of images of the dataset",
            details={"images": unknown[:100]},
        )
    return sorted(names, key=lambda image_id: names[image_id])


def refuse_busy_images(session: Session, dataset: Dataset, wanted: set[int]) -> None:
    """Refuse images that another run hasn't finished with: two results would overtake each other.

    Raises:
        Conflict: When there are any.
    """
    unfinished = select(Run.id).where(
        Run.dataset_id == dataset.id, Run.status.in_(UNFINISHED), Run.deleted_at.is_(None)
    )
    busy: set[int] = set()
    for batch in in_batches(sorted(wanted)):
        of_these = select(RunImage.run_id).where(RunImage.run_id.in_(unfinished), RunImage.image_id.in_(batch))
        busy.update(session.scalars(of_these.distinct()))
    if busy:
        raise Conflict(
            f"run {min(busy)} is at work on these images",
            hint="wait until it is done, or cancel it",
            details={"runs": sorted(busy)},
        )
