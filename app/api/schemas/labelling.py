"""Candidates of an image and the decisions on them."""

from __future__ import annotations

from datetime import datetime
from typing import Literal
from uuid import UUID

from pydantic import ConfigDict, Field

from app.api.schemas.base import Answer, Given, Origin, Recall, RejectReason, ReviewState, RowId, Verdict, VerdictCounts


class SegmentAnswer(Answer):
    """A candidate without its points, which ``/points`` gives in one binary answer."""

    id: int
    ordinal: int
    n_points: int
    length: float = Field(description="Arc length, px.")
    residual: float | None = Field(description="RMS deviation from straight after undistortion, px.")
    score: float | None = Field(description="Evidence for an edge, 0 to 1.")
    straightness: float | None = Field(description="Probability of being straight under the lens, 0 to 1.")
    straight: bool = Field(description="Whether it passes the straightness filter.")
    verdict: Verdict
    reason: RejectReason | None = Field(description="Why it was rejected, where that was said.")
    origin: Origin
    box: tuple[float, float, float, float] = Field(description="x0, y0, x1, y1 in px.")


class SegmentsAnswer(Answer):
    """An image's current candidates, in the order of ``/points``."""

    image_id: int
    revision: int
    last_decision_id: int = Field(description="The last decision that these verdicts follow; send it as `seen`.")
    width: int
    height: int
    segments: list[SegmentAnswer]


class DecisionGiven(Given):
    """One verdict on one segment. What one key press does shares a ``group_id``."""

    client_id: UUID = Field(description="Made by the client; sending the same one again changes nothing.")
    group_id: UUID
    segment_id: RowId
    verdict: Verdict
    kind: Literal["judge", "accept", "take_over", "undo", "redo"] = Field(
        "judge", description="accept: of a suggestion; take_over: from a neighbouring frame of the sequence."
    )
    target_group_id: UUID | None = Field(None, description="The group that an undo or redo is about.")
    elapsed_ms: int | None = Field(
        None, ge=0, le=86_400_000, description="How long the key press took; with one of its group."
    )
    reason: RejectReason | None = Field(None, description="Why it is rejected; for no other verdict.")
    suggestion: float | None = Field(None, ge=0, le=1, description="The probability of keep that the person saw.")


class DecisionsGiven(Given):
    """Decisions on segments of one image, stored together or not at all."""

    model_config = ConfigDict(
        json_schema_extra={
            "example": {
                "decisions": [
                    {
                        "client_id": "4b0f0c5e-6d8c-4f6e-9d4e-1f7f2f0a6a01",
                        "group_id": "7a0a2c1e-58b8-4d39-8f0e-0d5a1c4a9b11",
                        "segment_id": 17,
                        "verdict": "keep",
                        "elapsed_ms": 640,
                    }
                ]
            }
        }
    )

    decisions: list[DecisionGiven] = Field(min_length=1, max_length=5000)
    seen: int | None = Field(
        None, ge=0, le=2**31 - 1, description="The last decision that you knew: later ones of others aren't overruled."
    )


class OtherVerdict(Answer):
    """A verdict that another person gave meanwhile."""

    segment_id: int
    verdict: Verdict
    reason: RejectReason | None
    person: str | None
    created_at: datetime
    decision_id: int


class DecisionsStored(Answer):
    """What became of the decisions."""

    stored: int
    repeated: int = Field(description="Known already by their client_id.")
    verdicts: VerdictCounts
    status: ReviewState
    last_decision_id: int = Field(description="Send it as `seen` once you know `others`.")
    others: list[OtherVerdict] = Field(description="Verdicts that others gave after what you had seen.")


class DecisionAnswer(Answer):
    """One row of an image's history."""

    id: int
    segment_id: int
    verdict: Verdict
    previous: Verdict
    kind: Literal["judge", "undo", "redo", "carry", "import", "accept", "take_over"]
    client_id: str
    group_id: str
    target_group_id: str | None
    elapsed_ms: int | None
    reason: RejectReason | None
    suggestion: float | None
    person: str | None
    created_at: datetime


class History(Answer):
    """All decisions on an image, oldest first."""

    decisions: list[DecisionAnswer]


class NeighbourVerdict(Answer):
    """What was decided on the same edge in the frame before or after."""

    segment_id: int = Field(description="Of the image that was asked for.")
    verdict: Verdict
    reason: RejectReason | None
    from_image_id: int


class ReviewGiven(Given):
    """How far the people are with an image."""

    model_config = ConfigDict(json_schema_extra={"example": {"status": "done"}})

    status: ReviewState
    reason: str | None = Field(None, max_length=2000)
    allow_undecided: bool = Field(False, description="Done although candidates are left undecided.")
    recall: Recall | None = Field(None, description="How much of what is straight the labels hold; with `done`.")


class ReviewAnswer(Answer):
    """An image's review."""

    image_id: int
    status: ReviewState
    reason: str | None
    recall: Recall | None
    updated_at: datetime
