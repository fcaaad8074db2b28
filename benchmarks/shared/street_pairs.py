"""Two views of a synthetic street each, through one known lens, with the true pose between them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from app.synthesis.camera import Pose
from app.synthesis.lens import Lens, make_lens
from app.synthesis.light import TIMES_OF_DAY
from app.synthesis.planning import plan_street
from app.synthesis.poses import EYE_HEIGHT
from app.synthesis.scene import photograph
from app.synthesis.sensor import Sensor, map_lens

Array = NDArray[np.float64]

WIDTH, HEIGHT = 960, 540
LENSES = {
    "plain": (0.75, (-0.08, 0.02, 0.0, 0.0, 0.0)),
    "barrel": (0.70, (-0.26, 0.10, 0.0005, -0.0004, -0.015)),
    "wide": (0.66, (-0.38, 0.19, -0.0006, 0.0005, -0.035)),
}
"""Focal length in image widths and k1, k2, p1, p2, k3 of each camera."""


@dataclass(frozen=True, eq=False)
class StreetPair:
    """Two photos of a street.

    Attributes:
        first: uint8 ``(H, W)``.
        second: Likewise, taken a step later.
        rotation: float64 ``(3, 3)``, from the first camera's axes to the second's.
        way: float64 ``(3,)`` m, origin of the first camera in the axes of the second.
    """

    first: NDArray[np.uint8]
    second: NDArray[np.uint8]
    rotation: Array
    way: Array


def lens_named(name: str) -> Lens:
    """Return one of `LENSES`."""
    share, coefficients = LENSES[name]
    return make_lens(WIDTH, HEIGHT, share * WIDTH, coefficients)


def street_pairs(lens: Lens, count: int, first_seed: int) -> Iterator[StreetPair]:
    """Drive into a bend in one street after the other: 1.5 to 3 m on, and 2 to 8 degrees to either side."""
    lens_map = map_lens(lens)
    for seed in range(first_seed, first_seed + count):
        rng = np.random.default_rng([seed, 77])
        street = plan_street(seed, TIMES_OF_DAY[seed % len(TIMES_OF_DAY)])
        yaw, turn = rng.normal(0, 0.05), np.deg2rad(rng.uniform(2, 8)) * rng.choice([-1, 1])
        step = rng.uniform(1.5, 3.0)
        start = np.array([street.lane, -EYE_HEIGHT, 0.0])
        ahead = start + step * np.array([np.sin(yaw + turn / 2), 0.0, np.cos(yaw + turn / 2)])
        poses = (
            Pose(start, float(yaw), 0.03 + float(rng.normal(0, 0.01)), float(rng.normal(0, 0.008))),
            Pose(ahead, float(yaw + turn), 0.03 + float(rng.normal(0, 0.01)), float(rng.normal(0, 0.008))),
        )
        images = [
            np.asarray(
                cv2.cvtColor(photograph(street, pose, lens_map, Sensor(), rng).image, cv2.COLOR_BGR2GRAY), np.uint8
            )
            for pose in poses
        ]
        rotation = poses[1].rotation @ poses[0].rotation.T
        yield StreetPair(images[0], images[1], rotation, poses[1].to_camera(poses[0].position))
