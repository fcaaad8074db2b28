"""The way a street takes over the ground: straight at first, then perhaps along an arc, then straight on."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from app.synthesis.geometry import Points


@dataclass(frozen=True)
class Bend:
    """A street's axis: x = 0 in the street's own plan is a line and an arc on the ground.

    Attributes:
        curvature: Of the arc in 1/m, positive to the right; 0 for a straight street.
        begins: Where the arc begins, m along the axis.
        ends: Where it ends, m along the axis.
    """

    curvature: float = 0.0
    begins: float = 0.0
    ends: float = 0.0

    def heading(self, z: ArrayLike) -> Points:
        """Direction of the axis z m along it, rad to the right of the street's beginning."""
        return self.curvature * (np.clip(np.asarray(z, float), self.begins, self.ends) - self.begins)

    def place(self, x: ArrayLike, z: ArrayLike, height: ArrayLike = 0.0) -> Points:
        """Where a point of the plan lies: x m to the right of the axis, z m along it, ``(..., 3)``."""
        x, z, height = np.broadcast_arrays(np.asarray(x, float), np.asarray(z, float), np.asarray(height, float))
        turn = self.heading(z)
        straight = z - np.clip(z, self.begins, self.ends) + self.begins
        if self.curvature:
            across, ahead = (1 - np.cos(turn)) / self.curvature, np.sin(turn) / self.curvature
        else:
            across, ahead = np.zeros_like(z), np.clip(z, self.begins, self.ends) - self.begins
        beyond = np.maximum(straight - self.begins, 0)
        before = np.minimum(straight, self.begins)
        return np.stack(
            [
                across + beyond * np.sin(turn) + x * np.cos(turn),
                -height + 0.0 * x,
                before + ahead + beyond * np.cos(turn) - x * np.sin(turn),
            ],
            axis=-1,
        )

    def is_straight(self, z0: float, z1: float) -> bool:
        """Whether the axis has one direction from z0 to z1."""
        return self.curvature == 0 or z1 <= self.begins or z0 >= self.ends

    def pieces(self, z0: float, z1: float) -> list[tuple[float, float, bool]]:
        """Cut a way along the axis where the arc begins and ends: from, to, and whether it is straight."""
        if self.is_straight(z0, z1):
            return [(z0, z1, True)]
        cuts = [z0, *(z for z in (self.begins, self.ends) if z0 < z < z1), z1]
        return [(a, b, self.is_straight(a, b)) for a, b in pairwise(cuts)]

    def steps(self, z0: float, z1: float, step: float = 1.5) -> Points:
        """Places along the axis from z0 to z1, ``(n,)``: close together on the arc, none between on a straight."""
        places = [np.array([z0])]
        for a, b, straight in self.pieces(z0, z1):
            count = 1 if straight else max(int(np.ceil((b - a) / step)), 2)
            places.append(np.linspace(a, b, count + 1)[1:])
        return np.concatenate(places)


STRAIGHT = Bend()
