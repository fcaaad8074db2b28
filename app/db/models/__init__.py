"""All tables.

Integer keys inside, slugs and sha256 outside. Rows that can be deleted carry ``deleted_at``: they are hidden at once
and purged after the grace period, until when the deletion can be undone. Times are UTC.
"""

from app.db.models.base import NEVER_REUSED, Base, Name, UtcDateTime, alive_unique, one_of
from app.db.models.datasets import Blob, Camera, Dataset, Image, Installation
from app.db.models.labelling import (
    DECISION_KINDS,
    ORIGINS,
    REVIEW_STATES,
    VERDICTS,
    Decision,
    Event,
    Review,
    Segment,
    SegmentState,
)
from app.db.models.runs import WORK_STATES, CameraEstimate, Run, RunImage
from app.db.models.splits import SPLIT_VISIBILITIES, Split, SplitImage, SplitVersion
from app.db.models.submissions import (
    FINAL_STATES,
    METHOD_KINDS,
    SCORE_STATES,
    SUBMISSION_STATES,
    SUBMISSION_VISIBILITIES,
    ImageScore,
    Method,
    Score,
    Submission,
)
from app.db.models.tokens import ROLES, Token

__all__ = [
    "DECISION_KINDS",
    "FINAL_STATES",
    "METHOD_KINDS",
    "NEVER_REUSED",
    "ORIGINS",
    "REVIEW_STATES",
    "ROLES",
    "SCORE_STATES",
    "SPLIT_VISIBILITIES",
    "SUBMISSION_STATES",
    "SUBMISSION_VISIBILITIES",
    "VERDICTS",
    "WORK_STATES",
    "Base",
    "Blob",
    "Camera",
    "CameraEstimate",
    "Dataset",
    "Decision",
    "Event",
    "Image",
    "ImageScore",
    "Installation",
    "Method",
    "Name",
    "Review",
    "Run",
    "RunImage",
    "Score",
    "Segment",
    "SegmentState",
    "Split",
    "SplitImage",
    "SplitVersion",
    "Submission",
    "Token",
    "UtcDateTime",
    "alive_unique",
    "one_of",
]
