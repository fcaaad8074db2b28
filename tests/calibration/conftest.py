"""Lines of a scene through a known lens."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from app.calibration.calibrate import CalibrationImage
from app.calibration.lens import CameraLens
from app.vision.segments import Segments

LinesThrough = Callable[..., list[CalibrationImage]]


@pytest.fixture
def lines_through() -> LinesThrough:
    """Return a function that draws straight lines, as a lens shows them, over some images of a camera."""

    def draw(
        lens: CameraLens,
        number: int,
        *,
        images: int = 3,
        noise: float = 0.1,
        seed: int = 0,
        bent: int = 0,
        left: float = 0.02,
        right: float = 0.98,
        angles: tuple[float, float] = (0.0, np.pi),
    ) -> list[CalibrationImage]:
        """Draw `number` lines; the first `bent` ones aren't straight; middles lie between shares of the width."""
        rng = np.random.default_rng(seed)
        size = np.array([lens.width - 1.0, lens.height - 1.0])
        found: list[list[np.ndarray]] = [[] for _ in range(images)]
        done = 0
        while done < number:
            share = np.array([rng.uniform(left, right), rng.uniform(0.02, 0.98)])
            angle, length = rng.uniform(*angles), rng.uniform(100, 300)
            along = np.array([np.cos(angle), np.sin(angle)])
            t = np.arange(-length / 2, length / 2)
            path = lens.undistort(share * size) + t[:, None] * along
            if done < bent:
                path += np.outer(20 * (2 * t / length) ** 2, [-along[1], along[0]])
            points = lens.distort(path)
            if np.isfinite(points).all() and (points >= 0).all() and (points <= size).all():
                points += noise * rng.normal(size=(len(points), 1)) * [-along[1], along[0]]
                found[done % images].append(points)
                done += 1
        return [CalibrationImage(f"image {index}", Segments.from_list(each)) for index, each in enumerate(found)]

    return draw
