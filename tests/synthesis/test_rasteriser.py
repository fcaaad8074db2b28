from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.synthesis.camera import Pose
from app.synthesis.geometry import Drawing, Points, texture_on
from app.synthesis.light import rgb
from app.synthesis.projection import View
from app.synthesis.rasteriser import Haze, Picture, rasterise

CLEAR = Haze(rgb(0, 0, 0), 1e9)
VIEW = View(Pose(np.zeros(3)), np.array([[10.0, 0, 20], [0, 10, 15], [0, 0, 1]]), 41, 31)


def rectangle(x0: float, y0: float, x1: float, y1: float, z: float = 10.0) -> Points:
    """At 10 m one m is one px, and x = y = 0 lies at px (20, 15)."""
    return np.array([[x0, y0, z], [x1, y0, z], [x1, y1, z], [x0, y1, z]])


def render(drawing: Drawing, haze: Haze = CLEAR, background: float = 0.0) -> Picture:
    return rasterise(drawing, VIEW, np.full((3, 31, 41), background, np.float32), haze)


@settings(max_examples=30, deadline=None)
@given(st.floats(-8, -1), st.floats(1, 8), st.floats(-7, -1), st.floats(1, 7))
def test_each_pixel_gets_its_share_of_a_rectangle(x0: float, x1: float, y0: float, y1: float) -> None:
    drawing = Drawing()
    drawing.paint(rectangle(x0, y0, x1, y1), (100, 100, 100))
    rows = render(drawing).colours[15, :, 0] / 100
    assert rows.sum() == pytest.approx(x1 - x0, abs=1e-3)
    centroid = (rows * np.arange(41)).sum() / rows.sum()
    assert centroid == pytest.approx(20 + (x0 + x1) / 2, abs=0.07)


@settings(max_examples=30, deadline=None)
@given(st.floats(-6, 6), st.floats(-0.7, 0.7))
def test_a_slanted_edge_lies_where_geometry_puts_it(middle: float, slope: float) -> None:
    drawing = Drawing()
    top, bottom = middle - 40 * slope, middle + 40 * slope
    drawing.paint(np.array([[-60.0, -40, 10], [top, -40, 10], [bottom, 40, 10], [-60, 40, 10]]), (200, 200, 200))
    width = render(drawing).colours[..., 0].sum(axis=1) / 200 - 0.5  # px from the first pixel's centre to the edge
    expected = 20 + middle + slope * (np.arange(31) - 15)
    inside = (expected > 2) & (expected < 38)
    assert np.abs(width - expected)[inside].max(initial=0) < 0.1
    assert abs((width - expected)[inside].mean()) < 0.02 if inside.sum() > 15 else True


def test_what_is_painted_later_lies_on_top() -> None:
    drawing = Drawing()
    drawing.paint(rectangle(-5, -5, 5, 5), (10, 0, 0))
    drawing.paint(rectangle(-2, -2, 2, 2), (0, 20, 0))
    picture = render(drawing)
    assert picture.colours[15, 20].tolist() == [0, 20, 0]
    assert picture.colours[11, 20].tolist() == [10, 0, 0]
    assert [int(picture.surface[y, 20]) for y in (15, 11, 2)] == [2, 1, 0]


def test_inverse_depth_of_a_slanted_plane() -> None:
    drawing = Drawing()
    ground = np.array([[-50.0, 2, 1], [50, 2, 1], [50, 2, 60], [-50, 2, 60]])
    drawing.paint(ground, (50, 50, 50))
    picture = render(drawing)
    plane = picture.planes[picture.surface[25, 20]]
    # 10 px below the horizon a ground 2 m below the eye is 10 * 2 / 10 = 2 m away
    assert plane @ [20, 25, 1] == pytest.approx(1 / 2)
    assert plane @ [3, 20, 1] == pytest.approx(1 / 4)


def test_what_reaches_behind_the_camera_is_cut_off() -> None:
    drawing = Drawing()
    drawing.paint(np.array([[-50.0, 2, -30], [50, 2, -30], [50, 2, 60], [-50, 2, 60]]), (50, 50, 50))
    drawing.paint(rectangle(-5, -5, 5, 5, z=-4.0), (90, 90, 90))
    colours = render(drawing).colours
    assert (colours[26:] == 50).all()
    assert (colours[:14] == 0).all()


def test_shadows_that_overlap_are_no_darker_and_those_that_meet_leave_no_seam() -> None:
    drawing = Drawing()
    drawing.paint(rectangle(-15, -10, 15, 10), (100, 100, 100))
    parts = [rectangle(-10, -5, 0.3, 5), rectangle(0.3, -5, 10, 5), rectangle(-3, -4, 3, 4)]
    drawing.shadow(parts, (0.5, 0.6, 0.7))
    inner = render(drawing).colours[12:18, 12:28]
    assert np.allclose(inner, [50, 60, 70], atol=1e-3)


def test_a_margin_closes_seams_of_a_mesh() -> None:
    def seam(margin: float) -> float:
        drawing = Drawing()
        halves = np.stack([rectangle(-5, -5, 0.0, 5), rectangle(0.0, -5, 5, 5)])
        drawing.paint(halves, (100, 100, 100), margin=margin)
        return float(render(drawing).colours[15, 20, 0])

    assert seam(0.0) < 80
    assert seam(0.5) == pytest.approx(100)


def test_a_texture_is_laid_the_right_way_round() -> None:
    drawing = Drawing()
    corners = rectangle(-8, -8, 8, 8)
    pixels = np.array([[1.0, 0.5], [0.25, 0.0]], np.float32)
    drawing.paint(corners, (200, 200, 200), textures=[texture_on(corners, pixels)])
    grey = render(drawing).colours[..., 0]
    assert grey[9, 14] > grey[9, 26] > grey[21, 14] > grey[21, 26]


def test_opacity_mixes_with_what_lies_below() -> None:
    drawing = Drawing()
    drawing.paint(rectangle(-5, -5, 5, 5), (100, 100, 100), opacity=0.25)
    assert render(drawing, background=40).colours[15, 20, 0] == pytest.approx(55)


def test_haze_grows_with_depth() -> None:
    def seen(z: float) -> float:
        drawing = Drawing()
        drawing.paint(rectangle(-900, -900, 900, 900, z), (0, 0, 0))
        return float(render(drawing, Haze(rgb(100, 100, 100), 50.0)).colours[15, 20, 0])

    assert seen(5.0) == pytest.approx(100 * (1 - np.exp(-0.1)), rel=1e-3)
    assert seen(50.0) == pytest.approx(100 * (1 - np.exp(-1)), rel=1e-3)
