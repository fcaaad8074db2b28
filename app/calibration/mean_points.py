"""Segments of any length as 24 mean points along their chord, with the noise of the points they are made of."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.vision.segments import Segments

Array = NDArray[np.float64]

BINS = 24


@dataclass(frozen=True, eq=False)
class MeanPoints:
    """S segments in bins along their chords.

    Attributes:
        points: float64 ``(S, 24, 2)`` px, mean of each bin's points; the segment's first point where there are none.
        share: float64 ``(S, 24)``, of the segment's points, adds up to 1.
        along: float64 ``(S, 24)``, place along the chord from 0 to 1; 0 where there are no points.
        count: float64 ``(S,)``, points of each segment.
        noise: float64 ``(S,)`` px, standard deviation of a point across the segment.
    """

    points: Array
    share: Array
    along: Array
    count: Array
    noise: Array


def mean_points(segments: Segments) -> MeanPoints:
    """Return the segments' mean points, and their noise by second differences over three points' distance."""
    number, of_point = len(segments), segments.segment_of_point
    points = segments.points.astype(np.float64)
    first = points[segments.offsets[:-1]]
    chord = points[segments.offsets[1:] - 1] - first
    squared = np.maximum((chord**2).sum(1), 1e-12)
    away = points - first[of_point]
    along = (away * chord[of_point]).sum(1) / squared[of_point]
    cell = of_point * BINS + np.clip((along * BINS).astype(np.int64), 0, BINS - 1)
    filled = np.bincount(cell, minlength=number * BINS).astype(np.float64)
    safe = np.maximum(filled, 1)
    mean = np.stack([np.bincount(cell, points[:, axis], number * BINS) / safe for axis in (0, 1)], -1)
    mean[filled == 0] = np.repeat(first, BINS, axis=0)[filled == 0]
    place = np.where(filled == 0, 0.0, np.bincount(cell, along, number * BINS) / safe)
    count = segments.counts.astype(np.float64)
    across = (away[:, 1] * chord[of_point, 0] - away[:, 0] * chord[of_point, 1]) / np.sqrt(squared)[of_point]
    return MeanPoints(
        mean.reshape(number, BINS, 2),
        filled.reshape(number, BINS) / np.maximum(count, 1)[:, None],
        place.reshape(number, BINS),
        count,
        _noise(across, of_point, number),
    )


def _noise(across: Array, of_point: NDArray[np.int64], number: int) -> Array:
    """Return the noise of distances from the chord; a second difference has sqrt(1 + 4 + 1) times of it."""
    second = across[6:] - 2 * across[3:-3] + across[:-6]
    inside = of_point[6:] == of_point[:-6]
    owner = of_point[6:][inside]
    power = np.bincount(owner, second[inside] ** 2, number)
    return np.sqrt(power / np.maximum(np.bincount(owner, minlength=number), 1) / 6)
