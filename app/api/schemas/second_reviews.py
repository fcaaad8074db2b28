"""Second reviews, agreement and adjudication."""

from __future__ import annotations

from datetime import datetime
from typing import Literal
from uuid import UUID

from pydantic import ConfigDict, Field

from app.api.schemas.base import Answer, Given, RowId, Verdict, VerdictCounts

SecondReviewState = Literal["open", "done"]
Judged = Literal["keep", "reject", "ambiguous"]


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
    """An image's current candidates in the order of ``/images/{image_id}/points``."""

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


class GivenVerdict(Answer):
    """A verdict and who gave it."""

    verdict: Judged
    person: str | None


class Adjudicated(Answer):
    """What was decided where two differed."""

    verdict: Judged
    person: str | None
    created_at: datetime


class Difference(Answer):
    """A candidate on which first and second review differ."""

    second_review_id: int
    image_id: int
    image: str
    segment_id: int
    length: float = Field(description="Arc length, px.")
    box: tuple[float, float, float, float] = Field(description="x0, y0, x1, y1 in px.")
    first: GivenVerdict
    second: GivenVerdict
    adjudicated: Adjudicated | None


class DifferencePage(Answer):
    """A page of differences, by image."""

    items: list[Difference]
    next_cursor: str | None
    total: int


class AdjudicationGiven(Given):
    """A decision between two verdicts."""

    model_config = ConfigDict(
        json_schema_extra={
            "example": {
                "client_id": "4b0f0c5e-6d8c-4f6e-9d4e-1f7f2f0a6a03",
                "segment_id": 17,
                "verdict": "keep",
            }
        }
    )

    client_id: UUID
    segment_id: RowId
    verdict: Judged


class KappaAnswer(Answer):
    """Cohen's kappa with its 95 % interval."""

    value: float | None = Field(description="-1 to 1; absent where it isn't defined.")
    low: float | None
    high: float | None
    observed: float | None = Field(description="Share of equal verdicts.")
    expected: float | None = Field(description="Share that chance would make equal.")
    count: int = Field(description="Candidates that both judged.")


class ImageAgreement(Answer):
    """Agreement on one image."""

    image_id: int
    name: str
    second_person: str | None
    kappa: KappaAnswer


class PairAgreement(Answer):
    """Agreement of one person's first verdicts with another's second ones."""

    first: str | None
    second: str | None
    kappa: KappaAnswer


class PersonAgreement(Answer):
    """Agreement of one person with all others."""

    person: str | None
    kappa: KappaAnswer


class LengthAgreement(Answer):
    """Agreement on candidates of ``low <= length < high``, px."""

    low: float
    high: float | None
    kappa: KappaAnswer


class AgreementAnswer(Answer):
    """How far the people of a dataset agree."""

    reviews: int = Field(description="Second reviews that are done.")
    overall: KappaAnswer
    images: list[ImageAgreement]
    pairs: list[PairAgreement]
    people: list[PersonAgreement]
    lengths: list[LengthAgreement]
    differences: int
    adjudicated: int
