"""The turn brush: a stroke from one wrong line to another turns both, and what is about as likely between them.

By the page's rule (`frontend/src/labelling/tools/stroke_effects.ts`); `stroke_cases.json` beside it holds both sides
to the same answers.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .review_touching import BESIDE

MIDDLE = 0.5
"""Probability that an end beside the lines counts for."""


def turned(touched: NDArray[np.bool_], lines: NDArray[np.int64], probability: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Tell which lines K strokes turn.

    Args:
        touched: bool ``(K, S)``, what each touches.
        lines: int64 ``(K, 2)``, the lines it begins and ends on; `BESIDE` for none.
        probability: ``(S,)``, of being kept.

    Returns:
        bool ``(K, S)``: of what is touched, all whose probability lies between those of the stroke's ends. Where both
        ends are beside the lines, all that is touched.
    """
    ends = np.append(probability, MIDDLE)[lines]  # BESIDE is the last one
    low, high = ends.min(axis=1, keepdims=True), ends.max(axis=1, keepdims=True)
    everything = (lines == BESIDE).all(axis=1, keepdims=True)
    return touched & (everything | ((probability >= low) & (probability <= high)))
