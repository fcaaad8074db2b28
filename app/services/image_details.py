"""One image with its neighbours in the dataset, its lens and its run."""

from __future__ import annotations

from dataclasses import dataclass, fields
from datetime import datetime
from typing import Any

from sqlalchemy import func, or_, select
from sqlalchemy.orm import Session

from app.db.models import Dataset, Image, Review, RunImage
from app.services.image_lens import lens_fields
from app.services.image_summaries import ImageSummary, image_summary
from app.services.leases import is_held_by_another
from app.services.run_briefs import RunBrief, run_briefs


@dataclass(frozen=True)
class DatasetName:
    """Which dataset."""

    slug: str
    name: str


@dataclass(frozen=True)
class Neighbours:
    """Where an image stands among its dataset's images in the order of their names.

    Attributes:
        previous_id: The image before; ``None`` at the beginning.
        next_id: The image after; ``None`` at the end.
        next_open_id: The first open image after it, else the first open one from the beginning; never itself, nor one
            that is another person's task or that another person has open.
        position: From 1.
        total: Images of the dataset.
    """

    previous_id: int | None
    next_id: int | None
    next_open_id: int | None
    position: int
    total: int


@dataclass(frozen=True)
class ImageDetail(ImageSummary):
    """An image with all that the label page shows around it.

    Attributes:
        camera_estimate: Distortion that its candidates were judged under, else its camera's newest
            (``DistortionEstimate.as_dict``).
        run: The run that its current candidates come from.
        changes: What that run changed for the decisions made before.
    """

    dataset: DatasetName
    previous_id: int | None
    next_id: int | None
    next_open_id: int | None
    position: int
    total: int
    camera_estimate: dict[str, Any] | None
    run: RunBrief | None
    changes: dict[str, Any] | None


def image_detail(session: Session, image: Image, now: datetime, *, person: str | None = None) -> ImageDetail:
    """Return an image with its neighbours, lens and run.

    Args:
        session: Any session.
        image: The image.
        now: Time of the request.
        person: Who looks for the next image to review; without one nobody's tasks are passed over.
    """
    summary = image_summary(session, image)
    dataset = session.get_one(Dataset, image.dataset_id)
    beside = neighbours(session, image, now, person=person)
    work = session.get(RunImage, image.current_run_image_id) if image.current_run_image_id else None
    return ImageDetail(
        **{field.name: getattr(summary, field.name) for field in fields(summary)},
        dataset=DatasetName(dataset.slug, dataset.name),
        previous_id=beside.previous_id,
        next_id=beside.next_id,
        next_open_id=beside.next_open_id,
        position=beside.position,
        total=beside.total,
        camera_estimate=lens_fields(session, image, work),
        run=run_briefs(session, [work.run_id]).get(work.run_id) if work else None,
        changes=work.changes if work else None,
    )


def neighbours(session: Session, image: Image, now: datetime, *, person: str | None = None) -> Neighbours:
    """Return an image's place among the images of its dataset that aren't deleted."""
    alive = (Image.dataset_id == image.dataset_id) & Image.deleted_at.is_(None)
    ids = select(Image.id).where(alive)
    forwards, backwards = Image.name.asc(), Image.name.desc()
    still_open = ids.join(Review, Review.image_id == Image.id).where(Review.status == "open", Image.id != image.id)
    if person is not None:
        still_open = still_open.where(or_(Image.assignee.is_(None), Image.assignee == person))
        still_open = still_open.where(~is_held_by_another(person, now))
    after = Image.name > image.name
    return Neighbours(
        previous_id=session.scalar(ids.where(Image.name < image.name).order_by(backwards).limit(1)),
        next_id=session.scalar(ids.where(after).order_by(forwards).limit(1)),
        next_open_id=session.scalar(still_open.order_by(after.desc(), forwards).limit(1)),
        position=session.scalar(select(func.count(Image.id)).where(alive, Image.name <= image.name)) or 0,
        total=session.scalar(select(func.count(Image.id)).where(alive)) or 0,
    )
