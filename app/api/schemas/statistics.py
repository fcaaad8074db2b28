"""Statistics of a dataset."""

from __future__ import annotations

from datetime import date, datetime

from pydantic import Field

from app.api.schemas.agreement import KappaAnswer
from app.api.schemas.base import Answer, RejectReason, ReviewCounts, Verdict


class DayProgress(Answer):
    """What happened on a day, UTC."""

    day: date
    decisions: int
    done: int = Field(description="Images finished then, and still.")


class HourProgress(Answer):
    """Verdicts given in an hour that begins at this time."""

    hour: datetime
    decisions: int


class DecisionTimes(Answer):
    """How long key presses took, ms."""

    count: int
    lower_quartile: float | None
    median: float | None
    upper_quartile: float | None
    histogram: list[int] = Field(description="Numbers by `edges`.")


class VerdictTimes(Answer):
    """How long it took to give a verdict."""

    verdict: Verdict
    times: DecisionTimes


class PersonWork(Answer):
    """What one person did."""

    person: str | None
    decisions: int
    undone: int
    hours: float = Field(description="Time that the decisions took, breaks left out, h.")
    per_hour: float | None
    times: DecisionTimes


class SuggestionUse(Answer):
    """What became of suggestions."""

    shown: int
    agreed: int
    accepted: int


class ReasonCount(Answer):
    """How many candidates are rejected for a reason."""

    reason: RejectReason
    count: int


class AgreementSummary(Answer):
    """Agreement of first and second reviews."""

    reviews: int
    kappa: KappaAnswer
    differences: int
    adjudicated: int


class StatisticsAnswer(Answer):
    """A dataset's statistics."""

    images: ReviewCounts
    decisions: int
    per_hour: float | None = Field(description="Decisions in an hour of work, all people together.")
    days: list[DayProgress]
    hours: list[HourProgress]
    edges: list[int] = Field(description="Lower ends of the bars of all histograms, ms.")
    times: DecisionTimes
    verdicts: list[VerdictTimes]
    people: list[PersonWork]
    suggestions: SuggestionUse
    reasons: list[ReasonCount]
    agreement: AgreementSummary
