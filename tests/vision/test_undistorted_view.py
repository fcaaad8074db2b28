"""The view without distortion: there and back, in pixels and in points."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.errors import InvalidInput
from app.vision.brown import Brown
from app.vision.frame import frame_grid
from app.vision.undistorted_view import undistorted_view

WIDTH, HEIGHT = 320, 240


def lens(k1: float, k2: float = 0.0, center: tuple[float, float] = (165.0, 115.0)) -> Brown:
    return Brown(WIDTH, HEIGHT, center, 200.0, (k1, k2, 0.0))


def test_without_distortion_the_view_is_the_image() -> None:
    view = undistorted_view(Brown.identity(WIDTH, HEIGHT))
    image = np.random.default_rng(1).integers(0, 255, (HEIGHT, WIDTH, 3)).astype(np.uint8)
    assert (view.scale, *view.offset) == pytest.approx((1.0, 0.0, 0.0), abs=1e-9)
    assert np.array_equal(view.render(image), image)


@given(st.floats(-0.15, 0.3), st.floats(-0.03, 0.03), st.floats(-20, 20), st.floats(-20, 20))
def test_the_whole_frame_is_seen_and_goes_back(k1: float, k2: float, dx: float, dy: float) -> None:
    view = undistorted_view(lens(k1, k2, (159.5 + dx, 119.5 + dy)))
    frame = frame_grid(WIDTH, HEIGHT)
    seen = view.project(frame)
    assert seen.min() >= -0.01
    assert (seen.max(axis=0) <= np.array([WIDTH, HEIGHT]) - 0.99).all()
    assert np.abs(view.measured(seen) - frame).max() < 1e-3


@pytest.mark.parametrize("k1", [-0.12, 0.25])
def test_a_bent_line_is_straight_in_the_view_and_its_points_lie_on_it(k1: float) -> None:
    view = undistorted_view(lens(k1))
    line = np.stack([np.linspace(60, 260, 400), np.linspace(50, 90, 400)], -1)
    bent = view.measured(line)
    image = np.zeros((HEIGHT, WIDTH), np.uint8)
    cv2.polylines(image, [np.rint(bent * 16).astype(np.int32)], False, 255, 3, cv2.LINE_AA, 4)
    seen = view.render(image).astype(np.float64)
    for x, y in line[20:-20:40]:
        rows = np.arange(int(y) - 8, int(y) + 9)
        column = seen[rows, round(x)]
        at = 50 + (round(x) - 60) * 0.2
        assert (column @ rows) / column.sum() == pytest.approx(at, abs=0.15)
    assert np.abs(view.project(bent) - line).max() < 1e-3


def test_a_lens_that_folds_is_refused() -> None:
    with pytest.raises(InvalidInput, match="folds"):
        undistorted_view(lens(-0.9))


def test_an_image_of_another_size_is_refused() -> None:
    with pytest.raises(InvalidInput, match="10 x 5"):
        undistorted_view(lens(0.1)).render(np.zeros((5, 10), np.uint8))
