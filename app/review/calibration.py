"""Are probabilities what they say? Bins, scores, and the slope and offset that put them right."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

BINS = 10
STEPS = 50


class CalibrationBin(NamedTuple):
    """Candidates of ``low <= probability < high``: their number, mean probability and share that was kept."""

    low: float
    high: float
    count: int  # pyright: ignore[reportIncompatibleMethodOverride]
    predicted: float | None
    observed: float | None


class CalibrationReport(NamedTuple):
    """How good probabilities are that were made without seeing the image they are of.

    Attributes:
        bins: Ten bins of equal width.
        brier: Mean squared difference of probability and verdict (Brier 1950).
        log_loss: Mean negative log likelihood, nats.
        ece: Expected calibration error: mean distance of predicted and observed shares, weighted by count (Naeini,
            Cooper and Hauskrecht, AAAI 2015).
        count: Candidates.
        images: Images.
        error_rate: Share of candidates that suggestions at 0.5 get wrong.
        base_error_rate: Share that the more frequent verdict for all would get wrong.
        gain: Share of those errors that the suggestions save, at most 1.
    """

    bins: tuple[CalibrationBin, ...]
    brier: float
    log_loss: float
    ece: float
    count: int  # pyright: ignore[reportIncompatibleMethodOverride]
    images: int
    error_rate: float
    base_error_rate: float
    gain: float

    def as_dict(self) -> dict[str, Any]:
        """Return the report as JSON-serialisable fields."""
        return {**self._asdict(), "bins": [each._asdict() for each in self.bins]}


def calibration_report(probability: ArrayLike, kept: ArrayLike, image: ArrayLike) -> CalibrationReport:
    """Compare probabilities with verdicts.

    Args:
        probability: ``(N,)`` in [0, 1], at least one.
        kept: bool ``(N,)``.
        image: int ``(N,)``, which image each candidate is of.
    """
    p, y = np.asarray(probability, np.float64), np.asarray(kept, bool)
    number = np.minimum((p * BINS).astype(int), BINS - 1)
    bins, ece = [], 0.0
    for low in range(BINS):
        rows = number == low
        some = bool(rows.any())
        ece += abs(float((p[rows] - y[rows]).sum())) / len(p)
        bins.append(
            CalibrationBin(
                low / BINS,
                (low + 1) / BINS,
                int(rows.sum()),
                float(p[rows].mean()) if some else None,
                float(y[rows].mean()) if some else None,
            )
        )
    inside = np.clip(p, 1e-12, 1 - 1e-12)
    error, base = float(((p >= 0.5) != y).mean()), float(min(y.mean(), 1 - y.mean()))
    return CalibrationReport(
        tuple(bins),
        float(np.mean((p - y) ** 2)),
        float(-np.mean(np.where(y, np.log(inside), np.log(1 - inside)))),
        float(ece),
        len(p),
        len(np.unique(np.asarray(image))),
        error,
        base,
        1 - error / base if base > 0 else 0.0,
    )


def fit_platt(evidence: ArrayLike, kept: ArrayLike, weight: ArrayLike | None = None) -> tuple[float, float]:
    """Return slope and offset that make log odds fit verdicts best (Platt 1999, with his smoothed targets).

    Args:
        evidence: Log odds, ``(N,)``.
        kept: bool ``(N,)``.
        weight: Of each candidate; all alike if left out.
    """
    z, y = np.asarray(evidence, np.float64), np.asarray(kept, bool)
    w = np.ones(len(z)) if weight is None else np.asarray(weight, np.float64)
    many, few = float((w * y).sum()), float((w * ~y).sum())
    target = np.where(y, (many + 1) / (many + 2), 1 / (few + 2))
    design = np.column_stack([z, np.ones(len(z))])
    # a weak pull towards leaving the evidence as it is, for when there is hardly any
    pull, start = np.diag([1.0, 0.1]), np.array([1.0, 0.0])
    answer = start.copy()
    for _ in range(STEPS):
        p = 1 / (1 + np.exp(-np.clip(design @ answer, -700, 700)))
        slope = design.T @ (w * (p - target)) + pull @ (answer - start)
        curvature = (design * (w * p * (1 - p))[:, None]).T @ design + pull
        step = np.linalg.solve(curvature, slope)
        answer = answer - step * min(1.0, 2 / max(float(np.abs(step).max()), 1e-12))
        if np.abs(step).max() < 1e-9:
            break
    return float(max(answer[0], 0.05)), float(answer[1])
