"""Submissions: what authors send, and what became of it."""

from __future__ import annotations

from datetime import datetime
from typing import Any, Literal

from pydantic import ConfigDict, Field

from app.api.schemas.base import Answer, Given

SubmissionState = Literal["received", "validating", "queued", "scoring", "scored", "invalid", "failed", "withdrawn"]
SubmissionVisibility = Literal["public", "private"]
MethodKind = Literal["method", "baseline", "ceiling"]
Visibility = Literal["open", "hidden"]


class Estimate(Answer):
    """A metric with its 95 % interval; ``null`` where it isn't defined."""

    value: float | None
    low: float | None
    high: float | None


Totals = dict[str, Estimate]


class SplitName(Answer):
    """Which split."""

    slug: str
    name: str
    visibility: Visibility


class MethodName(Answer):
    """Which method."""

    slug: str
    name: str
    kind: MethodKind


class LogLine(Answer):
    """What happened to a submission."""

    at: datetime
    text: str


class SubmissionError(Answer):
    """Why a submission is invalid or failed; ``details.errors`` has every complaint of an invalid one."""

    code: str
    message: str
    where: str | None = None
    expected: str | None = None
    hint: str | None = None
    details: dict[str, Any] = Field(default_factory=dict)


class ScoreAnswer(Answer):
    """The numbers of a submission under one version of the protocol and the truth."""

    protocol: str
    protocol_version: str
    scorer_version: str
    split_version: int
    totals: Totals
    done_at: datetime | None


class Stratum(Answer):
    """The lines of one kind."""

    model_config = ConfigDict(from_attributes=True, extra="allow")

    name: str


class SubmissionAbilities(Answer):
    """What whoever asks can do with a submission."""

    withdraw: bool
    rescore: bool
    see_details: bool
    download: bool


class F1Grid(Answer):
    """F1 over distances and thresholds, which ``mean_f1`` is the mean of."""

    taus: list[float]
    thresholds: list[float]
    f1: list[list[float | None]]


class SubmissionAnswer(Answer):
    """One upload of a method for a split version, with its scores."""

    id: int
    split: SplitName
    split_version: int
    method: MethodName
    label: str | None
    person: str | None = Field(description="Absent while the method is anonymous.")
    mine: bool
    status: SubmissionState
    position: int | None = Field(description="Place in the queue, from 1.")
    progress: float = Field(ge=0, le=1)
    attempts: int
    error: SubmissionError | None
    log: list[LogLine]
    visibility: SubmissionVisibility
    images: int
    segments: int
    points: int
    has_scores: bool
    missing: list[str]
    created_at: datetime
    queued_at: datetime | None
    scored_at: datetime | None
    withdrawn_at: datetime | None
    truth_hash: str
    submission_hash: str | None
    scores: list[ScoreAnswer] = Field(description="Newest first.")
    strata: dict[str, list[Stratum]] | None
    error_types: dict[str, int] | None
    cameras: list[dict[str, Any]] | None
    f1_grid: F1Grid | None
    can: SubmissionAbilities


class SubmissionPage(Answer):
    """A page of submissions."""

    items: list[SubmissionAnswer]
    next_cursor: str | None
    total: int


class LeftOutFile(Answer):
    """A file of the upload that isn't read, and why."""

    file: str
    reason: str


class Validation(Answer):
    """What an upload holds; nothing of it is stored."""

    images: int
    segments: int
    points: int
    has_scores: bool
    missing: list[str]
    left_out: list[LeftOutFile]
    warnings: list[str]


class SubmissionChange(Given):
    """What to change about a submission."""

    model_config = ConfigDict(json_schema_extra={"example": {"visibility": "public"}})

    visibility: SubmissionVisibility | None = None
    label: str | None = Field(None, max_length=200)


class Rescore(Given):
    """Which version of the split to score on; the newest when left out."""

    model_config = ConfigDict(json_schema_extra={"example": {"split_version": 1}})

    split_version: int | None = Field(default=None, ge=1, le=2**31 - 1)


class Rescored(Answer):
    """How many submissions were queued to be scored anew."""

    queued: int
