"""How likely a segment is one that a person would mark, from what was measured along it.

The logistic of a weighted sum of features.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.vision.parameters import OperatingPoint


def _logarithm(values: NDArray[np.float64], least: float) -> NDArray[np.float64]:
    return np.log(np.maximum(values, least))


Feature = Callable[[NDArray[Any]], NDArray[np.float64]]

FEATURES: dict[str, Feature] = {
    "length": lambda found: _logarithm(found["chord"], 1.0) - np.log(50),
    "closeness": lambda found: _logarithm(found["close"], 0.5) - np.log(found["samples"]),
    "edge strength": lambda found: _logarithm(found["mean_norm"], 1.0),
    "roughness": lambda found: found["rms"].astype(np.float64),
    "longest gap": lambda found: np.log1p(found["longest_gap"].astype(np.float64)),
    "contrast": lambda found: np.log1p(np.abs(found["contrast"].astype(np.float64))),
}
"""Features by name, each of findings `app.vision.native.records.FINDING` ``(S,)``, float64 ``(S,)``."""

MEASURED: dict[str, tuple[str, Callable[[float], float]]] = {
    "length": ("px", lambda value: 50 * math.exp(value)),
    "closeness": ("share", math.exp),
    "edge strength": ("grey levels", math.exp),
    "roughness": ("px", float),
    "longest gap": ("px", math.expm1),
    "contrast": ("grey levels", math.expm1),
}
"""The inverse of each of `FEATURES`: its unit, and what was measured where the feature has a value."""

# logistic regression on 51 photos of buildings and rooms with 2,502 marked lines, each feature checked by
# cross-validation over the photos; a score is the share of such candidates that a person had marked there
WEIGHTS: dict[str, float] = {
    "length": 1.071,
    "closeness": 0.369,
    "edge strength": 0.323,
    "roughness": -3.795,
    "longest gap": -0.34,
    "contrast": 0.27,
}
INTERCEPT = -2.857

LEAST_SCORE: dict[OperatingPoint, float] = {"recall": 0.0, "balanced": 0.01, "precise": 0.0719}
"""Segments with a lower score are left out."""


def measure_features(findings: NDArray[Any]) -> dict[str, NDArray[np.float64]]:
    """Return the features that the score is made of, by name, float64 ``(S,)`` each.

    Args:
        findings: `FINDING` ``(S,)``.
    """
    return {name: FEATURES[name](findings) for name in WEIGHTS}


def score(features: dict[str, NDArray[np.float64]]) -> NDArray[np.float64]:
    """Return the logistic of the weighted sum of features, float64 ``(S,)`` in [0, 1]."""
    evidence = sum((weight * features[name] for name, weight in WEIGHTS.items()), np.float64(INTERCEPT))
    return np.asarray(1 / (1 + np.exp(-np.clip(evidence, -700, 700))))
