from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.synthesis.geometry import Drawing, Panel, clip_convex, texture_on

SQUARE = np.array([[0.0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0]])


def area(polygon: np.ndarray) -> float:
    return float(np.linalg.norm(np.cross(polygon, np.roll(polygon, -1, axis=0)).sum(axis=0)) / 2)


@given(st.floats(0.01, 1.99))
def test_clipping_keeps_the_part_beyond_the_plane(offset: float) -> None:
    clipped = clip_convex(SQUARE, np.array([1.0, 0, 0]), offset)
    assert clipped[:, 0].min() == pytest.approx(offset)
    assert area(clipped) == pytest.approx(2 * (2 - offset))


@given(st.floats(0.1, 1.9), st.floats(0, 2 * np.pi))
def test_the_two_parts_of_a_cut_make_the_whole(distance: float, turn: float) -> None:
    normal = np.array([np.cos(turn), np.sin(turn), 0.0])
    offset = float(normal @ [1, 1, 0]) + distance - 1
    parts = [clip_convex(SQUARE, sign * normal, sign * offset) for sign in (1, -1)]
    assert sum(area(part) for part in parts if len(part)) == pytest.approx(4)


def test_clipping_away_all_leaves_nothing() -> None:
    assert clip_convex(SQUARE, np.array([1.0, 0, 0]), 3.0).shape == (0, 3)


@given(st.floats(-20, 20), st.floats(-20, 20), st.floats(-20, 20))
def test_a_panel_finds_its_own_points(u: float, v: float, out: float) -> None:
    panel = Panel(np.array([3.0, -0.1, 7.0]), np.array([0.0, 0, 1]), np.array([-1.0, 0, 0]))
    assert np.allclose(panel.locate(panel.point(u, v, out)), [u, v, out])


def test_rectangles_go_round_from_the_top_left() -> None:
    panel = Panel(np.zeros(3), np.array([1.0, 0, 0]), np.array([0.0, 0, -1]))
    assert np.allclose(panel.rectangles([1, 2, 3, 5])[0], [[1, -5, 0], [3, -5, 0], [3, -2, 0], [1, -2, 0]])


def test_a_texture_fills_its_rectangle() -> None:
    texture = texture_on(SQUARE, np.ones((4, 8), np.float32))
    assert np.allclose(texture.origin, [0.125, 0.25, 0])
    assert np.allclose(texture.origin + 7 * texture.across + 3 * texture.down, [1.875, 1.75, 0])


def test_an_outline_is_closed() -> None:
    drawing = Drawing()
    drawing.paint(SQUARE, (1, 2, 3), kind="wall")
    corners = drawing.chains[0].corners
    assert corners.shape == (1, 5, 3)
    assert np.array_equal(corners[0, 0], corners[0, -1])
