"""Candidates of an image and the decisions on them."""

from __future__ import annotations

from datetime import datetime
from typing import Literal
from uuid import UUID

from pydantic import ConfigDict, Field

from app.api.schemas.base import Answer, Given, Origin, ReviewState, RowId, Verdict, VerdictCounts


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
    origin: Origin
    box: tuple[float, float, float, float] = Field(description="x0, y0, x1, y1 in px.")


class SegmentsAnswer(Answer):
    """An image's current candidates, in the order of ``/points``."""

    image_id: int
    revision: int
    width: int
    height: int
    segments: list[SegmentAnswer]


class DecisionGiven(Given):
    """One verdict on one segment. What one key press does shares a ``group_id``."""

    client_id: UUID = Field(description="Made by the client; sending the same one again changes nothing.")
    group_id: UUID
    segment_id: RowId
    verdict: Verdict
    kind: Literal["judge", "undo", "redo"] = "judge"
    target_group_id: UUID | None = Field(None, description="The group that an undo or redo is about.")
    elapsed_ms: int | None = Field(None, ge=0, le=86_400_000, description="How long the person took.")


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


class DecisionsStored(Answer):
    """What became of the decisions."""

    stored: int
    repeated: int = Field(description="Known already by their client_id.")
    verdicts: VerdictCounts
    status: ReviewState


class DecisionAnswer(Answer):
    """One row of an image's history."""

    id: int
    segment_id: int
    verdict: Verdict
    previous: Verdict
    kind: Literal["judge", "undo", "redo", "carry", "import"]
    client_id: str
    group_id: str
    target_group_id: str | None
    elapsed_ms: int | None
    person: str | None
    created_at: datetime


class History(Answer):
    """All decisions on an image, oldest first."""

    decisions: list[DecisionAnswer]


class ReviewGiven(Given):
    """How far the people are with an image."""

    model_config = ConfigDict(json_schema_extra={"example": {"status": "done"}})

    status: ReviewState
    reason: str | None = Field(None, max_length=2000)
    allow_undecided: bool = Field(False, description="Done although candidates are left undecided.")


class ReviewAnswer(Answer):
    """An image's review."""

    image_id: int
    status: ReviewState
    reason: str | None
    updated_at: datetime
