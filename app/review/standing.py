"""Where a candidate stands among those of its image: ranks, and differences in units of the image's own spread."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def ranks(values: Array) -> Array:
    """Return the share of values that are lower, equal ones counted half, float64 ``(S,)`` in (0, 1)."""
    if not len(values):
        return np.zeros(0)
    ordered = np.sort(values)
    below, upto = np.searchsorted(ordered, values, "left"), np.searchsorted(ordered, values, "right")
    return (below + upto) / (2 * len(values))


def standardised(values: Array) -> Array:
    """Return values less their median, over the distance of the quartiles, float64 ``(S,)``, NaN left as it is."""
    if not np.isfinite(values).any():
        return np.full(len(values), np.nan)
    low, middle, high = np.nanpercentile(values, [25, 50, 75])
    return (values - middle) / max(high - low, 1e-3)
