"""Second reviews."""

from __future__ import annotations

from datetime import datetime
from typing import Literal
from uuid import UUID

from pydantic import ConfigDict, Field

from app.api.schemas.base import Answer, Given, RowId, Verdict, VerdictCounts

SecondReviewState = Literal["open", "done"]


class DueImage(Answer):
    """An image that you can begin a second review of."""

    image_id: int
    name: str
    candidates: int


class SecondReviewAnswer(Answer):
    """A second review, and how far it is."""

    id: int
    image_id: int
    name: str
    person: str | None
    mine: bool
    status: SecondReviewState
    created_at: datetime
    done_at: datetime | None


class SecondReviewsAnswer(Answer):
    """The second reviews of a dataset, and what you can begin with."""

    share: float
    due: list[DueImage] = Field(description="By name; at most 1,000.")
    due_total: int
    reviews: list[SecondReviewAnswer] = Field(description="Your own first.")


class SecondSegment(Answer):
    """A candidate as if nobody had judged it but you in this review."""

    id: int
    n_points: int
    length: float = Field(description="Arc length, px.")
    residual: float | None
    score: float | None
    straightness: float | None
    straight: bool
    verdict: Verdict = Field(description="Yours, in this review.")
    box: tuple[float, float, float, float] = Field(description="x0, y0, x1, y1 in px.")


class SecondSegmentsAnswer(Answer):
    """An image's candidates in the order of ``/images/{image_id}/points``, without what a hand drew."""

    second_review_id: int
    image_id: int
    revision: int
    width: int
    height: int
    status: SecondReviewState
    segments: list[SecondSegment]


class SecondDecisionGiven(Given):
    """One verdict on one segment. What one key press does shares a ``group_id``."""

    client_id: UUID = Field(description="Made by the client; sending the same one again changes nothing.")
    group_id: UUID
    segment_id: RowId
    verdict: Verdict
    kind: Literal["judge", "undo", "redo"] = "judge"
    target_group_id: UUID | None = None
    elapsed_ms: int | None = Field(None, ge=0, le=86_400_000)

    @property
    def reason(self) -> None:
        """A second review asks for no reasons."""

    @property
    def suggestion(self) -> None:
        """A second review shows no suggestions."""


class SecondDecisionsGiven(Given):
    """Decisions of one second review, stored together or not at all."""

    model_config = ConfigDict(
        json_schema_extra={
            "example": {
                "decisions": [
                    {
                        "client_id": "4b0f0c5e-6d8c-4f6e-9d4e-1f7f2f0a6a02",
                        "group_id": "7a0a2c1e-58b8-4d39-8f0e-0d5a1c4a9b12",
                        "segment_id": 17,
                        "verdict": "reject",
                    }
                ]
            }
        }
    )

    decisions: list[SecondDecisionGiven] = Field(min_length=1, max_length=5000)


class SecondDecisionsStored(Answer):
    """What became of the decisions."""

    stored: int
    repeated: int
    verdicts: VerdictCounts = Field(description="Yours.")
    status: SecondReviewState


class SecondDecisionAnswer(Answer):
    """One row of a second review's history."""

    id: int
    segment_id: int
    verdict: Verdict
    previous: Verdict
    kind: Literal["judge", "undo", "redo", "accept"]
    client_id: str
    group_id: str
    target_group_id: str | None
    elapsed_ms: int | None
    created_at: datetime


class SecondHistory(Answer):
    """All decisions of a second review, oldest first."""

    decisions: list[SecondDecisionAnswer]


class SecondReviewGiven(Given):
    """How far a second review is."""

    model_config = ConfigDict(json_schema_extra={"example": {"status": "done"}})

    status: SecondReviewState
    allow_undecided: bool = Field(False, description="Done although candidates are left undecided.")
