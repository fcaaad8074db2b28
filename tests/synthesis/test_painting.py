"""The kernel that paints, in cases small enough to be worked out beside it."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from app.synthesis.camera import Pose
from app.synthesis.geometry import Drawing, Texture
from app.synthesis.light import rgb
from app.synthesis.projection import View
from app.synthesis.rasteriser import Haze, Picture, rasterise

WIDTH, HEIGHT = 48, 36
VIEW = View(Pose(np.zeros(3)), np.eye(3), WIDTH, HEIGHT)  # at 1 m, street coordinates are px
CLEAR = Haze(rgb(0, 0, 0), 1e9)
BLACK = np.zeros((3, HEIGHT, WIDTH), np.float32)


def polygon(points: list[list[float]], z: float = 1.0) -> NDArray[np.float64]:
    """Corners in px, at a depth in m."""
    return np.array([[x * z, y * z, z] for x, y in points])


def paint(drawing: Drawing, background: NDArray[np.float32] = BLACK, haze: Haze = CLEAR) -> Picture:
    return rasterise(drawing, VIEW, background, haze)


def on_pixels(pixels: NDArray[np.float32], step: float, x: float, y: float) -> Texture:
    """A texture whose first texel is at px (x, y), each `step` px wide."""
    return Texture(pixels, np.array([x, y, 1.0]), np.array([step, 0, 0]), np.array([0, step, 0]))


def whole(texture: Texture | None = None, opacity: float = 1.0) -> Drawing:
    drawing = Drawing()
    frame = polygon([[-9, -9], [WIDTH + 9, -9], [WIDTH + 9, HEIGHT + 9], [-9, HEIGHT + 9]])
    textures = None if texture is None else [texture]
    drawing.paint(frame, (100, 10, 1), textures=textures, opacity=opacity)
    return drawing


def test_a_pixels_share_is_its_least_distance_to_an_edge() -> None:
    corners = [[5.3, 3.1], [40.2, 8.7], [31.5, 30.4], [9.9, 24.25]]
    drawing = Drawing()
    drawing.paint(polygon(corners), (100, 100, 100))
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    share = np.ones((HEIGHT, WIDTH))
    for (x0, y0), (x1, y1) in zip(corners, corners[1:] + corners[:1], strict=True):
        width = abs(x1 - x0) + abs(y1 - y0)
        share = np.minimum(share, ((x1 - x0) * (y - y0) - (y1 - y0) * (x - x0)) / width + 0.5)
    picture = paint(drawing)
    assert np.allclose(picture.colours[..., 0], 100 * share.clip(0), atol=1e-4)
    assert np.array_equal(picture.surface, share >= 0.5)


def test_texels_are_mixed_by_their_distance_and_mirrored_beyond_the_border() -> None:
    row = np.array([[1.0, 0.5, 0.0]], np.float32)
    grey = paint(whole(on_pixels(row, 2.0, 20.0, 10.0))).colours[10, :, 0]
    assert np.allclose(grey[20:25], [100, 75, 50, 25, 0], atol=1e-3)
    # two texels of the border have one value, so what is between them has too
    assert np.allclose(grey[[24, 25, 26, 28, 30, 32]], [0, 0, 0, 50, 100, 100], atol=1e-3)
    assert np.allclose(grey[12:], grey[:-12], atol=1e-3)


def test_a_texture_far_from_its_first_texel_is_the_same_pattern() -> None:
    pixels = np.random.default_rng(3).random((5, 7), dtype=np.float32)
    here = paint(whole(on_pixels(pixels, 1.0, 3.0, 2.0))).colours
    periods = paint(whole(on_pixels(pixels, 1.0, 3.0 - 14 * 60, 2.0 + 10 * 40))).colours
    assert np.allclose(here, periods, atol=0.02)
    assert np.allclose(here[2:7, 3:10, 0], 100 * pixels, atol=1e-3)


def test_a_coloured_texture_brings_its_own_opacity() -> None:
    pixels = np.zeros((2, 2, 4), np.float32)
    pixels[:] = 40, 80, 120, 0.25
    picture = paint(whole(on_pixels(pixels, 1.0, 0.0, 0.0)), BLACK + 20)
    assert np.allclose(picture.colours, [25, 35, 45], atol=1e-4)
    assert not picture.surface.any()


def test_haze_follows_the_depth_of_a_slanted_surface() -> None:
    drawing = Drawing()
    # inverse depth falls from 1 / m at the left to 1 / 50 at the right
    left, right = 1.0, 50.0
    corners = [[0, 0, left], [WIDTH * right, 0, right], [WIDTH * right, HEIGHT * right, right], [0, HEIGHT, left]]
    drawing.paint(np.array(corners, float), (200, 200, 200))
    row = paint(drawing, haze=Haze(rgb(50, 50, 50), 20.0)).colours[HEIGHT // 2, 1:, 0]
    inverse = 1 / left + (1 / right - 1 / left) * np.arange(1, WIDTH) / WIDTH
    assert np.allclose(row, 50 + 150 * np.exp(-1 / (20 * inverse)), atol=1e-3)


@pytest.mark.parametrize("seed", range(6))
def test_leaving_out_what_is_hidden_changes_nothing(seed: int) -> None:
    """Painted one at a time, no surface knows of later ones, and each is painted whole."""
    rng = np.random.default_rng(seed)
    factors, colours = rng.random((9, 9), np.float32), rng.random((9, 9, 4), np.float32)
    together, colours_so_far, shown, count = Drawing(), BLACK + 30, np.zeros((HEIGHT, WIDTH), np.int32), 0
    for _ in range(40):
        middle, reach = rng.uniform([0, 0], [WIDTH, HEIGHT]), rng.uniform(2, 30)
        turns = np.sort(rng.uniform(0, 2 * np.pi, rng.integers(3, 7)))
        corners = polygon((middle + reach * np.stack([np.cos(turns), np.sin(turns)], 1)).tolist())
        pixels = (None, factors, colours)[rng.integers(3)]
        textures = None if pixels is None else [on_pixels(pixels, 3.0, *rng.uniform(-20, 20, 2))]
        alone = Drawing()
        alone.paint(corners, rng.uniform(0, 255, 3), textures=textures, opacity=float(rng.choice([0.6, 1.0, 1.0])))
        together.extend(alone)
        step = paint(alone, colours_so_far)
        colours_so_far = np.moveaxis(step.colours, 2, 0)
        count += len(step.planes) - 1
        shown = np.where(step.surface > 0, count, shown)
    picture = paint(together, BLACK + 30)
    assert np.allclose(picture.colours, np.moveaxis(colours_so_far, 0, 2), atol=1e-2)
    assert np.array_equal(picture.surface, shown)
