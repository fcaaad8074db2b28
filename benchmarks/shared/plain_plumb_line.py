"""Plain plumb line, after Devernay and Faugeras 2001, "Straight lines have to be straight".

The sum of squared distances of corrected points from their lines, in the corrected image, is minimised over k1, k2, p1,
p2 and the centre, one after the other set free as there, by SciPy's Levenberg-Marquardt. No priors, no robust loss, no
weights: a peer to compare with, not part of the product.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import least_squares

from app.vision.brown import map_points
from app.vision.frame import center_of, half_diagonal
from app.vision.segments import Segments

Array = NDArray[np.float64]

STAGES = ((0,), (0, 5, 6), (0, 1, 5, 6))
"""Indices of k1, k2, k3, p1, p2, cx, cy that are free, stage by stage."""
EVERY = 4
"""Every so many points of a line are used where it has more than `FEW`."""
FEW = 24


class PlumbLine:
    """The lens that was found, in the model of `app.vision.brown`."""

    def __init__(self, segments: Sequence[Segments], width: int, height: int) -> None:
        self.center, self.scale = np.array(center_of(width, height)), half_diagonal(width, height)
        chosen = [line[:: EVERY if len(line) > FEW else 1] for image in segments for line in image if len(line) > 2]
        self._points = (np.concatenate(chosen).astype(np.float64) - self.center) / self.scale
        self._starts = np.concatenate([[0], np.cumsum([len(line) for line in chosen])[:-1]])
        self._counts = np.array([len(line) for line in chosen])
        self.parameters = np.zeros(7)
        for free in STAGES:
            self.parameters = self._stage(list(free))

    def undistort(self, points: ArrayLike) -> Array:
        """Map measured points ``(N, 2)`` in px to corrected ones."""
        x, y = ((np.asarray(points, np.float64).reshape(-1, 2) - self.center) / self.scale).T
        mapped = map_points(self.parameters, x, y)
        return self.center + self.scale * np.stack([mapped.x, mapped.y], -1)

    def _stage(self, free: list[int]) -> Array:
        def distances(values: Array) -> Array:
            parameters = self.parameters.copy()
            parameters[free] = values
            return self._distances(parameters)

        found = self.parameters.copy()
        found[free] = least_squares(distances, self.parameters[free], method="lm", max_nfev=60 * len(free)).x
        return found

    def _distances(self, parameters: Array) -> Array:
        mapped = map_points(parameters, *self._points.T)
        rows = np.repeat(np.arange(len(self._counts)), self._counts)
        u, v = (
            values - (np.add.reduceat(values, self._starts) / self._counts)[rows] for values in (mapped.x, mapped.y)
        )
        xx, xy, yy = (np.add.reduceat(values, self._starts) for values in (u * u, u * v, v * v))
        angle = (0.5 * np.arctan2(2 * xy, xx - yy))[rows]
        return self.scale * (v * np.cos(angle) - u * np.sin(angle))
