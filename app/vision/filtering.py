"""Length and shape filter, and the score that orders the candidates."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from app.vision.parameters import OperatingPoint
from app.vision.tracing import Trace

# least quality and painting width (px, see app.vision.duplicates) of the operating points
LEAST_QUALITY: dict[OperatingPoint, float] = {"recall": 1.0, "balanced": 2.3, "precise": 2.8}
PAINT_WIDTH: dict[OperatingPoint, float] = {"recall": 1.4, "balanced": 1.4, "precise": 2.2}

_WEAK_PERCENTILE = 20.0


def qualities(samples: Trace, bounds: NDArray[np.int64], chords: NDArray[np.float64]) -> NDArray[np.float64]:
    """Evidence for each segment: long, well supported, of good contrast everywhere, and close to its arc.

    ``ln(L) / 2 + ln(share of close samples) + ln(20th percentile of the gradient norm) / 2 - 2 rms``.

    Args:
        samples: Samples along the segments.
        bounds: int64 ``(s + 1,)``, where the samples of each segment begin; none is empty.
        chords: float64 ``(s,)`` px, lengths.
    """
    counts = np.diff(bounds)
    member = np.repeat(np.arange(len(counts)), counts)
    close = np.add.reduceat(samples.close.astype(np.float64), bounds[:-1])
    order = np.lexsort((samples.norm, member))
    weak = samples.norm[order][bounds[:-1] + (counts * (_WEAK_PERCENTILE / 100)).astype(np.int64)]
    squares = np.where(samples.hit, samples.distance, 0) ** 2
    hits = np.maximum(np.add.reduceat(samples.hit.astype(np.float64), bounds[:-1]), 1)
    rms = np.sqrt(np.add.reduceat(squares, bounds[:-1]) / hits)
    share = np.maximum(close, 0.5) / counts
    return 0.5 * np.log(chords) + np.log(share) + 0.5 * np.log(np.maximum(weak, 1.0)) - 2 * rms


def scores(quality: NDArray[np.float64]) -> NDArray[np.float32]:
    """Map qualities to (0, 1), rising."""
    return (1 / (1 + np.exp(-1.6 * (quality - 3.6)))).astype(np.float32)
