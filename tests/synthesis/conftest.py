"""One scene for all tests that look at a whole one, without noise."""

from __future__ import annotations

import numpy as np
import pytest

from app.synthesis import Lens, Sensor, SyntheticScene, make_lens, synthesize_scene
from app.synthesis.camera import Pose
from app.synthesis.sensor import LensMap, map_lens

WIDTH, HEIGHT = 800, 450


@pytest.fixture(scope="session")
def barrel() -> Lens:
    """A clearly distorting lens."""
    return make_lens(WIDTH, HEIGHT, 0.7 * WIDTH, [-0.3, 0.12, 0.001, -0.0008, -0.02])


@pytest.fixture(scope="session")
def barrel_map(barrel: Lens) -> LensMap:
    return map_lens(barrel)


@pytest.fixture(scope="session")
def scene(barrel: Lens) -> SyntheticScene:
    """A street by day, with shadows, through the distorting lens."""
    quiet = Sensor(blur=0.8, vignetting=0.0, noise=0.0, photon_noise=0.0)
    return synthesize_scene(8 * 5, width=WIDTH, height=HEIGHT, lens=barrel, sensor=quiet)


@pytest.fixture(scope="session")
def level() -> Pose:
    """A camera at the origin that looks straight down the street."""
    return Pose(np.zeros(3))
