"""The model that suggests for a dataset: the newest that was learnt from its decisions, else the general one."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import SuggestionModel as Row
from app.review.features import FEATURE_VERSION
from app.review.learning_curve import PRIOR_THRESHOLDS
from app.review.prior import prior_model
from app.review.suggestion_model import SuggestionModel
from app.review.thresholds import Thresholds


@dataclass(frozen=True)
class ModelName:
    """Which model suggests.

    Attributes:
        id: ``None`` for the general model.
        version: Of its features.
        decisions: That it was learnt from.
        images: They are on.
        created_at: When; ``None`` for the general model.
    """

    id: int | None
    version: str
    decisions: int
    images: int
    created_at: datetime | None


@dataclass(frozen=True)
class UsedModel:
    """A model, its name, and the thresholds that it recommends."""

    name: ModelName
    model: SuggestionModel
    thresholds: Thresholds


def latest_model(session: Session, dataset_id: int) -> Row | None:
    """Return the newest model of a dataset whose features still mean the same; ``None`` if there is none."""
    query = select(Row).where(Row.dataset_id == dataset_id, Row.version == FEATURE_VERSION)
    return session.scalar(query.order_by(Row.id.desc()).limit(1))


def model_of(session: Session, dataset_id: int) -> UsedModel:
    """Return the model that suggests for a dataset's images.

    Raises:
        BrokenInstallation: When the general model is missing.
    """
    row = latest_model(session, dataset_id)
    if row is None:
        return UsedModel(ModelName(None, FEATURE_VERSION, 0, 0, None), prior_model(), PRIOR_THRESHOLDS)
    name = ModelName(row.id, row.version, row.n_decisions, row.n_images, row.created_at)
    thresholds = Thresholds(**row.report["thresholds"])
    return UsedModel(name, SuggestionModel.from_dict(row.parameters), thresholds)
