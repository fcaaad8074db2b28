"""Segments as samples at equal steps of arc length, with tangents that a pixel staircase doesn't disturb."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from app.vision.segments import Segments

_TANGENT_REACH = 3  # samples to either side


@dataclass(frozen=True, eq=False)
class Samples:
    """S polylines as N samples; those of polyline s are ``points[offsets[s]:offsets[s + 1]]``, at least two.

    Attributes:
        points: float64 ``(N, 2)``, px.
        tangents: float64 ``(N, 2)``, unit vectors; zero where a polyline has no direction.
        polyline: int64 ``(N,)``, the polyline of each sample.
        offsets: int64 ``(S + 1,)``.
        lengths: float64 ``(S,)``, arc lengths in px.
    """

    points: NDArray[np.float64]
    tangents: NDArray[np.float64]
    polyline: NDArray[np.int64]
    offsets: NDArray[np.int64]
    lengths: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.lengths)

    @cached_property
    def weights(self) -> NDArray[np.float64]:
        """The arc length that each sample stands for, float64 ``(N,)``, px; they add up to the lengths."""
        return (self.lengths / np.diff(self.offsets))[self.polyline]

    @property
    def largest_step(self) -> float:
        """Largest arc length between neighbouring samples, px: 1 but for roundings and polylines under 1.5 px."""
        steps = self.lengths / (np.diff(self.offsets) - 1)
        return float(steps.max(initial=0.0))


def sums(group: NDArray[np.int64], values: NDArray[np.float64], groups: int) -> NDArray[np.float64]:
    """Return the sum of the values ``(N,)`` in each of the groups, float64 ``(groups,)``."""
    return np.bincount(group, values, groups).astype(np.float64, copy=False)


def resample(segments: Segments, step: float = 1.0) -> Samples:
    """Sample segments about every ``step`` px of arc length, both end points included.

    The number of steps is the arc length rounded, so that a segment and its reverse have the same samples. The tangent
    is the chord over three samples to either side (fewer on a short segment and at its ends).

    Args:
        segments: S segments, px.
        step: Distance of samples, px.
    """
    points = segments.points.astype(np.float64)
    first, last = segments.offsets[:-1], segments.offsets[1:] - 1
    distance = np.hypot(*np.diff(points, axis=0, prepend=points[:1]).T) if len(points) else np.zeros(0)
    distance[first] = 1.0  # the gap between two segments: any length will do, as nothing is sampled in it
    along = np.cumsum(distance)
    begin, end = along[first], along[last]
    lengths = end - begin

    counts = np.maximum(np.rint(lengths / step).astype(np.int64), 1) + 1
    offsets = np.concatenate([[0], np.cumsum(counts)])
    polyline = np.repeat(np.arange(len(segments), dtype=np.int64), counts)
    position = np.arange(offsets[-1]) - offsets[polyline]
    where = begin[polyline] + lengths[polyline] * (position / (counts[polyline] - 1))
    where = np.minimum(where, end[polyline])
    samples = (
        np.stack([np.interp(where, along, points[:, axis]) for axis in (0, 1)], axis=1)
        if len(segments)
        else np.zeros((0, 2))
    )
    return Samples(samples, _tangents(samples, counts, offsets, polyline), polyline, offsets, lengths)


def _tangents(
    points: NDArray[np.float64], counts: NDArray[np.int64], offsets: NDArray[np.int64], polyline: NDArray[np.int64]
) -> NDArray[np.float64]:
    reach = np.clip(counts // 4, 1, _TANGENT_REACH)[polyline]
    index = np.arange(len(points))
    ahead = np.minimum(index + reach, offsets[1:][polyline] - 1)
    behind = np.maximum(index - reach, offsets[:-1][polyline])
    chord = points[ahead] - points[behind]
    norm = np.hypot(chord[:, 0], chord[:, 1])[:, None]
    return np.divide(chord, norm, out=np.zeros_like(chord), where=norm > 0)
