"""What a worker does for submissions: read what a stranger uploaded, score images, add them up. All of it bounded."""

from __future__ import annotations

import io
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from app.evaluation.submission_scoring import ImageRecord, ScoredImage, score_cameras, score_part, score_totals
from app.formats.submission_files import ExpectedImage, canonical_form, content_hash, read_submission
from app.formats.submission_limits import SubmissionLimits
from app.jobs.limits import TaskLimits, bounded
from app.jobs.tasks import errors_that_travel


@dataclass(frozen=True)
class Validated:
    """What an upload holds.

    Attributes:
        content: npz for all images, the canonical form.
        submission_hash: SHA-256 of names, points and scores.
        images: Images that it has a file for.
        missing: Names of the others.
        left_out: Path and reason of each file that wasn't read.
        warnings: What is allowed but may not be meant.
    """

    content: bytes
    submission_hash: str
    images: int
    segments: int
    points: int
    has_scores: bool
    missing: tuple[str, ...]
    left_out: tuple[tuple[str, str], ...]
    warnings: tuple[str, ...]


def validate_task(
    upload: bytes, name: str, images: Sequence[ExpectedImage], limits: SubmissionLimits, task: TaskLimits
) -> Validated:
    """Read an upload and check everything in it.

    Args:
        upload: The file.
        name: Its name; the ending says what it is.
        images: The split's.
        limits: How much it may hold.
        task: How long and with how much memory.

    Raises:
        InvalidSubmission: With everything that is wrong.
        TooLarge: When it takes too long, or too much memory.
    """
    with errors_that_travel(name, "the validation"), bounded(task, "reading the upload"):
        content = read_submission(name, io.BytesIO(upload), len(upload), images, limits)
        return Validated(
            canonical_form(content),
            content_hash(content),
            len(content.segments),
            content.n_segments,
            content.n_points,
            content.has_scores,
            content.missing,
            tuple((file.file, file.reason) for file in content.left_out),
            content.warnings,
        )


def score_task(images: Sequence[ScoredImage], min_length: float, task: TaskLimits) -> list[ImageRecord]:
    """Score some images of a submission under all protocols.

    Args:
        images: Truth and predictions of each.
        min_length: Of the split, px.
        task: How long and with how much memory.

    Raises:
        TooLarge: When it takes too long, or too much memory.
    """
    names = f"{images[0].info.name} and {len(images) - 1} more"
    with errors_that_travel(names, "the scoring"), bounded(task, "scoring these images"):
        return score_part(images, min_length)


def total_task(images: Sequence[ScoredImage], records: Sequence[ImageRecord], task: TaskLimits) -> dict[str, Any]:
    """Add up the images of a submission: every metric with its interval, strata, error types, cameras.

    Args:
        images: All images of the split, in its order.
        records: Their records.
        task: How long and with how much memory.

    Raises:
        TooLarge: When it takes too long, or too much memory.
    """
    with errors_that_travel("totals", "the scoring"), bounded(task, "adding up the images"):
        return score_totals([image.info for image in images], records, score_cameras(images))
