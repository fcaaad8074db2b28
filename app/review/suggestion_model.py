"""How likely a person keeps a candidate, from its features, with the reasons.

    p = sigmoid(slope * (intercept + sum_f weight_f * (x_f - mean_f) / scale_f + trees(x)) + offset)

A linear part that holds with few decisions, trees for what isn't linear once there are many, and a slope and an offset
that calibrate the whole (Platt 1999, "Probabilistic outputs for support vector machines"). An unknown feature counts
as the mean in the linear part.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from app.errors import InvalidInput
from app.review.features import FEATURE_VERSION, FEATURES
from app.review.trees import Trees, no_trees

Array = NDArray[np.float64]

REASONS = 3
"""Features named for, and against, a candidate."""
LEAST_SAID = 0.05
"""Log odds; a feature that adds less isn't named."""


class Reasons(NamedTuple):
    """Names from `FEATURES`, the strongest first: what speaks for keeping a candidate, and what against."""

    speaks_for: tuple[str, ...]
    against: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class SuggestionModel:
    """A trained model, or the prior.

    Attributes:
        intercept: Log odds of a candidate whose features are all typical.
        mean: float64 ``(F,)``.
        scale: float64 ``(F,)``, above 0.
        weight: float64 ``(F,)``, log odds per scale.
        trees: Added to the linear part.
        slope: Of the calibration.
        offset: Of the calibration, log odds.
        version: `FEATURE_VERSION` that it was trained with.
    """

    intercept: float
    mean: Array
    scale: Array
    weight: Array
    trees: Trees = field(default_factory=no_trees)
    slope: float = 1.0
    offset: float = 0.0
    version: str = FEATURE_VERSION

    def log_odds(self, features: NDArray[Any]) -> Array:
        """Return calibrated log odds of being kept, float64 ``(S,)``."""
        return self.slope * self.evidence(features) + self.offset

    def evidence(self, features: NDArray[Any]) -> Array:
        """Return log odds before calibration, float64 ``(S,)``.

        Raises:
            InvalidInput: If the features aren't ``(S, F)``.
        """
        table = _table(features)
        return self.intercept + self._standard(table) @ self.weight + self.trees.evaluate(table)

    def probability(self, features: NDArray[Any]) -> Array:
        """Return the probability of being kept, float64 ``(S,)`` in [0, 1].

        Raises:
            InvalidInput: If the features aren't ``(S, F)``.
        """
        return 1 / (1 + np.exp(-np.clip(self.log_odds(features), -700, 700)))

    def contributions(self, features: NDArray[Any]) -> Array:
        """Return what each feature adds to the log odds, float64 ``(S, F)``."""
        table = _table(features)
        return self.slope * (self._standard(table) * self.weight + self.trees.contributions(table))

    def reasons(self, features: NDArray[Any]) -> list[Reasons]:
        """Return for each candidate the few features that speak most for and against it."""
        added = self.contributions(features)
        order = np.argsort(added, axis=1, kind="stable")
        return [
            Reasons(
                tuple(FEATURES[f] for f in row[::-1][:REASONS] if values[f] > LEAST_SAID),
                tuple(FEATURES[f] for f in row[:REASONS] if values[f] < -LEAST_SAID),
            )
            for row, values in zip(order, added, strict=True)
        ]

    def as_dict(self) -> dict[str, Any]:
        """Return the model as JSON-serialisable fields."""
        return {
            "version": self.version,
            "features": list(FEATURES),
            "intercept": self.intercept,
            "mean": self.mean.tolist(),
            "scale": self.scale.tolist(),
            "weight": self.weight.tolist(),
            "trees": self.trees.as_dict(),
            "slope": self.slope,
            "offset": self.offset,
        }

    @classmethod
    def from_dict(cls, fields: Mapping[str, Any]) -> SuggestionModel:
        """Return the model that `as_dict` gave the fields of.

        Raises:
            InvalidInput: If a field is missing or isn't what it should be, or the features were others.
        """
        if fields.get("version") != FEATURE_VERSION or fields.get("features") != list(FEATURES):
            raise InvalidInput(
                f"a model of feature version {fields.get('version')!r}",
                where="version",
                expected=repr(FEATURE_VERSION),
                hint="train it anew",
            )
        try:
            mean, scale, weight = (np.asarray(fields[name], np.float64) for name in ("mean", "scale", "weight"))
            intercept, slope, offset = (float(fields[name]) for name in ("intercept", "slope", "offset"))
            trees = Trees.from_dict(fields["trees"], len(FEATURES))
        except (KeyError, TypeError, ValueError) as error:
            raise InvalidInput("a field of a model is missing or no number", where="model") from error
        numbers = np.concatenate([[intercept, slope, offset], mean.reshape(-1), scale.reshape(-1), weight.reshape(-1)])
        if any(each.shape != (len(FEATURES),) for each in (mean, scale, weight)) or not np.isfinite(numbers).all():
            raise InvalidInput("a model's numbers don't fit its features", where="model")
        if (scale <= 0).any():
            raise InvalidInput("a scale isn't positive", where="scale", expected="above 0")
        return cls(intercept, mean, scale, weight, trees, slope, offset)

    def _standard(self, table: Array) -> Array:
        values = (table - self.mean) / self.scale
        # an outlier must not speak louder than anything that was ever seen
        return np.clip(np.where(np.isfinite(values), values, 0.0), -5, 5)


def _table(features: NDArray[Any]) -> Array:
    table = np.asarray(features, np.float64)
    if table.ndim != 2 or table.shape[1] != len(FEATURES):
        raise InvalidInput(f"features of shape {table.shape}", where="features", expected=f"(S, {len(FEATURES)})")
    return table
