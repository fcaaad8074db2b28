"""Where work reads and writes, and the bounds that it keeps."""

from __future__ import annotations

from dataclasses import dataclass, field

from app.db.session import Database
from app.formats.submission_limits import SUBMISSION_LIMITS, SubmissionLimits
from app.jobs.limits import TASK_LIMITS, TaskLimits
from app.jobs.notes import NoteBoard
from app.services.segment_sets import SegmentSets
from app.storage import BlobStore


@dataclass(frozen=True)
class Stores:
    """Where work reads and writes.

    Attributes:
        database: The rows.
        blobs: The files.
        max_pixels: Greatest number of pixels that is decoded.
        notes: Between the dispatcher and the workers of long tasks.
        max_attempts: Tries of a submission.
        submission_limits: How much a submission may hold.
        task_limits: What one task for a submission may take.
        sets: Segments of submissions and truths, read once for all their images.
    """

    database: Database
    blobs: BlobStore
    max_pixels: int
    notes: NoteBoard
    max_attempts: int = 3
    submission_limits: SubmissionLimits = SUBMISSION_LIMITS
    task_limits: TaskLimits = TASK_LIMITS
    sets: SegmentSets = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "sets", SegmentSets(self.blobs))
