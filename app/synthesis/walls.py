"""Pictures of walls, made once for a street: plaster, brick and stone, each in three sizes.

Courses of bricks are straight, but their step of grey stays below that of a label: to be seen, not to be labelled.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from app.synthesis.geometry import Panel, Texture
from app.synthesis.noise import Pixels, layered_noise, smooth_noise

SIDE = 12.0  # m
_FINEST = 36.0  # px per m
_SCALES = (1.0, 0.4, 0.14)
_FINE_WITHIN, _COARSE_BEYOND = 11.0, 28.0  # m from the eye
_COURSE, _BRICK = 0.1, 0.3  # m


@dataclass(frozen=True, eq=False)
class Walls:
    """Factors on a wall's colour, ``(h, w)`` for `SIDE` by `SIDE` m, by kind: the finest first.

    Attributes:
        plaster: Blotches, rain streaks and a damp foot.
        brick: Courses of bricks that differ a little.
        stone: Blocks with rough faces.
    """

    plaster: tuple[Pixels, ...]
    brick: tuple[Pixels, ...]
    stone: tuple[Pixels, ...]


def make_walls(rng: np.random.Generator) -> Walls:
    """Make the walls of one street."""
    size = int(SIDE * _FINEST)
    foot = np.linspace(SIDE, 0, size, dtype=np.float32)[:, None]
    damp = 0.13 * np.exp(-foot / 0.7) + 0.06 * np.exp(-foot / 3.0)
    streaks = cv2.resize(smooth_noise(rng, max(size // 24, 2), size, 3.0), (size, size))
    grain = cv2.GaussianBlur(rng.standard_normal((size, size), dtype=np.float32), (0, 0), 0.9)
    rough = layered_noise(rng, size, size, _FINEST * 1.6, 6)
    plaster = 1.03 + 0.026 * rough + 0.016 * streaks + 0.03 * grain - damp
    brick = 1.02 + _courses(rng, size) + 0.02 * rough + 0.05 * grain - 0.6 * damp
    stone = 1.02 + 0.05 * layered_noise(rng, size, size, _FINEST * 0.5, 5) + 0.012 * streaks + 0.05 * grain - damp
    return Walls(_in_sizes(plaster), _in_sizes(brick), _in_sizes(stone))


def on_wall(panel: Panel, pictures: tuple[Pixels, ...], distance: float, shift: float) -> Texture:
    """Lay a wall's picture on a panel, its foot on the ground, moved along by `shift` m; the farther the coarser."""
    level = 0 if distance < _FINE_WITHIN else 1 if distance < _COARSE_BEYOND else 2
    pixels = pictures[level]
    step = SIDE / len(pixels)
    corner = panel.point(step / 2 - shift, SIDE - step / 2)
    return Texture(pixels, corner, panel.along * step, np.array([0.0, step, 0.0]))


def _courses(rng: np.random.Generator, size: int) -> Pixels:
    """Bricks in running bond: each of its own tone, with pale mortar between."""
    v, u = np.divmod(np.arange(size * size).reshape(size, size), size)
    row = (v / (_COURSE * _FINEST)).astype(np.int64)
    along = u / (_BRICK * _FINEST) + 0.5 * (row % 2)
    tones = rng.normal(0, 0.045, (row.max() + 1, int(along.max()) + 1)).astype(np.float32)
    bricks = tones[row, along.astype(np.int64)]
    mortar = ((v / (_COURSE * _FINEST)) % 1 < 0.16) | (along % 1 < 0.06)
    return np.where(mortar, np.float32(0.09), bricks)


def _in_sizes(picture: NDArray[Any]) -> tuple[Pixels, ...]:
    finest = np.asarray(picture, np.float32)
    return tuple(
        np.asarray(cv2.resize(finest, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA), np.float32)
        for scale in _SCALES
    )
