"""People on the pavement and on crossings: rounded all over, so that they hide edges and have none."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from app.synthesis.geometry import Drawing, Points
from app.synthesis.light import Colour, Light, rgb
from app.synthesis.vegetation import dark_spot

CLOTHES: tuple[tuple[int, int, int], ...] = (
    (38, 42, 54), (142, 44, 48), (58, 84, 120), (196, 190, 176), (70, 92, 66), (208, 160, 62), (112, 96, 132),
    (222, 222, 220), (90, 70, 58),
)  # fmt: skip
SKIN: tuple[tuple[int, int, int], ...] = ((224, 180, 150), (196, 144, 110), (140, 96, 70), (92, 62, 48))
_TOWARDS = np.array([0.0, 0.0, -1.0])
_ROUND = np.linspace(0, 2 * np.pi, 22, endpoint=False)


def draw_person(
    drawing: Drawing, x: float, z: float, height: float, ground: float, light: Light, rng: np.random.Generator
) -> None:
    """Draw a person of a height in m who stands or walks at (x, z), `ground` m above the road."""
    scale = height / 1.75
    top, trousers, skin, hair = (
        light.shade(rgb(*choices[int(rng.integers(len(choices)))]), _TOWARDS, sunlit=False)
        for choices in (CLOTHES, CLOTHES, SKIN, ((40, 32, 28), (96, 66, 42), (170, 160, 150)))
    )
    spot, picture = dark_spot(np.array([x, -ground - 0.004, z]), (0.36, 0.22), 0.5)
    drawing.paint(spot, (0, 0, 0), textures=[picture])
    stride, swing = float(rng.uniform(-0.3, 0.3)), float(rng.uniform(-0.16, 0.16))

    def at(across: Points, up: Points) -> Points:
        return np.stack([x + scale * across, -ground - scale * up, np.full(len(across), z)], axis=1)

    for side in (-1, 1):
        foot = side * stride
        _limb(drawing, at, (side * 0.07, 0.9), (foot * 0.5, 0.48), (foot, 0.04), (0.085, 0.06), trousers)
        drawing.paint(at(foot + 0.05 + 0.12 * np.cos(_ROUND), 0.05 + 0.05 * np.sin(_ROUND)), trousers * 0.45)
        _limb(
            drawing, at, (side * 0.19, 1.42), (side * 0.24 + swing * 0.4 * side, 1.15),
            (side * 0.2 + swing * side, 0.88), (0.058, 0.045), top * 0.88,
        )  # fmt: skip
    up = np.linspace(0.82, 1.5, 14)
    half = 0.155 + 0.055 * np.sin((up - 0.82) / 0.68 * np.pi * 0.8) - 0.13 * np.clip((up - 1.4) / 0.1, 0, 1) ** 2
    torso = at(np.concatenate([half, -half[::-1]]), np.concatenate([up, up[::-1]]))
    for low, high in zip(range(13), range(1, 14), strict=True):
        drawing.paint(torso[[low, high, -1 - high, -1 - low]], top, margin=0.3)
    drawing.curve(torso[:14], "person")
    drawing.curve(torso[14:], "person")
    drawing.paint(at(0.05 * np.cos(_ROUND), 1.52 + 0.07 * np.sin(_ROUND)), skin * 0.85)
    drawing.paint(at(0.098 * np.cos(_ROUND), 1.64 + 0.125 * np.sin(_ROUND)), hair)
    drawing.paint(at(0.078 * np.cos(_ROUND), 1.615 + 0.095 * np.sin(_ROUND)), skin)
    outline = np.append(_ROUND, 0.0)
    drawing.curve(at(0.098 * np.cos(outline), 1.64 + 0.125 * np.sin(outline)), "person")


def _limb(
    drawing: Drawing,
    at: Callable[[Points, Points], Points],
    start: tuple[float, float],
    middle: tuple[float, float],
    end: tuple[float, float],
    halves: tuple[float, float],
    colour: Colour,
) -> None:
    """An arm or a leg: a bent band (a Bézier curve of three points) that grows thinner."""
    t = np.linspace(0, 1, 9)[:, None]
    points = (
        (1 - t) ** 2 * np.array(start)
        + 2 * t * (1 - t) * (2 * np.array(middle) - (np.array(start) + np.array(end)) / 2)
        + t**2 * np.array(end)
    )
    half = (halves[0] * (1 - t) + halves[1] * t)[:, 0] * (1 + 0.12 * np.sin(3 * t[:, 0]))
    left, right = at(points[:, 0] - half, points[:, 1]), at(points[:, 0] + half, points[:, 1])
    drawing.paint(np.stack([left[:-1], right[:-1], right[1:], left[1:]], axis=1), colour, margin=0.3)
    drawing.curve(left, "person")
    drawing.curve(right, "person")
