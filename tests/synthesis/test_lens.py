from __future__ import annotations

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.errors import InvalidInput
from app.synthesis import Lens, draw_lens, make_lens


def frame(lens: Lens) -> np.ndarray:
    columns, rows = np.linspace(0, lens.width - 1, 17), np.linspace(0, lens.height - 1, 11)
    return np.stack(np.meshgrid(columns, rows), axis=-1).reshape(-1, 2)


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 2**40), st.integers(64, 2000), st.integers(64, 2000))
def test_each_pixel_of_a_drawn_lens_has_one_ray(seed: int, width: int, height: int) -> None:
    lens = draw_lens(np.random.default_rng(seed), width, height)
    pixels = frame(lens)
    assert np.allclose(lens.to_pixels(lens.to_rays(pixels)), pixels, atol=1e-6)


@pytest.mark.parametrize("seed", range(6))
def test_the_model_is_the_one_of_opencv(seed: int) -> None:
    lens = draw_lens(np.random.default_rng(seed), 1280, 720)
    pixels = frame(lens)
    rays = lens.to_rays(pixels)
    points = np.concatenate([rays, np.ones((len(rays), 1))], axis=1)
    projected, _ = cv2.projectPoints(points, np.zeros(3), np.zeros(3), lens.matrix, lens.coefficients)
    assert np.allclose(projected.reshape(-1, 2), pixels, atol=1e-6)


def test_a_lens_without_distortion_is_a_pinhole() -> None:
    lens = make_lens(101, 51, 100.0, np.zeros(5))
    assert np.allclose(lens.to_pixels(np.array([[0.0, 0.0], [0.1, -0.2]])), [[50, 25], [60, 5]])


def test_barrel_draws_corners_in() -> None:
    plain, barrel = (make_lens(200, 100, 150.0, [k1, 0, 0, 0, 0]) for k1 in (0.0, -0.2))
    ray = np.array([[0.5, 0.2]])
    centre = plain.matrix[:2, 2]
    assert np.linalg.norm(barrel.to_pixels(ray) - centre) < np.linalg.norm(plain.to_pixels(ray) - centre)


def test_a_lens_that_folds_over_is_refused() -> None:
    with pytest.raises(InvalidInput, match="folds over"):
        make_lens(1280, 720, 500.0, [-0.5, 0, 0, 0, 0])


@pytest.mark.parametrize(
    ("matrix", "coefficients", "size"),
    [
        (np.eye(2), np.zeros(5), (10, 10)),
        (np.diag([0.0, 1.0, 1.0]), np.zeros(5), (10, 10)),
        (np.eye(3), np.zeros(4), (10, 10)),
        (np.eye(3), np.full(5, np.nan), (10, 10)),
        (np.eye(3), np.zeros(5), (0, 10)),
    ],
)
def test_what_is_no_lens_is_refused(matrix: np.ndarray, coefficients: np.ndarray, size: tuple[int, int]) -> None:
    with pytest.raises(InvalidInput):
        Lens(*size, matrix, coefficients)


def test_drawn_lenses_reach_from_plain_to_wide() -> None:
    first = [draw_lens(np.random.default_rng(seed), 1280, 720).coefficients[0] for seed in range(60)]
    assert min(first) < -0.3
    assert max(first) > -0.05
    assert all(-0.45 <= k1 <= 0.05 for k1 in first)
