"""Pictures for surfaces, made of noise: nothing in them is a straight edge, so nothing in them wants a label."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from app.synthesis.light import Colour, Light, rgb
from app.synthesis.noise import Pixels, layered_noise
from app.synthesis.walls import Walls, make_walls


def asphalt(rng: np.random.Generator, size: int) -> Pixels:
    """Factors for a road, ``(size, size)``: grain, stains and worn bands."""
    fine = rng.standard_normal((size, size), dtype=np.float32)
    return (1 + 0.03 * layered_noise(rng, size, size, 40, 4) + 0.028 * cv2.GaussianBlur(fine, (0, 0), 0.8)).astype(
        np.float32
    )


def paving(rng: np.random.Generator, size: int, slab: int) -> Pixels:
    """Factors for a pavement, ``(size, size)``: slabs that differ a little, too little for an edge."""
    slabs = rng.standard_normal((size // slab + 1, size // slab + 1), dtype=np.float32)
    steps = np.kron(slabs, np.ones((slab, slab), np.float32))[:size, :size]
    return (1 + 0.008 * steps + 0.025 * layered_noise(rng, size, size, 30, 4)).astype(np.float32)


def round_shading(width: int = 32, light_from: float = -0.4) -> Pixels:
    """Factors across a cylinder that is lit from one side (-1..1), ``(2, width)``."""
    across = np.linspace(-1, 1, width, dtype=np.float32)
    bright = 0.80 + 0.26 * np.clip(1 - (across - light_from) ** 2 / 1.6, 0, 1)
    return np.repeat(bright[None].astype(np.float32), 2, axis=0)


def fading_shadow(strength: float, from_top: bool = True, rows: int = 24) -> Pixels:
    """Black that fades out downwards (or upwards): the soft shadow under a ledge, RGBA ``(rows, 2, 4)``."""
    pixels = np.zeros((rows, 2, 4), np.float32)
    fade = np.linspace(1, 0, rows, dtype=np.float32) ** 1.5
    pixels[..., 3] = strength * (fade if from_top else fade[::-1])[:, None]
    return pixels


def blot(strength: float, size: int = 64, squareness: float = 2.0) -> Pixels:
    """A soft dark spot: shade under a car or a tree, RGBA ``(size, size, 4)``."""
    axis = np.abs(np.linspace(-1, 1, size, dtype=np.float32)) ** squareness
    distance = (axis[:, None] + axis[None]) ** (1 / squareness)
    pixels = np.zeros((size, size, 4), np.float32)
    pixels[..., :3] = (18, 20, 30)
    pixels[..., 3] = strength * np.clip((1 - distance) / 0.45, 0, 1)
    return pixels


def glow(colour: Colour, strength: float, size: int = 48) -> Pixels:
    """A halo around a lamp, RGBA ``(size, size, 4)``."""
    axis = np.linspace(-1, 1, size, dtype=np.float32)
    distance = np.hypot(axis[:, None], axis[None])
    pixels = np.zeros((size, size, 4), np.float32)
    pixels[..., :3] = colour
    pixels[..., 3] = strength * np.clip(1 - distance, 0, 1) ** 2
    return pixels


def panes(rng: np.random.Generator, light: Light, count: int) -> list[Pixels]:
    """Window glass, RGBA ``(40, 24, 4)`` each: dark rooms, mirrored sky, soft curtains, lamps at dusk."""
    made: list[Pixels] = []
    rows = np.linspace(0, 1, 40, dtype=np.float32)[:, None, None]
    columns = np.abs(np.linspace(-1, 1, 24, dtype=np.float32))[None, :, None]
    for _ in range(count):
        mirror = (0.3 if light.lamps else 0.5) * float(rng.uniform(0.6, 1.3))
        room = rgb(30, 36, 46) * float(rng.uniform(0.7, 1.4))
        sky = light.zenith * 0.55 + light.horizon * 0.45
        colour = room + mirror * np.clip(1.1 - rows - float(rng.uniform(0, 0.35)), 0, 1) * sky
        if rng.random() < 0.45:
            open_to = float(rng.uniform(0.35, 0.85))
            curtain = 1 / (1 + np.exp(-(columns - open_to) * 14))
            cloth = light.shade(rgb(214, 206, 194) * float(rng.uniform(0.6, 1.0)), (0, 0, -1), sunlit=False)
            colour = colour + 0.75 * curtain * (cloth - colour)
        if light.lamps and rng.random() < 0.4:
            warm = rgb(255, 206, 128) * float(rng.uniform(0.7, 1.0))
            colour = 0.25 * colour + 0.8 * warm * (1 - 0.45 * rows) * (1 - 0.2 * columns)
        pane = np.ones((40, 24, 4), np.float32)
        pane[..., :3] = np.broadcast_to(colour, (40, 24, 3)).clip(0, 255)
        made.append(pane)
    return made


def foliage(rng: np.random.Generator, light: Light, tint: Colour, size: int = 320) -> Pixels:
    """A tree's crown or a bush: clumps of leaves from dark to sunlit, RGBA ``(size, size, 4)``."""
    picture = np.zeros((size, size, 3), np.uint8)
    cover = np.zeros((size, size), np.uint8)
    turns, reach = rng.uniform(0, 2 * np.pi, 44), 0.62 * np.sqrt(rng.uniform(0, 1, 44))
    clumps = np.stack([reach * np.cos(turns), reach * np.sin(turns)], axis=1)
    sun = light.to_sun[:2] / max(float(np.linalg.norm(light.to_sun[:2])), 0.2)
    leaf = light.shade(tint, np.array([0.0, -0.55, -0.55]), sunlit=False)
    lit = light.shade(tint * rgb(1.25, 1.15, 0.75), light.to_sun) - leaf
    depth = np.repeat(np.linspace(0, 1, 30), 40)
    spread = rng.normal(0, 0.13, (len(depth), 2)).clip(-0.24, 0.24)
    places = clumps[rng.integers(len(clumps), size=len(depth))] + spread
    facing = 0.5 * places @ sun + 2.2 * spread @ sun + 0.25
    tones = 0.42 + 0.6 * depth + 0.1 * rng.standard_normal(len(depth))
    colours = leaf * tones[:, None] + lit * (facing.clip(0, 1) * depth)[:, None]
    colours *= rng.uniform(0.94, 1.06, colours.shape)
    radii = np.maximum(size * (0.030 - 0.019 * depth) * rng.uniform(0.7, 1.3, len(depth)), 1)
    for place, colour, radius in zip(((places + 1) / 2 * size).astype(int), colours.clip(0, 255), radii, strict=True):
        if np.abs(place - size / 2).max() < 0.44 * size:
            middle = (int(place[0]), int(place[1]))
            cv2.circle(picture, middle, int(radius), colour.tolist(), -1)
            cv2.circle(cover, middle, int(radius), 255, -1)
    pixels = np.empty((size, size, 4), np.float32)
    # colours reach one pixel beyond the leaves, or their soft rim would be black
    pixels[..., :3] = np.where(cover[..., None] > 0, picture, cv2.dilate(picture, np.ones((5, 5), np.uint8)))
    pixels[..., 3] = cv2.GaussianBlur(cover, (0, 0), 0.8).astype(np.float32) / 255
    return pixels


@dataclass(frozen=True, eq=False)
class Materials:
    """The pictures that one street uses, made once for all its images."""

    road: Pixels
    pavement: Pixels
    walls: Walls
    panes: tuple[Pixels, ...]
    crowns: tuple[Pixels, ...]
    bushes: tuple[Pixels, ...]


def make_materials(rng: np.random.Generator, light: Light) -> Materials:
    """Make a street's materials."""
    season = rgb(86, 122, 52) * np.float32(rng.uniform(0.85, 1.15))
    greens = [season * rgb(*rng.uniform(0.82, 1.18, 3)) for _ in range(5)]
    return Materials(
        road=asphalt(rng, 768),
        pavement=paving(rng, 512, 14),
        walls=make_walls(rng),
        panes=tuple(panes(rng, light, 10)),
        crowns=tuple(foliage(rng, light, green) for green in greens[:3]),
        bushes=tuple(foliage(rng, light, green * 0.9, size=192) for green in greens[3:]),
    )
