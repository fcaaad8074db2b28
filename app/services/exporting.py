"""Export a dataset's labels, with or without its images, for ClearLines and other tools."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import BinaryIO

import numpy as np
from sqlalchemy import Row, select
from sqlalchemy.orm import Session

from app.db.models import Camera, Dataset, Image, Review, Segment
from app.errors import Conflict, InvalidInput
from app.formats.exports import EXPORTS
from app.formats.labelled import LabelledSegments
from app.formats.labelled_image import LabelledImage
from app.formats.members import stream_zip
from app.services.batches import in_batches
from app.services.camera_references import reference_camera
from app.services.candidates import current_segments, verdict_of_segment
from app.services.datasets import get_dataset
from app.services.images import NAMES_SHOWN
from app.storage import BlobStore
from app.vision.segments import Segments

IMAGES_AT_ONCE = 20
POINT = np.dtype("<f4")

# COCO has no word for "do not score": its readers would take an ambiguous segment for a label
WITHOUT_VERDICT = ("coco",)


class ImagesNotDone(Conflict):
    """Images that nobody has finished would be exported."""

    code = "images-not-done"


@dataclass(frozen=True)
class ExportChoice:
    """What to export.

    Attributes:
        format: One of ``app.formats.exports.EXPORTS``.
        allow_not_done: Export images too that are still open, with the labels that they have so far.
        with_images: Put the image files in.
    """

    format: str = "clearlines"
    allow_not_done: bool = False
    with_images: bool = True


def export_members(
    session: Session, blobs: BlobStore, slug: str, choice: ExportChoice | None = None
) -> Iterator[tuple[str, bytes]]:
    """Return path and content of each file of an export; discarded images are left out.

    Kept segments are the labels; ambiguous ones lie beside them or say what they are, where the format can.

    Args:
        session: Any session; it must live until the last member is taken.
        blobs: Where the image files are.
        slug: Of the dataset.
        choice: What to export.

    Raises:
        NotFound: When there is no such dataset.
        InvalidInput: When the format isn't known, or there is nothing to export.
        ImagesNotDone: Naming the images that are still open, unless told otherwise.
    """
    choice = choice or ExportChoice()
    exporter = EXPORTS.get(choice.format)
    if exporter is None:
        raise InvalidInput(f"there is no format {choice.format!r:.60}", where="format", expected=", ".join(EXPORTS))
    dataset = get_dataset(session, slug)
    statuses = _statuses(session, dataset)
    if not choice.allow_not_done:
        _require_done(statuses)
    chosen = [image_id for image_id, _, status in statuses if status != "discarded"]
    if not chosen:
        raise InvalidInput(
            f"{dataset.name} has no image to export", where=slug, expected="an image that isn't discarded"
        )
    verdicts = ("keep",) if choice.format in WITHOUT_VERDICT else ("keep", "ambiguous")
    return exporter(_labelled_images(session, blobs if choice.with_images else None, chosen, verdicts))


def write_export(
    session: Session, blobs: BlobStore, slug: str, target: BinaryIO, choice: ExportChoice | None = None
) -> int:
    """Write an export as a zip and return its size in bytes; arguments and errors as `export_members`."""
    size = 0
    for piece in stream_zip(export_members(session, blobs, slug, choice)):
        target.write(piece)
        size += len(piece)
    return size


def _statuses(session: Session, dataset: Dataset) -> Sequence[Row[int, str, str]]:
    """Return id, name and review status of the dataset's images by name."""
    return session.execute(
        select(Image.id, Image.name, Review.status)
        .join(Review, Review.image_id == Image.id)
        .where(Image.dataset_id == dataset.id, Image.deleted_at.is_(None))
        .order_by(Image.name)
    ).all()


def _require_done(statuses: Sequence[Row[int, str, str]]) -> None:
    still_open = [name for _, name, status in statuses if status == "open"]
    if still_open:
        shown = ", ".join(still_open[:NAMES_SHOWN]) + (" ..." if len(still_open) > NAMES_SHOWN else "")
        number = "1 image isn't" if len(still_open) == 1 else f"{len(still_open)} images aren't"
        raise ImagesNotDone(
            f"{number} done: {shown}",
            hint="finish or discard them, or allow images that aren't done",
            details={"images": still_open},
        )


def _labelled_images(
    session: Session, blobs: BlobStore | None, ids: Sequence[int], verdicts: tuple[str, ...]
) -> Iterator[LabelledImage]:
    for batch in in_batches(ids, IMAGES_AT_ONCE):
        segments = _segments_by_image(session, batch, verdicts)
        rows = session.execute(select(Image, Camera).join(Image.camera).where(Image.id.in_(batch)).order_by(Image.name))
        for image, camera in rows:
            yield LabelledImage(
                name=image.name,
                file_name=image.file_name,
                width=image.width,
                height=image.height,
                labelled=_labelled(segments.get(image.id, [])),
                camera=camera.name,
                source=image.source or "",
                sequence=image.sequence or "",
                reference=reference_camera(camera),
                content=partial(blobs.read, image.sha256) if blobs else None,
            )
        session.expunge_all()  # else all images of a long export would stay in memory


def _segments_by_image(session: Session, ids: Sequence[int], verdicts: tuple[str, ...]) -> dict[int, list[Row]]:
    verdict = verdict_of_segment()
    columns = (Segment.image_id, Segment.id, Segment.points, Segment.score, Segment.straightness, Segment.origin)
    query = current_segments(*columns, verdict.label("verdict")).where(Segment.image_id.in_(ids), verdict.in_(verdicts))
    by_image: dict[int, list[Row]] = {}
    for row in session.execute(query):
        by_image.setdefault(row.image_id, []).append(row)
    return by_image


def _labelled(rows: Sequence[Row]) -> LabelledSegments:
    scores = np.array([row.score for row in rows], dtype=np.float64)
    straightness = np.array([row.straightness for row in rows], dtype=np.float64)
    return LabelledSegments(
        # scores and straightness are known for all segments of an image, or left out
        Segments.from_list(
            [np.frombuffer(row.points, POINT).reshape(-1, 2) for row in rows],
            None if np.isnan(scores).any() else scores,
        ),
        None if np.isnan(straightness).any() else straightness.astype(np.float32),
        tuple(row.verdict for row in rows),
        tuple(row.origin for row in rows),
        tuple(str(row.id) for row in rows),
    )
