"""What a candidate's score is made of, in the units it was measured in."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from app.vision.scoring import MEASURED, WEIGHTS


@dataclass(frozen=True)
class ScorePart:
    """One feature's part in a score: the logistic of the intercept and all ``weight * value``.

    Attributes:
        name: Of the feature.
        value: As the score takes it: a logarithm, mostly.
        weight: What the value is multiplied by.
        typical: Mean value over the image's candidates.
        measured: What was measured, in ``unit``; ``None`` where that can't be said.
        unit: ``"px"``, ``"share"``, ``"grey levels"`` or empty.
    """

    name: str
    value: float
    weight: float
    typical: float
    measured: float | None
    unit: str


def score_parts(features: Mapping[str, float], typical: Mapping[str, float]) -> tuple[ScorePart, ...]:
    """Return the parts of a score.

    Args:
        features: Of one candidate, by name, as ``SegmentHistory.features``.
        typical: Their means over the image's candidates.
    """
    return tuple(_part(name, value, typical[name]) for name, value in features.items())


def _part(name: str, value: float, typical: float) -> ScorePart:
    unit, measured = MEASURED.get(name, ("", None))
    return ScorePart(name, value, WEIGHTS[name], typical, None if measured is None else measured(value), unit)
