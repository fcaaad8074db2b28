"""Candidates and labels of the images that people are done with."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from sqlalchemy import Select, select
from sqlalchemy.orm import Session

from app.db.models import Dataset, Image, Review, Segment
from app.services.candidates import current_segments, verdict_of_segment
from app.services.labels import POINT
from app.services.stored_candidates import imported_candidates, stored_candidates
from app.vision.segments import Segments

Find = Callable[[Image], Segments]


@dataclass(frozen=True)
class LabelledContent:
    """Candidates and labels of one image whose review is done.

    Attributes:
        candidates: All segments that the pipeline proposed; ``None`` where that isn't known, as of labels that were
            imported for an image that was never pre-labelled.
        kept: Kept segments, those that a person added included.
        ambiguous: Segments of which nobody can say.
    """

    name: str
    source: str | None
    candidates: Segments | None
    kept: Segments
    ambiguous: Segments


def images_done(dataset: Dataset) -> Select[Image]:
    """Select the images of a dataset whose review is done."""
    return (
        select(Image)
        .join(Review, Review.image_id == Image.id)
        .where(Image.dataset_id == dataset.id, Image.deleted_at.is_(None), Review.status == "done")
    )


def labelled_contents(
    session: Session, dataset: Dataset, find: Find | None = None, *, most: int | None = None
) -> list[LabelledContent]:
    """Return candidates and labels of the images whose review is done, by name.

    Args:
        session: Any session.
        dataset: The dataset.
        find: Detects the candidates of an image where they aren't known.
        most: At most so many images, spread evenly over all of them; all when left out.
    """
    ids = session.scalars(images_done(dataset).with_only_columns(Image.id).order_by(Image.name)).all()
    if most is not None and len(ids) > most:
        ids = [ids[int(place)] for place in np.linspace(0, len(ids) - 1, most)]
    images = session.scalars(select(Image).where(Image.id.in_(ids)).order_by(Image.name)).all()
    return [labelled_content(session, image, find) for image in images]


def labelled_content(session: Session, image: Image, find: Find | None = None) -> LabelledContent:
    """Return candidates and labels of an image; ``find`` as in `labelled_contents`."""
    rows = session.execute(
        current_segments(Segment.points, verdict_of_segment().label("verdict")).where(Segment.image_id == image.id)
    ).all()

    def judged(verdict: str) -> Segments:
        points: Sequence[bytes] = [row.points for row in rows if row.verdict == verdict]
        return Segments.from_list([np.frombuffer(each, POINT).reshape(-1, 2) for each in points])

    candidates = stored_candidates(session, image)
    if candidates is None:
        candidates = imported_candidates(session, image)
    if candidates is None and find is not None:
        candidates = find(image)
    return LabelledContent(image.name, image.source, candidates, judged("keep"), judged("ambiguous"))
