"""How good a dataset's suggestions are, and when they are learnt anew."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from sqlalchemy.orm import Session

from app.db.models import Dataset, SuggestionTraining
from app.review.feature_weights import linear_weights
from app.review.thresholds import Thresholds
from app.services.suggestion_models import ModelName, latest_model, model_of
from app.services.suggestion_training import FEWEST_DECISIONS, training_due, wanted_decisions


@dataclass(frozen=True)
class TrainingState:
    """What the next training waits for.

    Attributes:
        decisions: That it would learn from now.
        images: They are on.
        wanted: Decisions from which on it begins by itself.
        least: Decisions that it needs when somebody asks for it.
        asked: Whether somebody asked for it and it isn't done yet.
        error: Why the latest one failed.
    """

    decisions: int
    images: int
    wanted: int
    least: int
    asked: bool
    error: dict[str, Any] | None


@dataclass(frozen=True)
class DatasetSuggestions:
    """The model that suggests in a dataset; its report as the training wrote it."""

    model: ModelName
    thresholds: Thresholds
    calibration: dict[str, Any] | None
    gain: list[dict[str, Any]]
    weights: list[dict[str, Any]]
    training: TrainingState


def dataset_suggestions(session: Session, dataset: Dataset) -> DatasetSuggestions:
    """Return which model suggests in a dataset and how good it is."""
    used = model_of(session, dataset.id)
    row = latest_model(session, dataset.id)
    report = {} if row is None else row.report
    weights = [each._asdict() for each in linear_weights(used.model)] if row is None else report["weights"]
    return DatasetSuggestions(
        used.name,
        used.thresholds,
        report.get("calibration"),
        report.get("gain", []),
        weights,
        training_state(session, dataset),
    )


def training_state(session: Session, dataset: Dataset) -> TrainingState:
    """Return what a dataset's next training waits for."""
    due = training_due(session, dataset.id)
    row = session.get(SuggestionTraining, dataset.id)
    return TrainingState(
        due.n_decisions,
        due.n_images,
        math.ceil(wanted_decisions(session, dataset.id)),
        FEWEST_DECISIONS,
        row is not None and row.asked_at is not None,
        None if row is None else row.error,
    )
