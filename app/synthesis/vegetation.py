"""Trees and bushes: outlines that no straight edge fits."""

from __future__ import annotations

import numpy as np

from app.synthesis.geometry import Drawing, Panel, Texture, texture_on
from app.synthesis.light import Light, rgb
from app.synthesis.road import KERB
from app.synthesis.textures import Materials, blot, round_shading

_ACROSS = np.array([1.0, 0.0, 0.0])
_TOWARDS = np.array([0.0, 0.0, -1.0])


def draw_tree(
    drawing: Drawing, x: float, z: float, height: float, light: Light, materials: Materials, seed: int
) -> None:
    """Draw a tree of a height in m: a crooked trunk, two boughs and a crown of a few clumps."""
    rng = np.random.default_rng(seed)
    crown = height * float(rng.uniform(0.56, 0.66))
    fork = height - crown * 0.72
    bark = light.shade(rgb(98, 80, 64), _TOWARDS, sunlit=False)
    rise = np.linspace(0, 1, 13)
    bend = rng.uniform(0.16, 0.3) * np.sin(rise * rng.uniform(3, 5)) * rng.choice([-1.0, 1.0])
    lean = bend + float(rng.normal(0, 0.2)) * rise**2
    _draw_limb(drawing, x + lean, KERB + rise * (fork + 0.6 - KERB), z, 0.16, bark)
    for side in (-1, 1):
        reach = side * float(rng.uniform(0.5, 0.9))
        bough = x + lean[-1] + reach * np.linspace(0, 1, 4) ** 1.5
        _draw_limb(drawing, bough, np.linspace(fork, fork + crown * 0.4, 4), z, 0.08, bark)
    middle = x + lean[-1]
    clumps = [(0.0, 0.04, 1.0), (-0.24, -0.10, 0.66), (0.25, -0.07, 0.7), (0.04, -0.16, 0.6)]
    for across, up, size in clumps:
        picture = materials.crowns[int(rng.integers(len(materials.crowns)))]
        if rng.random() < 0.5 and abs(light.to_sun[0]) < 0.3:
            picture = np.ascontiguousarray(picture[:, ::-1])
        wide = crown * size * float(rng.uniform(0.95, 1.1))
        centre = np.array([middle + across * crown, -(height - crown / 2 + up * crown), z - 0.02 * size])
        sprite = Panel(centre, _ACROSS, _TOWARDS).rectangles([-wide / 2, -wide / 2, wide / 2, wide / 2])
        drawing.paint(sprite, (0, 0, 0), textures=[texture_on(sprite[0], picture)])
    turn = np.linspace(0, 2 * np.pi, 40)
    outline = np.stack([0.45 * np.cos(turn), 0.45 * np.sin(turn), np.zeros(40)], axis=1) * crown
    drawing.curve(outline + np.array([middle, -(height - crown / 2), z]), "tree crown")


def _draw_limb(drawing: Drawing, x: np.ndarray, heights: np.ndarray, z: float, half: float, colour: np.ndarray) -> None:
    widths = half * (0.75 + 0.8 * np.linspace(1, 0, len(x)) ** 2.5)
    pieces = np.stack(
        [
            np.stack([x[1:] - widths[1:], -heights[1:], np.full(len(x) - 1, z)], axis=1),
            np.stack([x[1:] + widths[1:], -heights[1:], np.full(len(x) - 1, z)], axis=1),
            np.stack([x[:-1] + widths[:-1], -heights[:-1], np.full(len(x) - 1, z)], axis=1),
            np.stack([x[:-1] - widths[:-1], -heights[:-1], np.full(len(x) - 1, z)], axis=1),
        ],
        axis=1,
    )
    shade = round_shading(16)
    drawing.paint(pieces, colour, textures=[texture_on(piece, shade) for piece in pieces], margin=0.3)
    outline = np.stack([x - widths, -heights, np.full(len(x), z)], axis=1)
    drawing.curve(outline, "tree trunk")


def draw_bush(drawing: Drawing, x: float, z: float, size: float, materials: Materials, seed: int) -> None:
    """Draw a bush about `size` m wide."""
    rng = np.random.default_rng(seed)
    picture = materials.bushes[int(rng.integers(len(materials.bushes)))]
    for shift in (-0.3, 0.32, 0.0):
        wide = size * float(rng.uniform(0.7, 0.95))
        centre = np.array([x + shift * size, -KERB - 0.36 * wide, z - 0.05 * abs(shift)])
        sprite = Panel(centre, _ACROSS, _TOWARDS).rectangles([-wide / 2, -wide / 2, wide / 2, wide / 2])
        drawing.paint(sprite, (0, 0, 0), textures=[texture_on(sprite[0], picture)])


def draw_tree_shadow(drawing: Drawing, x: float, z: float, height: float, light: Light, materials: Materials) -> None:
    """Dapple the ground where a crown keeps the sun off (or a soft blot where there is none)."""
    centre = np.array([x, -0.62 * height, z])
    size = 0.6 * height
    if light.shadow is None:
        picture, middle = blot(0.22), np.array([x, 0.0, z])
    else:
        picture = materials.crowns[0].copy()
        picture[..., :3] = 24, 26, 38
        picture[..., 3] *= 0.46
        reach = -centre[1] / light.to_sun[1]
        middle = centre + reach * light.to_sun
    shade = np.array([[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]]) * size / 2 * 1.15
    corners = middle * np.array([1.0, 0.0, 1.0]) + shade
    drawing.paint(corners, (0, 0, 0), textures=[texture_on(corners, picture)])


def dark_spot(middle: np.ndarray, half: tuple[float, float], strength: float) -> tuple[np.ndarray, Texture]:
    """A soft dark patch on the ground below something: corners ``(4, 3)`` and its picture."""
    corners = middle + np.array([[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]]) * np.array([half[0], 0, half[1]])
    return corners, texture_on(corners, blot(strength, squareness=4.0))
