"""Candidates that are made of straight lines, and a picture of them."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from app.vision import Segments

Ends = Sequence[tuple[tuple[float, float], tuple[float, float]]]
Lines = Callable[..., Segments]


@pytest.fixture(scope="session")
def lines() -> Lines:
    """Make segments of a point per px between ends ``((x, y), (x, y))``."""

    def make(ends: Ends, scores: Sequence[float] | None = None) -> Segments:
        polylines = []
        for start, end in ends:
            length = float(np.hypot(end[0] - start[0], end[1] - start[1]))
            polylines.append(np.linspace(start, end, max(2, round(length) + 1)))
        return Segments.from_list(polylines, None if scores is None else np.array(scores))

    return make


@pytest.fixture(scope="session")
def facade(lines: Lines) -> tuple[Segments, NDArray[np.uint8]]:
    """Return 36 candidates on a picture of 640 x 480 with windows, a pole and stray lines."""
    random = np.random.default_rng(5)
    gray = np.full((480, 640), 120, np.uint8)
    ends = []
    for row in range(2):
        for column in range(4):
            x, y = 90 + 120 * column, 80 + 170 * row
            cv2.rectangle(gray, (x, y), (x + 70, y + 110), 40, -1)
            ends += [((x, y), (x, y + 110)), ((x + 70, y), (x + 70, y + 110)), ((x, y), (x + 70, y))]
    ends += [tuple(map(tuple, random.uniform([40, 40], [600, 440], (2, 2)))) for _ in range(12)]
    gray = np.clip(gray + random.normal(0, 2, gray.shape), 0, 255).astype(np.uint8)
    return lines(ends, random.uniform(0.1, 0.9, len(ends))), gray
