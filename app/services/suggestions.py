"""What a dataset's model suggests for the candidates of one image."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import Segment
from app.review.review_order import look_values
from app.review.thresholds import Thresholds
from app.services.candidates import is_current
from app.services.images import get_image
from app.services.suggestion_features import KnownFeatures
from app.services.suggestion_models import ModelName, model_of


@dataclass(frozen=True)
class CandidateSuggestion:
    """What is suggested for one candidate.

    Attributes:
        id: The segment.
        probability: That a person keeps it.
        family: Number of its family, -1 for one alone.
        value: What a look at it is worth, in [0, 1].
        lens: What it would tell of the lens if it is kept, in [0, 1].
        speaks_for: Features that speak most for keeping it.
        speaks_against: Features that speak most against that.
    """

    id: int
    probability: float
    family: int
    value: float
    lens: float
    speaks_for: tuple[str, ...]
    speaks_against: tuple[str, ...]


@dataclass(frozen=True)
class ImageSuggestions:
    """Suggestions for an image's current candidates, by the newest model of its dataset."""

    image_id: int
    revision: int
    model: ModelName
    thresholds: Thresholds
    segments: tuple[CandidateSuggestion, ...]


def suggestions_of_image(session: Session, image_id: int, known: KnownFeatures) -> ImageSuggestions:
    """Return what is suggested for an image's candidates.

    Args:
        session: Any session.
        image_id: The image.
        known: What is known of its candidates; those that aren't current any more are left out.

    Raises:
        NotFound: When there is no such image, or it is deleted.
    """
    image = get_image(session, image_id)
    used = model_of(session, image.dataset_id)
    current = session.scalars(select(Segment.id).where(Segment.image_id == image.id, is_current())).all()
    rows = np.flatnonzero(np.isin(known.segment_ids, current))
    features = known.features[rows]
    probability = used.model.probability(features)
    information = known.lens_information[rows]
    value = look_values(probability, information)
    columns = (
        known.segment_ids[rows].tolist(),
        np.round(probability, 4).tolist(),
        known.families[rows].tolist(),
        np.round(value, 4).tolist(),
        np.round(probability * information, 5).tolist(),
        used.model.reasons(features),
    )
    segments = tuple(
        CandidateSuggestion(key, probable, family, worth, lens, why.speaks_for, why.against)
        for key, probable, family, worth, lens, why in zip(*columns, strict=True)
    )
    return ImageSuggestions(image.id, image.revision, used.name, used.thresholds, segments)
