"""How far first and second reviews agree, where they differ, and what is decided there."""

from __future__ import annotations

from datetime import datetime
from typing import Literal
from uuid import UUID

from pydantic import ConfigDict, Field

from app.api.schemas.base import Answer, Given, RowId

Judged = Literal["keep", "reject", "ambiguous"]


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
