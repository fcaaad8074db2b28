"""Division model: hand-computed points, derivatives, invertibility."""

from __future__ import annotations

import numpy as np
import pytest

from app.vision.division import Division, map_derivatives, map_points


def test_a_point_computed_by_hand():
    # 600 x 800: half diagonal 500, centre (299.5, 399.5); r = .6, D = 1 - .25 * .36 - .5 * .1296 = .8452
    lens = Division(600, 800, (0.25, 0.5, 0.0))
    assert lens.undistort([[299.5 + 300, 399.5]]) == pytest.approx(np.array([[299.5 + 300 / 0.8452, 399.5]]))


def test_center_is_the_image_center_plus_the_offset():
    lens = Division(600, 800, (0.25, 0.0, 0.0), (0.01, -0.02))
    assert lens.center == pytest.approx((304.5, 389.5))
    assert lens.undistort([lens.center]) == pytest.approx(np.array([lens.center]))
    assert Division.from_parameters(600, 800, lens.parameters) == lens


def test_derivatives_agree_with_finite_differences():
    parameters = np.array([0.2, 0.1, -0.05, 0.02, -0.01])
    x, y = np.random.default_rng(1).uniform(-0.7, 0.7, (2, 20))
    dx, dy = map_derivatives(parameters, x, y)
    for row in range(5):
        shift = 1e-6 * np.eye(5)[row]
        ahead, behind = map_points(parameters + shift, x, y), map_points(parameters - shift, x, y)
        assert dx[row] == pytest.approx((ahead.x - behind.x) / 2e-6, abs=1e-8)
        assert dy[row] == pytest.approx((ahead.y - behind.y) / 2e-6, abs=1e-8)


def test_jacobian_agrees_with_finite_differences():
    lens = Division(640, 480, (0.3, -0.1, 0.05), (0.01, 0.02))
    points = np.array([[20.0, 30.0], [600.0, 100.0], [333.0, 470.0]])
    for axis in (0, 1):
        shift = 1e-4 * np.eye(2)[axis]
        slope = (lens.undistort(points + shift) - lens.undistort(points - shift)) / 2e-4
        assert lens.jacobian(points)[:, :, axis] == pytest.approx(slope, abs=1e-8)


@pytest.mark.parametrize(
    ("k", "invertible"),
    [
        ((0.2, 0.0, 0.0), True),
        ((-0.2, 0.0, 0.0), True),
        ((1.2, 0.0, 0.0), False),  # the horizon D = 0 lies within the frame
        ((-1.5, 0.0, 0.0), False),  # radii turn back where k1 r^2 = -1
    ],
)
def test_invertible_unless_it_folds_or_has_its_horizon_in_the_frame(k: tuple[float, float, float], invertible: bool):
    assert Division(640, 480, k).is_invertible() is invertible
