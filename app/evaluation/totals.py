"""Metrics of a set of images, or of many draws of it at once, under any protocol."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from app.errors import InvalidInput
from app.evaluation.average_precision import Ranked, average_precision
from app.evaluation.protocols import Protocol

Totals = dict[str, NDArray[np.float64]]
"""Values by the name of the metric; NaN where one isn't defined."""


def total(
    protocol: Protocol,
    tallies: NDArray[np.float64],
    ranked: Sequence[Ranked | None] | None = None,
    weights: NDArray[np.float64] | None = None,
) -> Totals:
    """Add up images and return the metrics of them all.

    Args:
        protocol: What the tallies are of.
        tallies: float64 ``(I, K)``, one row per image.
        ranked: Rankings of the I images, for average precision; ``ap`` is absent where one is missing.
        weights: ``(I,)`` or ``(B, I)``, how often each image counts; once if not given.

    Returns:
        Values ``()``, or ``(B,)`` for B rows of weights, by name.

    Raises:
        InvalidInput: When there are no images, or shapes don't fit.
    """
    tallies = np.asarray(tallies, np.float64)
    if tallies.ndim != 2 or tallies.shape[1] != protocol.layout.size or not len(tallies):
        raise InvalidInput(
            f"tallies have shape {tallies.shape}", where="tallies", expected=f"(I, {protocol.layout.size}), I > 0"
        )
    if weights is not None and (np.ndim(weights) not in (1, 2) or np.shape(weights)[-1] != len(tallies)):
        raise InvalidInput(
            f"weights have shape {np.shape(weights)}",
            where="weights",
            expected=f"({len(tallies)},) or (B, {len(tallies)})",
        )
    totals = protocol.metrics(tallies.sum(axis=0) if weights is None else np.asarray(weights, np.float64) @ tallies)
    rankings = [] if ranked is None else [ranking for ranking in ranked if ranking is not None]
    if len(rankings) == len(tallies):
        totals["ap"] = average_precision(rankings, weights)
    return totals
