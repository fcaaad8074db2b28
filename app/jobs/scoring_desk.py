"""What the server needs for submissions beside the dispatcher: it checks uploads, and remembers what is asked often."""

from __future__ import annotations

from dataclasses import dataclass

from app.jobs.limits import TaskLimits
from app.jobs.validations import Validations
from app.services.boards import BoardCache
from app.services.segment_sets import SegmentSets
from app.services.submission_limits import submission_limits
from app.settings import Settings
from app.storage import BlobStore


@dataclass(frozen=True)
class ScoringDesk:
    """Made at the server's start, stopped at its end.

    Attributes:
        validations: Checks uploads.
        boards: Standings of boards.
        sets: Segments of truths and submissions.
    """

    validations: Validations
    boards: BoardCache
    sets: SegmentSets

    def stop(self) -> None:
        """End the worker."""
        self.validations.stop()


def scoring_desk(settings: Settings, blobs: BlobStore) -> ScoringDesk:
    """Return the desk of a server."""
    task = TaskLimits(settings.scoring_seconds, settings.scoring_megabytes)
    validations = Validations(submission_limits(settings), task, settings.validation_seconds)
    return ScoringDesk(validations, BoardCache(), SegmentSets(blobs))
