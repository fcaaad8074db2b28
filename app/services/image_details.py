"""One image with its neighbours in the dataset, its lens and its run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from datetime import datetime
from typing import Any

from sqlalchemy import Select, func, select
from sqlalchemy.orm import Session

from app.db.models import Dataset, Image, ImageTally, RunImage
from app.services.image_lens import lens_fields
from app.services.image_summaries import ImageSummary, image_summary
from app.services.leases import is_held_by_another
from app.services.run_briefs import RunBrief, run_briefs
from app.services.tallies import image_count


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
    still_open = ids.where(Image.review_status == "open", Image.id != image.id)
    tasks = [still_open]
    if person is not None:
        still_open = still_open.where(~is_held_by_another(person, now))
        # one by one, each through the index: together they would be found among all that is others' task
        tasks = [still_open.where(Image.assignee.is_(None)), still_open.where(Image.assignee == person)]
    after, before = Image.name > image.name, Image.name < image.name
    # the first one after it, else the first of all
    next_open = _first(session, [task.where(after) for task in tasks])
    if next_open is None:
        next_open = _first(session, [task.where(before) for task in tasks])
    here = (ImageTally.dataset_id == image.dataset_id) & ImageTally.deleted.is_(False)
    return Neighbours(
        previous_id=session.scalar(ids.where(before).order_by(backwards).limit(1)),
        next_id=session.scalar(ids.where(after).order_by(forwards).limit(1)),
        next_open_id=next_open,
        position=session.scalar(select(func.count()).select_from(Image).where(alive, Image.name <= image.name)) or 0,
        total=image_count(session, here),
    )


def _first(session: Session, queries: Sequence[Select[int]]) -> int | None:
    """Return the image whose name is the first of all that the queries select."""
    by_name = [query.with_only_columns(Image.name, Image.id).order_by(Image.name).limit(1) for query in queries]
    found = [row for query in by_name for row in session.execute(query)]
    return min(found, key=lambda row: row.name).id if found else None
