"""How much each feature counts in a model."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from app.review.features import FEATURES
from app.review.suggestion_model import SuggestionModel


class FeatureWeight(NamedTuple):
    """A feature's part in a model.

    Attributes:
        feature: Its name.
        weight: Log odds that it adds or takes away on average; negative where more of it speaks against keeping.
    """

    feature: str
    weight: float


def feature_weights(model: SuggestionModel, features: NDArray[Any]) -> list[FeatureWeight]:
    """Return what each feature adds over examples, the heaviest first.

    Args:
        model: The model.
        features: ``(N, F)``, at least one example.
    """
    added = model.contributions(features)
    table = np.asarray(features, np.float64)
    centred = np.where(np.isfinite(table), table, model.mean) - model.mean
    sign = np.where((centred * added).sum(axis=0) < 0, -1.0, 1.0)
    mean = np.abs(added).mean(axis=0) * sign
    order = np.argsort(-np.abs(mean), kind="stable")
    return [FeatureWeight(FEATURES[index], float(mean[index])) for index in order if mean[index] != 0]


def linear_weights(model: SuggestionModel) -> list[FeatureWeight]:
    """Return what each feature adds per spread in the model's linear part, the heaviest first."""
    weight = model.slope * model.weight
    order = np.argsort(-np.abs(weight), kind="stable")
    return [FeatureWeight(FEATURES[index], float(weight[index])) for index in order if weight[index] != 0]
