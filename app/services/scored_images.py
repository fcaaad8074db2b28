"""One image of a submission, segment by segment: what became of each, its points, its picture."""

from __future__ import annotations

import struct
from dataclasses import dataclass

import cv2
import numpy as np
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import Image, ImageScore, Score, Split, SplitImage, SplitVersion, Submission
from app.errors import NotFound
from app.evaluation.clearlines_v2 import PROTOCOL
from app.evaluation.error_types import ErrorType
from app.evaluation.ground_truth import GroundTruth
from app.evaluation.image_record import ImageRecord
from app.evaluation.outcome import Outcome, Outcomes
from app.evaluation.overlay import draw_overlay
from app.evaluation.rejected_lines import reason_name
from app.images.decode import decode_display
from app.services.labelling import POINTS_MAGIC
from app.services.scoring_inputs import predictions_of
from app.services.segment_sets import SegmentSets
from app.services.truths import ground_truths
from app.storage import BlobStore
from app.vision.segments import Segments


@dataclass(frozen=True, eq=False)
class ScoredSegments:
    """Truth, predictions and record of one image."""

    image: SplitImage
    numbers: ImageScore
    record: ImageRecord
    truth: GroundTruth
    predictions: Segments

    @property
    def protocol(self) -> str:
        """Name of the protocol of the outcomes."""
        return PROTOCOL

    @property
    def precision(self) -> float:
        """Precision of the image."""
        return self.numbers.precision or 0.0

    @property
    def recall(self) -> float | None:
        """Recall of the image."""
        return self.numbers.recall

    @property
    def outcomes(self) -> Outcomes:
        """What became of each prediction and label."""
        return self.record.outcomes


@dataclass(frozen=True)
class LabelEntry:
    """What became of a label; its length is px."""

    index: int
    outcome: str
    length: float
    ignored: bool
    error_type: str | None


@dataclass(frozen=True)
class PredictionEntry:
    """What became of a prediction.

    Offset (px) and angle (rad) are those of true positives. ``rejected_as`` is the reason for which people rejected
    the line that a false positive is.
    """

    index: int
    outcome: str
    score: float | None
    length: float
    best_label: int | None
    liou: float
    offset: float | None
    angle: float | None
    error_type: str | None
    rejected_as: str | None


def scored_segments(
    session: Session, sets: SegmentSets, submission: Submission, score: Score, split_image_id: int
) -> ScoredSegments:
    """Return truth, predictions and record of one image of a score.

    Raises:
        NotFound: When the score has no such image.
    """
    row = session.execute(
        select(SplitImage, ImageScore)
        .join(ImageScore, ImageScore.split_image_id == SplitImage.id)
        .where(ImageScore.score_id == score.id, SplitImage.id == split_image_id)
    ).one_or_none()
    if row is None:
        raise NotFound(f"the submission has no image {split_image_id}")
    image, numbers = row
    version = session.get_one(SplitVersion, score.split_version_id)
    min_length = session.get_one(Split, version.split_id).min_length
    labelled = sets.read(version.truth_sha256)[image.name]
    truth = ground_truths({image.name: labelled}, min_length)[image.name]
    predictions = predictions_of(sets.read(submission.segments_sha256 or ""), image.name)
    return ScoredSegments(image, numbers, ImageRecord.from_npz(numbers.record or b""), truth, predictions)


def label_entries(scored: ScoredSegments) -> list[LabelEntry]:
    """Return what became of each label."""
    record, lengths = scored.record, scored.truth.segments.lengths()
    return [
        LabelEntry(
            index,
            Outcome(outcome).name.lower(),
            round(length, 2),
            ignored,
            error_name(error),
        )
        for index, (outcome, length, ignored, error) in enumerate(
            zip(
                record.label_outcomes.tolist(),
                lengths.tolist(),
                scored.truth.ignored.tolist(),
                record.label_errors.tolist(),
                strict=True,
            )
        )
    ]


def prediction_entries(scored: ScoredSegments) -> list[PredictionEntry]:
    """Return what became of each prediction."""
    record, predictions = scored.record, scored.predictions
    scores = [None] * len(predictions) if predictions.scores is None else predictions.scores.tolist()
    columns = zip(
        record.prediction_outcomes.tolist(),
        scores,
        predictions.lengths().tolist(),
        record.best_label.tolist(),
        record.liou.tolist(),
        record.offset.tolist(),
        record.angle.tolist(),
        record.prediction_errors.tolist(),
        record.prediction_reasons.tolist(),
        strict=True,
    )
    return [
        PredictionEntry(
            index=index,
            outcome=Outcome(outcome).name.lower(),
            score=score,
            length=round(length, 2),
            best_label=None if label < 0 else label,
            liou=liou,
            offset=None if np.isnan(offset) else offset,
            angle=None if np.isnan(angle) else angle,
            error_type=error_name(error),
            rejected_as=reason_name(reason),
        )
        for index, (outcome, score, length, label, liou, offset, angle, error, reason) in enumerate(columns)
    ]


def points_of(scored: ScoredSegments) -> bytes:
    """Return the points of labels (ids 0 to L - 1) and predictions (L to L + P - 1), as the label page reads them.

    Little endian: ``CLP1``, then uint32 0, S and N, S uint32 ids, S + 1 uint32 offsets, N pairs of float32 x, y in px.
    """
    labels, predictions = scored.truth.segments, scored.predictions
    offsets = np.concatenate([labels.offsets, labels.offsets[-1] + predictions.offsets[1:]]).astype("<u4")
    ids = np.arange(len(offsets) - 1, dtype="<u4")
    header = struct.pack("<4sIII", POINTS_MAGIC, 0, len(ids), int(offsets[-1]))
    points = (labels.points.astype("<f4").tobytes(), predictions.points.astype("<f4").tobytes())
    return b"".join([header, ids.tobytes(), offsets.tobytes(), *points])


def overlay_of(scored: ScoredSegments, blobs: BlobStore, *, max_pixels: int) -> bytes:
    """Return a PNG of the image with hits, false alarms and misses in the paper's colours, and a legend.

    Raises:
        NotFound: When the image's file is gone.
        InvalidImage: When it can't be decoded.
    """
    pixels = decode_display(blobs.read(scored.image.image_sha256), max_pixels=max_pixels)
    picture = draw_overlay(pixels, scored.truth.segments, scored.predictions, scored)
    return cv2.imencode(".png", picture)[1].tobytes()


def review_target(session: Session, image: SplitImage) -> int | None:
    """Return the dataset's image that false positives can be sent to; ``None`` when it is gone or has changed."""
    if image.image_id is None:
        return None
    found = session.get(Image, image.image_id)
    there = found is not None and found.deleted_at is None and found.sha256 == image.image_sha256
    return image.image_id if there else None


def error_name(error: int) -> str | None:
    """Return the type of an error in words; ``None`` where there is none."""
    return None if error == ErrorType.NONE else ErrorType(error).name.lower()
