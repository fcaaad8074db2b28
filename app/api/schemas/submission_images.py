"""Images of a submission: numbers, outcomes of every segment, comparisons."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import ConfigDict, Field

from app.api.schemas.base import Answer, Given, RejectReason, RowId

Outcome = Literal["hit", "false_alarm", "miss", "ignored"]


class ImageScoreAnswer(Answer):
    """The numbers of one image."""

    image_id: int
    name: str
    thumbnail: str
    f1: float | None
    precision: float | None
    recall: float | None
    tp: int
    fp: int
    fn: int
    offset_mean: float | None
    angle_error: float | None


class ImageScorePage(Answer):
    """A page of a submission's images."""

    items: list[ImageScoreAnswer]
    next_cursor: str | None
    total: int


class LabelOutcome(Answer):
    """What became of a label."""

    index: int
    outcome: Outcome
    length: float
    ignored: bool
    error_type: str | None


class PredictionOutcome(Answer):
    """What became of a prediction; offset (px) and angle (rad) are those of true positives."""

    index: int
    outcome: Outcome
    score: float | None
    length: float
    best_label: int | None
    liou: float
    offset: float | None
    angle: float | None
    error_type: str | None
    rejected_as: RejectReason | None = Field(description="Why people rejected the line that a false positive is.")


class ScoredImageAnswer(Answer):
    """One image of a submission, segment by segment."""

    image_id: int
    name: str
    width: int
    height: int
    original: str
    display: str
    thumbnail: str
    previous: int | None
    next: int | None
    position: int
    total: int
    metrics: dict[str, float | None]
    truth: list[LabelOutcome]
    predictions: list[PredictionOutcome]
    review_target: int | None = Field(description="The image that false positives can be sent to.")


class ReviewRequest(Given):
    """False positives to be looked at again."""

    model_config = ConfigDict(json_schema_extra={"example": {"predictions": [3, 17]}})

    predictions: list[int] = Field(min_length=1, max_length=5_000)


class ReviewSent(Answer):
    """What was put into the image's candidates; what was there already isn't sent again."""

    image_id: RowId
    sent: int
    already_there: int


class MetricDifference(Answer):
    """A metric of two submissions; ``difference`` is b - a, ``tied`` where its interval covers 0."""

    a: float | None
    b: float | None
    difference: float | None
    low: float | None
    high: float | None
    tied: bool


class ImageVerdicts(Answer):
    """On how many images the second submission is better than the first."""

    better: int
    worse: int
    equal: int


class ComparisonAnswer(Answer):
    """Two submissions on the same images."""

    a: int
    b: int
    protocol: str
    draws: int
    metrics: dict[str, MetricDifference]
    images: ImageVerdicts


class MatchesAnswer(Answer):
    """What became of every segment of every image."""

    submission: int
    protocol: str
    protocol_version: str
    truth_hash: str
    submission_hash: str
    images: list[dict[str, Any]]
