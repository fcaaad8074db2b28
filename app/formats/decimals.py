"""Decimal numbers for text formats: as few digits as bring the same float32 back."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def shortest(values: NDArray[np.float32]) -> NDArray[np.float64]:
    """Return float64 numbers of the fewest decimals (0 to 9) that round to the given float32 values.

    ``repr`` of a float32 made float64 has 17 digits; of these numbers, about 8. A value that 9 decimals can't tell
    is returned as it is.
    """
    exact = values.astype(np.float64)
    result = exact.copy()
    left = np.ones(values.shape, dtype=bool)
    for decimals in range(10):
        rounded = np.round(exact, decimals)
        fits = left & (rounded.astype(np.float32) == values)
        result[fits] = rounded[fits]
        left &= ~fits
        if not left.any():
            break
    return result


def shifted(values: NDArray[np.float32], offset: float) -> NDArray[np.float64]:
    """As `shortest`, with ``offset`` px added: for tools that count from the corner of the first pixel."""
    return np.round(shortest(values) + offset, 9)
