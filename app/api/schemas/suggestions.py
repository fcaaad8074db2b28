"""What a model suggests for the candidates of an image, and how good it is."""

from __future__ import annotations

from datetime import datetime

from pydantic import Field

from app.api.schemas.base import Answer, ErrorInfo


class ModelName(Answer):
    """Which model suggests."""

    id: int | None = Field(description="Null for the general model, as long as nothing was learnt in the dataset.")
    version: str
    decisions: int = Field(description="That it was learnt from.")
    images: int = Field(description="They are on.")
    created_at: datetime | None


class Thresholds(Answer):
    """Between which probabilities a candidate is left to a person; of the model, a person may choose others."""

    keep: float = Field(description="From this probability on, keeping is suggested.")
    reject: float = Field(description="Below this probability, rejecting is suggested.")


class Suggestion(Answer):
    """What is suggested for one candidate."""

    id: int
    probability: float = Field(description="That a person keeps it, 0 to 1.")
    family: int = Field(description="Number of the structure that it shares with others, -1 for one alone.")
    value: float = Field(description="What a look at it is worth, 0 to 1: uncertain and long first.")
    lens: float = Field(description="What it would tell of the lens, if it is kept, 0 to 1.")
    speaks_for: list[str] = Field(serialization_alias="for", description="The features that speak most for keeping.")
    speaks_against: list[str] = Field(serialization_alias="against", description="Those that speak most against it.")


class ImageSuggestions(Answer):
    """Suggestions for an image's candidates; nothing is decided by them until a person accepts them."""

    image_id: int
    revision: int
    model: ModelName
    thresholds: Thresholds
    segments: list[Suggestion]


class CalibrationBin(Answer):
    """Candidates of about one probability, on images that the model wasn't learnt from."""

    low: float
    high: float
    count: int
    predicted: float | None = Field(description="Mean probability that they had.")
    observed: float | None = Field(description="Share of them that a person kept.")
    observed_low: float | None = Field(description="95 % interval of that share.")
    observed_high: float | None


class Calibration(Answer):
    """How well probabilities agree with what people decided, on images that the model wasn't learnt from."""

    bins: list[CalibrationBin]
    count: int = Field(description="Candidates that it was measured on.")
    images: int
    brier: float = Field(description="Mean squared difference of probability and verdict.")
    log_loss: float = Field(description="Mean negative log likelihood, nats.")
    ece: float = Field(description="Expected calibration error: mean distance of probability and share kept.")
    error_rate: float = Field(description="Share that is wrong where all suggestions at 0.5 are taken.")
    base_error_rate: float = Field(description="Share that is wrong where all get the more frequent verdict.")


class GainEntry(Answer):
    """What accepting suggestions would have cost and spared on one image that the model wasn't learnt from."""

    images: int = Field(description="Images labelled before.")
    candidates: int
    keys: int = Field(description="With suggestions: one accepts them, two mend a wrong one, one judges one left.")
    keys_by_hand: int = Field(
        description="Without: one for each candidate, or two for each kept and one to reject the rest, if that is less."
    )


class FeatureWeight(Answer):
    """How much a feature counts in the model."""

    feature: str
    weight: float = Field(description="Log odds that it adds or takes; negative where more of it speaks against.")


class TrainingState(Answer):
    """What the next training waits for."""

    decisions: int = Field(description="Decisions that it would learn from now.")
    images: int
    wanted: int = Field(description="Decisions from which on it begins by itself.")
    least: int = Field(description="Decisions that it needs when somebody asks for it.")
    asked: bool = Field(description="Whether somebody asked for it and it isn't done yet.")
    error: ErrorInfo | None = Field(description="Why the latest one failed.")


class DatasetSuggestions(Answer):
    """The model that suggests in a dataset, how good it is, and when the next one comes."""

    model: ModelName
    thresholds: Thresholds
    calibration: Calibration | None = Field(description="Null for the general model.")
    gain: list[GainEntry]
    weights: list[FeatureWeight] = Field(description="The heaviest first.")
    training: TrainingState
