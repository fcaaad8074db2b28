"""All tables.

Integer keys inside, slugs and sha256 outside. Rows that can be deleted carry ``deleted_at``: they are hidden at once
and purged after the grace period, until when the deletion can be undone. Times are UTC.
"""

from app.db.models.accounts import INVITATION_KINDS, ROLES, Identity, Invitation, Token, User, WebSession
from app.db.models.base import NEVER_REUSED, Base, Name, UtcDateTime, alive_unique, one_of
from app.db.models.calibrations import CALIBRATION_SOURCES, Calibration
from app.db.models.datasets import Blob, Camera, Dataset, Image, Installation
from app.db.models.labelling import (
    DECISION_KINDS,
    ORIGINS,
    RECALLS,
    REVIEW_STATES,
    Decision,
    Event,
    Review,
    Segment,
    SegmentState,
)
from app.db.models.review import (
    EDIT_KINDS,
    SECOND_DECISION_KINDS,
    SECOND_REVIEW_STATES,
    Adjudication,
    Edit,
    ImageFeatures,
    Lease,
    SecondDecision,
    SecondReview,
    SuggestionModel,
    SuggestionTraining,
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
from app.db.models.tallies import ImagePerson, ImageTally, RunTally

__all__ = [
    "CALIBRATION_SOURCES",
    "DECISION_KINDS",
    "EDIT_KINDS",
    "FINAL_STATES",
    "INVITATION_KINDS",
    "METHOD_KINDS",
    "NEVER_REUSED",
    "ORIGINS",
    "RECALLS",
    "REVIEW_STATES",
    "ROLES",
    "SCORE_STATES",
    "SECOND_DECISION_KINDS",
    "SECOND_REVIEW_STATES",
    "SPLIT_VISIBILITIES",
    "SUBMISSION_STATES",
    "SUBMISSION_VISIBILITIES",
    "WORK_STATES",
    "Adjudication",
    "Base",
    "Blob",
    "Calibration",
    "Camera",
    "CameraEstimate",
    "Dataset",
    "Decision",
    "Edit",
    "Event",
    "Identity",
    "Image",
    "ImageFeatures",
    "ImagePerson",
    "ImageScore",
    "ImageTally",
    "Installation",
    "Invitation",
    "Lease",
    "Method",
    "Name",
    "Review",
    "Run",
    "RunImage",
    "RunTally",
    "Score",
    "SecondDecision",
    "SecondReview",
    "Segment",
    "SegmentState",
    "Split",
    "SplitImage",
    "SplitVersion",
    "Submission",
    "SuggestionModel",
    "SuggestionTraining",
    "Token",
    "User",
    "UtcDateTime",
    "WebSession",
    "alive_unique",
    "one_of",
]
