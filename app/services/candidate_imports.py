"""Predictions of any detector become candidates: undecided, each once, and none where a candidate is already."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime

import numpy as np
from numpy.typing import NDArray
from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.db.models import Dataset, Image, Review, Segment
from app.db.session import Database
from app.evaluation.matching import match_segments
from app.formats.labelled import LabelledSegments
from app.formats.submission_files import ExpectedImage
from app.services.candidates import current_segments, refresh_counts
from app.services.carrying import stored_polyline
from app.services.events import record_event
from app.services.labels import POINT, segment_rows
from app.vision.segments import Segments


@dataclass(frozen=True)
class CandidateImport:
    """What became of predictions.

    Attributes:
        images: Images that there were predictions for.
        added: New candidates.
        duplicates: Predictions that weren't taken: the image has a candidate there, or had this very one.
        reopened: Images that were done and wait for verdicts again.
    """

    images: int
    added: int
    duplicates: int
    reopened: int


@dataclass(frozen=True)
class _NewOnes:
    """Predictions of an image that aren't there yet: their indices, at a revision of the image."""

    revision: int
    indices: NDArray[np.int64]


def images_to_predict(session: Session, dataset: Dataset) -> list[ExpectedImage]:
    """Return names and sizes of a dataset's images, by name."""
    rows = session.execute(
        select(Image.name, Image.width, Image.height)
        .where(Image.dataset_id == dataset.id, Image.deleted_at.is_(None))
        .order_by(Image.name)
    )
    return [ExpectedImage(*row) for row in rows]


def import_candidates(
    database: Database,
    dataset_id: int,
    predictions: Mapping[str, LabelledSegments],
    origin: str,
    now: datetime,
    *,
    person: str | None = None,
) -> CandidateImport:
    """Store predictions as candidates of origin ``import``, image by image.

    A prediction that matches a current candidate (line IoU of at least 0.5, one to one) is left out, and so is one
    whose very points were imported before: the same import again changes nothing.

    Args:
        database: Where they go.
        dataset_id: The dataset.
        predictions: By image name, checked.
        origin: Name of the file, for the audit.
        now: When.
        person: Who imports.
    """
    added = duplicates = reopened = 0
    for name, predicted in predictions.items():
        with database.read() as session:
            image = _image_of(session, dataset_id, name)
            new = None if image is None else _new_ones(session, image, predicted.segments)
        with database.write() as session:
            image = _image_of(session, dataset_id, name, lock=True)
            if image is None:  # deleted since the names were compared
                continue
            if new is None or new.revision != image.revision:
                new = _new_ones(session, image, predicted.segments)
            reopened += _store(session, image, predicted.select(new.indices), now)
        added += len(new.indices)
        duplicates += len(predicted) - len(new.indices)
    report = CandidateImport(len(predictions), added, duplicates, reopened)
    if added:
        with database.write() as session:
            details = {"from": origin, "images": report.images, "added": added, "duplicates": duplicates}
            record_event(session, "candidates.imported", now, dataset_id=dataset_id, person=person, details=details)
    return report


def _image_of(session: Session, dataset_id: int, name: str, *, lock: bool = False) -> Image | None:
    query = select(Image).where(Image.dataset_id == dataset_id, Image.name == name, Image.deleted_at.is_(None))
    return session.scalars(query.with_for_update() if lock else query).one_or_none()


def _new_ones(session: Session, image: Image, predicted: Segments) -> _NewOnes:
    imported = set(
        session.scalars(select(Segment.points).where(Segment.image_id == image.id, Segment.origin == "import"))
    )
    fresh: list[int] = []
    for index, polyline in enumerate(predicted):
        content = polyline.astype(POINT).tobytes()
        if content not in imported:
            fresh.append(index)
            imported.add(content)
    stored = session.scalars(current_segments(Segment.points).where(Segment.image_id == image.id))
    current = Segments.from_list([stored_polyline(points) for points in stored])
    indices = np.array(fresh, np.int64)
    there = match_segments(current, predicted.select(indices)).column
    return _NewOnes(image.revision, np.delete(indices, there))


def _store(session: Session, image: Image, predicted: LabelledSegments, now: datetime) -> bool:
    """Store candidates; return whether the image was done and is open again."""
    if not len(predicted):
        return False
    last = session.scalar(
        select(func.max(Segment.ordinal)).where(Segment.image_id == image.id, Segment.origin == "import")
    )
    session.add_all(segment_rows(image.id, predicted, first_ordinal=0 if last is None else last + 1))
    image.revision += 1
    refresh_counts(session, [image.id])
    review = session.get(Review, image.id) or Review(image_id=image.id, status="open", updated_at=now)
    session.add(review)
    if review.status != "done":
        return False
    review.status, review.updated_at = "open", now
    return True
