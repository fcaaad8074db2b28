"""Synthetic edge-segments through a known lens."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from app.vision.brown import Brown
from app.vision.frame import center_of
from app.vision.segments import Segments

SegmentsThrough = Callable[..., Segments]


@pytest.fixture
def segments_through() -> SegmentsThrough:
    """Return a function that makes straight lines of the scene, seen through a lens, and bent edges among them."""

    def make(
        lens: Brown,
        count: int = 60,
        *,
        seed: int = 0,
        noise: float = 0.05,
        bent: float = 0.0,
        through_center: bool = False,
        shortest: float = 100.0,
    ) -> Segments:
        """The first ``bent * count`` segments are arcs with a sagitta of 2 to 8 px, the others are straight lines."""
        generator = np.random.default_rng(seed)
        size = np.array([lens.width - 1, lens.height - 1])
        polylines: list[np.ndarray] = []
        while len(polylines) < count:
            ends = generator.uniform(0.03, 0.97, (2, 2)) * size
            if through_center:
                ends[1] = 2 * np.array(center_of(lens.width, lens.height)) - ends[0]
            length = float(np.hypot(*(ends[1] - ends[0])))
            if not shortest <= length <= 0.6 * lens.width:
                continue
            t = np.linspace(0, 1, int(length))[:, None]
            first, last = lens.undistort(ends)
            points = lens.distort(first + t * (last - first))
            across = np.array([ends[0, 1] - ends[1, 1], ends[1, 0] - ends[0, 0]]) / length
            offset = generator.normal(0, noise, (len(t), 1))
            if len(polylines) < bent * count:
                offset = offset + generator.choice([-1, 1]) * generator.uniform(2, 8) * 4 * t * (1 - t)
            polylines.append(points + offset * across)
        return Segments.from_list(polylines)

    return make
