"""Brown-Conrady model: hand-computed points, derivatives, inverse."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.vision.brown import Brown, map_derivatives, map_points


def test_a_point_computed_by_hand():
    # x = 2, y = 1, r2 = 5: 1 + .1 * 5 + .01 * 25 + .001 * 125 = 1.875
    # x_u = 2 * 1.875 + 2 * .02 * 2 + .03 * (5 + 8) = 3.75 + .08 + .39 = 4.22
    # y_u = 1.875 + .02 * (5 + 2) + 2 * .03 * 2 = 1.875 + .14 + .12 = 2.135
    lens = Brown(101, 101, (50.0, 40.0), 10.0, (0.1, 0.01, 0.001), (0.02, 0.03))
    assert lens.undistort([[70.0, 50.0]]) == pytest.approx(np.array([[50 + 42.2, 40 + 21.35]]), abs=1e-12)


def test_the_center_stays_and_zero_coefficients_change_nothing():
    lens = Brown(640, 480, (300.0, 200.0), 400.0, (0.3, -0.1, 0.05), (0.01, 0.01))
    assert lens.undistort([lens.center]) == pytest.approx(np.array([lens.center]))
    points = np.array([[0.0, 0.0], [639.0, 1.0], [12.5, 400.25]])
    assert Brown.identity(640, 480).undistort(points) == pytest.approx(points, abs=1e-10)


def test_positive_k1_undoes_a_barrel():
    lens = Brown(640, 480, (319.5, 239.5), 400.0, (0.2, 0.0, 0.0))
    corner = lens.undistort([[0.0, 0.0]])[0]
    assert (corner < 0).all()


def test_jacobian_agrees_with_finite_differences():
    lens = Brown(640, 480, (310.0, 250.0), 400.0, (0.2, -0.05, 0.03), (0.004, -0.003))
    points = np.array([[20.0, 30.0], [310.0, 250.0], [600.0, 100.0], [333.0, 470.0]])
    step = 1e-4
    for axis in (0, 1):
        shift = step * np.eye(2)[axis]
        slope = (lens.undistort(points + shift) - lens.undistort(points - shift)) / (2 * step)
        assert lens.jacobian(points)[:, :, axis] == pytest.approx(slope, abs=1e-8)


def test_derivatives_by_the_parameters_agree_with_finite_differences():
    parameters = np.array([0.2, -0.05, 0.03, 0.004, -0.003, 0.02, -0.01])
    x, y = np.random.default_rng(0).uniform(-0.8, 0.8, (2, 20))
    dx, dy = map_derivatives(parameters, x, y)
    for row in range(7):
        shift = 1e-6 * np.eye(7)[row]
        ahead, behind = map_points(parameters + shift, x, y), map_points(parameters - shift, x, y)
        assert dx[row] == pytest.approx((ahead.x - behind.x) / 2e-6, abs=1e-8)
        assert dy[row] == pytest.approx((ahead.y - behind.y) / 2e-6, abs=1e-8)


@given(
    k1=st.floats(-0.2, 0.5),
    k2=st.floats(-0.05, 0.1),
    p1=st.floats(-0.01, 0.01),
    p2=st.floats(-0.01, 0.01),
    at=st.tuples(st.floats(0, 639), st.floats(0, 479)),
)
def test_distort_inverts_undistort(k1: float, k2: float, p1: float, p2: float, at: tuple[float, float]):
    lens = Brown(640, 480, (330.0, 230.0), 400.0, (k1, k2, 0.0), (p1, p2))
    assert lens.is_invertible()
    assert lens.distort(lens.undistort([at])) == pytest.approx(np.array([at]), abs=1e-6)


def test_a_folding_lens_is_not_invertible_and_has_no_inverse_beyond_the_fold():
    # along a radius 1 - 3 * .5 * r2 = 0 at r = .816: the largest corrected radius is .816 * (1 - .333) = .544
    lens = Brown(640, 480, (319.5, 239.5), 400.0, (-0.5, 0.0, 0.0))
    assert not lens.is_invertible()
    assert lens.smallest_determinant() < 0
    far = lens.distort([[319.5 + 0.6 * 400, 239.5]])
    assert np.isnan(far).all()
    near = lens.distort(lens.undistort([[319.5 + 0.7 * 400, 239.5]]))
    assert near == pytest.approx(np.array([[319.5 + 0.7 * 400, 239.5]]), abs=1e-6)


def test_a_lens_that_turns_the_corners_over_is_not_invertible():
    # both eigenvalues negative: the determinant alone would pass
    assert not Brown(640, 480, (319.5, 239.5), 400.0, (-4.0, 0.0, 0.0)).is_invertible()
