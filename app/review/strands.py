"""Candidates as evenly spread samples with directions: what every feature starts from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.vision.segments import Segments

Array = NDArray[np.float64]

SAMPLES = 24
"""Places along a candidate that are looked at, whatever its length."""


@dataclass(frozen=True, eq=False)
class Strands:
    """S candidates of one image.

    Attributes:
        width: Image width in px.
        height: Image height in px.
        samples: float64 ``(S, SAMPLES, 2)``, measured points spread over the candidate, both ends among them, px.
        start: float64 ``(S, 2)``, first point after the lens's correction, px.
        end: float64 ``(S, 2)``, last point after the lens's correction, px.
        direction: float64 ``(S, 2)``, unit vector from start to end; ``(1, 0)`` where they are one.
        length: float64 ``(S,)``, distance of start and end, px.
        middle: float64 ``(S, 2)``, middle of start and end, px.
        scores: float64 ``(S,)`` in [0, 1]; NaN where not known.
    """

    width: int
    height: int
    samples: Array
    start: Array
    end: Array
    direction: Array
    length: Array
    middle: Array
    scores: Array

    def __len__(self) -> int:
        return len(self.length)

    @property
    def diagonal(self) -> float:
        """The image's diagonal in px."""
        return float(np.hypot(self.width, self.height))

    @property
    def normal(self) -> Array:
        """Unit vectors ``(-dy, dx)`` across the candidates, float64 ``(S, 2)``."""
        return np.stack([-self.direction[:, 1], self.direction[:, 0]], -1)


def strands(segments: Segments, size: tuple[int, int], undistort: object = None) -> Strands:
    """Spread samples over segments and correct their ends.

    Args:
        segments: S candidates, px.
        size: Width and height of the image, px.
        undistort: Maps points ``(N, 2)`` to corrected ones; the ends stay as measured where it is ``None``.
    """
    width, height = size
    spread = np.linspace(0, 1, SAMPLES)
    rows = segments.offsets[:-1, None] + np.rint((segments.counts[:, None] - 1) * spread).astype(np.int64)
    samples = segments.points[rows].astype(np.float64).reshape(-1, SAMPLES, 2)
    ends = samples[:, [0, -1]]
    if callable(undistort) and len(segments):
        ends = np.asarray(undistort(ends.reshape(-1, 2)), np.float64).reshape(-1, 2, 2)
    start, end = ends[:, 0], ends[:, 1]
    chord = end - start
    length = np.hypot(chord[:, 0], chord[:, 1])
    direction = np.where(length[:, None] > 0, chord / np.where(length > 0, length, 1.0)[:, None], [1.0, 0.0])
    scores = np.full(len(segments), np.nan) if segments.scores is None else segments.scores.astype(np.float64)
    return Strands(width, height, samples, start, end, direction, length, (start + end) / 2, scores)
