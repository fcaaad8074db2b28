"""Displacement between undistortions after the best homography."""

from __future__ import annotations

import numpy as np
import pytest

from app.vision.brown import Brown
from app.vision.division import Division
from app.vision.field import apply_homography, displacement, field_error, homography_fields, observable_part
from app.vision.frame import frame_grid


def test_a_homography_is_no_displacement():
    grid = frame_grid(640, 480)
    moved = apply_homography(np.array([[1.1, 0.05, 7], [-0.02, 0.9, -3], [1e-4, -5e-5, 1]]), grid)
    assert displacement(grid, moved).maximum < 1e-4


def test_the_same_lens_has_no_error_and_different_ones_have():
    lens = Brown(640, 480, (319.5, 239.5), 400.0, (0.1, 0.0, 0.0))
    assert field_error(lens, lens, 640, 480).rms < 1e-6
    error = field_error(lens, Brown.identity(640, 480), 640, 480)
    assert 2 < error.rms < error.maximum


def test_frame_grid_holds_the_corners():
    grid = frame_grid(640, 480)
    assert grid.min(0).tolist() == [0, 0]
    assert grid.max(0).tolist() == [639, 479]


def test_observable_part_removes_homographies_and_nothing_else():
    points = frame_grid(640, 480, 12) / 400 - 0.7
    homographies = homography_fields(points)
    assert np.abs(observable_part(points, homographies)).max() < 1e-12
    r2 = (points**2).sum(1)
    radial = np.concatenate([points[:, 0] * r2, points[:, 1] * r2])[:, None]
    left = observable_part(points, radial)
    assert np.abs(homographies.T @ left).max() < 1e-9
    assert np.linalg.norm(left) > 0.1 * np.linalg.norm(radial)


def test_a_small_change_is_what_the_observable_part_says():
    width, height, scale = 640, 480, 400
    grid = frame_grid(width, height)
    change = 1e-4
    exact = field_error(Division(width, height), Division(width, height, (change, 0, 0)), width, height).rms
    x, y = ((grid - [319.5, 239.5]) / scale).T
    field = change * np.concatenate([x * (x * x + y * y), y * (x * x + y * y)])[:, None]
    left = observable_part(np.stack([x, y], -1), field) * scale
    assert np.sqrt((left**2).sum() / len(grid)) == pytest.approx(exact, rel=0.02)


def test_a_single_pixel_has_no_error():
    assert field_error(Division(1, 1, (0.1, 0, 0)), Brown.identity(1, 1), 1, 1).rms == pytest.approx(0, abs=1e-9)
