"""Smooth noise: what everything uneven is made of. Nothing in it is a straight edge, so nothing in it wants a label."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

Pixels = NDArray[np.float32]


def smooth_noise(rng: np.random.Generator, height: int, width: int, grain: float) -> Pixels:
    """Noise of mean 0 and sd 1 whose features are about `grain` px wide, float32 ``(height, width)``."""
    rows, columns = int(np.ceil(height / grain)) + 3, int(np.ceil(width / grain)) + 3
    coarse = rng.standard_normal((rows, columns), dtype=np.float32)
    fine = cv2.resize(coarse, None, fx=grain, fy=grain, interpolation=cv2.INTER_CUBIC)[:height, :width]
    return (fine - fine.mean()) / max(float(fine.std()), 1e-6)


def layered_noise(rng: np.random.Generator, height: int, width: int, grain: float, layers: int) -> Pixels:
    """A sum of noises, each of half the grain and 0.6 times the strength, mean 0 and sd about 1."""
    total = np.zeros((height, width), np.float32)
    weights = 0.6 ** np.arange(layers)
    for layer, weight in enumerate(weights):
        total += np.float32(weight) * smooth_noise(rng, height, width, max(grain / 2**layer, 1.0))
    return total / np.float32(np.sqrt((weights**2).sum()))
