"""Splines against what is known of them."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.calibration.bspline import SplineGrid, grid_for

GRID = SplineGrid(801, 601, 9, 7)


def coefficients_of(function):
    """Coefficients of the spline nearest to a function, and the largest distance."""
    places = np.stack(np.meshgrid(np.linspace(0, 800, 41), np.linspace(0, 600, 31)), -1).reshape(-1, 2)
    basis, values = GRID.basis(places), function(*places.T)
    found, *_ = np.linalg.lstsq(basis, values, rcond=None)
    return found, np.abs(basis @ found - values).max()


@settings(max_examples=50, deadline=None)
@given(st.floats(0, 800), st.floats(0, 600))
def test_the_basis_adds_up_to_one_and_is_never_negative(x, y):
    values = GRID.basis([[x, y]])
    assert values.sum() == pytest.approx(1)
    assert values.min() >= 0
    assert (values > 0).sum() <= 16


def test_cubics_are_exact():
    _, away = coefficients_of(lambda x, y: 1 + 0.01 * x + 1e-5 * x * y + 1e-8 * x**3 - 1e-8 * x**2 * y)
    assert away < 1e-9


def test_points_beyond_the_frame_count_as_on_its_border():
    assert np.array_equal(GRID.basis([[-50, 700]]), GRID.basis([[0, 600]]))


def test_the_energy_is_that_of_the_function():
    half = np.hypot(801, 601) / 2
    # x^2 + 3 x y in half diagonals: f_xx = 2, f_xy = 3
    found, _ = coefficients_of(lambda x, y: (x / half) ** 2 + 3 * (x / half) * (y / half))
    assert found @ GRID.energy() @ found == pytest.approx(2**2 + 2 * 3**2, rel=1e-6)


def test_planes_have_no_energy():
    found, _ = coefficients_of(lambda x, y: 5 - 0.02 * x + 0.03 * y)
    assert found @ GRID.energy() @ found == pytest.approx(0, abs=1e-9)
    assert np.linalg.eigvalsh(GRID.energy()).min() > -1e-9


@pytest.mark.parametrize(
    ("width", "height", "shape"), [(1280, 720, (10, 7)), (480, 640, (8, 10)), (1300, 398, (10, 5))]
)
def test_cells_are_about_square(width, height, shape):
    grid = grid_for(width, height)
    assert (grid.columns, grid.rows) == shape
