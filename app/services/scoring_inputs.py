"""What scoring takes: truth and predictions of images, and the records of those that are scored."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from sqlalchemy import select
from sqlalchemy.orm import Session, undefer

from app.db.models import ImageScore, SplitImage
from app.errors import NotFound
from app.evaluation.rejected_lines import RejectedLines
from app.evaluation.submission_scoring import ImageRecord, ScoredImage, SplitImageInfo
from app.formats.labelled import LabelledSegments
from app.services.batches import in_batches
from app.services.truths import ground_truths
from app.vision.segments import Segments

SegmentSet = Mapping[str, LabelledSegments]


def info_of(image: SplitImage) -> SplitImageInfo:
    """Return what scoring knows of an image, its labels aside."""
    return SplitImageInfo(
        image.name, image.width, image.height, image.source, image.sequence, image.camera, image.reference
    )


def predictions_of(segments: SegmentSet, name: str) -> Segments:
    """Return what was submitted for an image; an image without a file counts as empty."""
    return segments[name].segments if name in segments else Segments.empty()


def rejected_of(image: SplitImage) -> RejectedLines | None:
    """Return an image's candidates that were rejected with a reason, as they were frozen."""
    return None if image.rejected is None else RejectedLines.from_npz(image.rejected)


def images_to_score(
    session: Session, ids: Sequence[int], truth: SegmentSet, segments: SegmentSet, min_length: float
) -> list[ScoredImage]:
    """Return images with what is to be found and what was submitted.

    Args:
        session: Any session.
        ids: Split images, in the order wanted.
        truth: Labels by image name.
        segments: Predictions by image name.
        min_length: Of the split, px.

    Raises:
        NotFound: When an image isn't there any more.
    """
    rows: dict[int, SplitImage] = {}
    for batch in in_batches(ids):
        query = select(SplitImage).where(SplitImage.id.in_(batch)).options(undefer(SplitImage.rejected))
        rows |= {row.id: row for row in session.scalars(query)}
    if len(rows) < len(set(ids)):
        raise NotFound("an image of the split is gone")
    images = [rows[image_id] for image_id in ids]
    truths = ground_truths({image.name: truth[image.name] for image in images}, min_length)
    return [
        ScoredImage(info_of(image), truths[image.name], predictions_of(segments, image.name), rejected_of(image))
        for image in images
    ]


def recorded_images(session: Session, score_id: int) -> tuple[list[int], list[ImageRecord]]:
    """Return ids and records of a score's images, in the split's order."""
    rows = session.execute(
        select(ImageScore.split_image_id, ImageScore.record)
        .join(SplitImage, SplitImage.id == ImageScore.split_image_id)
        .where(ImageScore.score_id == score_id)
        .order_by(SplitImage.ordinal)
    ).all()
    return [row.split_image_id for row in rows], [ImageRecord.from_npz(row.record) for row in rows]
