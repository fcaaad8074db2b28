"""Where pictures of a street are taken from: a car in its lane, or a walker's hands."""

from __future__ import annotations

import numpy as np

from app.synthesis.camera import Pose
from app.synthesis.street import Street

EYE_HEIGHT = 1.6  # m


def driving_pose(street: Street, forward: float, rng: np.random.Generator) -> Pose:
    """Put the camera into its lane, looking down the street as a driving car does: not quite."""
    yaw, pitch, roll = rng.normal(0, [0.035, 0.012, 0.008]).clip(-0.09, 0.09)
    position = np.array([street.lane + float(rng.normal(0, 0.12)), -EYE_HEIGHT, forward])
    return Pose(position, float(yaw), float(pitch) + 0.03, float(roll))


def walking_pose(street: Street, rng: np.random.Generator) -> Pose:
    """Put the camera into a walker's hands, who turns to one side of the street and perhaps looks up."""
    position = np.array([street.lane * float(rng.uniform(-1.3, 1.3)), -EYE_HEIGHT, float(rng.uniform(-2, 4))])
    # from the left half one sees more of the right side, and the other way round
    yaw = float(-np.sign(position[0]) * rng.uniform(0.1, 0.6))
    return Pose(position, yaw, float(rng.uniform(0.0, 0.16)), float(rng.normal(0, 0.012)))
