"""A camera without distortion: square pixels, no skew; and how directions and vanishing points follow each other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Pinhole:
    """Lengths in half diagonals.

    Attributes:
        focal: Focal length.
        center: float64 ``(2,)``, principal point from the image centre.
    """

    focal: float
    center: Array

    def vanishing(self, rays: Array) -> Array:
        """Return where directions ``(..., 3)`` in the camera's axes vanish, unit vectors over the image plane."""
        vectors = np.empty(rays.shape)
        vectors[..., :2] = self.focal * rays[..., :2] + rays[..., 2:] * self.center
        vectors[..., 2] = rays[..., 2]
        return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)

    def rays(self, vectors: Array) -> Array:
        """Return the directions, unit vectors in the camera's axes, that vanish at points ``(..., 3)``."""
        rays = np.empty(vectors.shape)
        rays[..., :2] = vectors[..., :2] - vectors[..., 2:] * self.center
        rays[..., 2] = self.focal * vectors[..., 2]
        return rays / np.linalg.norm(rays, axis=-1, keepdims=True)

    def moved(self, step: Array) -> Pinhole:
        """Return it after a step ``(3,)`` of log focal length and principal point."""
        return Pinhole(float(self.focal * np.exp(step[0])), self.center + step[1:])
