"""The three lens models, both ways, and their derivatives."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.calibration.inversion import invert
from app.calibration.lens import FAMILIES, FAMILY_NAMES, CameraLens, Family
from app.errors import InvalidInput
from app.vision import brown
from app.vision.frame import frame_grid

SIZE = 640, 400


def lens_of(family: Family, k1: float, k2: float, cx: float, cy: float, p: float = 0.0) -> CameraLens:
    values = {"k1": -k1 if family == "opencv" else k1, "k2": k2, "p1": p, "p2": -p, "cx": cx, "cy": cy}
    names = FAMILIES[family].names
    return CameraLens(family, *SIZE, tuple(values.get(name, 0.0) for name in names))


@pytest.mark.parametrize("family", FAMILY_NAMES)
@settings(max_examples=25, deadline=None)
@given(
    k1=st.floats(-0.1, 0.12),
    k2=st.floats(-0.02, 0.02),
    cx=st.floats(-0.05, 0.05),
    cy=st.floats(-0.05, 0.05),
    p=st.floats(-0.002, 0.002),
)
def test_distorting_takes_back_undistorting(family: Family, k1: float, k2: float, cx: float, cy: float, p: float):
    lens = lens_of(family, k1, k2, cx, cy, p)
    grid = frame_grid(*SIZE, 12)
    assert lens.is_invertible()
    np.testing.assert_allclose(lens.distort(lens.undistort(grid)), grid, atol=1e-6)


@pytest.mark.parametrize("family", FAMILY_NAMES)
def test_derivatives_are_those_of_the_map(family: Family):
    lens = lens_of(family, 0.1, 0.02, 0.03, -0.02, 0.001)
    parameters = np.asarray(lens.parameters)
    x, y = np.random.default_rng(1).uniform(-0.7, 0.7, (2, 20))
    model = FAMILIES[family]
    given_points = model.derivatives_from(parameters, x, y, model.map_points(parameters, x, y))
    for found in (model.map_derivatives(parameters, x, y), given_points):
        for index in range(len(parameters)):
            step = 1e-6 * np.eye(len(parameters))[index]
            ahead, behind = (model.map_points(parameters + sign * step, x, y) for sign in (1, -1))
            np.testing.assert_allclose(found[0][index], (ahead.x - behind.x) / 2e-6, atol=1e-7)
            np.testing.assert_allclose(found[1][index], (ahead.y - behind.y) / 2e-6, atol=1e-7)


def test_beyond_the_fold_there_is_no_point():
    # r (1 - 0.3 r^2) is at most 0.7027, at r = 1.0541
    parameters = np.array([-0.3, 0, 0, 0, 0, 0, 0])
    x, _ = invert(brown.map_points, parameters, np.array([0.1, 0.7, 0.71]), np.zeros(3))
    near = x[:2]
    np.testing.assert_allclose(near * (1 - 0.3 * near**2), [0.1, 0.7], atol=1e-9)
    assert (near < 1.0541).all()
    assert np.isnan(x[2])


def test_fields_come_back():
    lens = lens_of("division", 0.2, 0.01, 0.01, 0.0)
    assert CameraLens.from_dict(lens.as_dict()) == lens


def test_refuses_an_unknown_model_and_too_few_parameters():
    with pytest.raises(InvalidInput, match="unknown model"):
        CameraLens.from_dict({**lens_of("brown", 0, 0, 0, 0).as_dict(), "family": "fisheye"})
    with pytest.raises(InvalidInput, match="2 parameters"):
        CameraLens("division", *SIZE, (0.1, 0.2))
