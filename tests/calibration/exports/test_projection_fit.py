"""Coefficients of OpenCV's model: exact where they can be, refused where they fold."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from app.calibration.exports import Intrinsics, choose_intrinsics, export_lens
from app.calibration.exports.frame_sample import frame_sample
from app.calibration.exports.kalibr import convert_kalibr
from app.calibration.exports.opencv_storage import convert_opencv
from app.calibration.exports.projection import NAMES, area, derivatives, project
from app.calibration.exports.projection_fit import Model, convert
from app.calibration.lens import CameraLens
from app.errors import CannotExport

COEFFICIENTS = st.lists(st.floats(-0.1, 0.1), min_size=8, max_size=8).map(np.array)
RAYS = np.random.default_rng(0).uniform(-0.9, 0.9, (20, 2))


@given(COEFFICIENTS)
@settings(max_examples=20, deadline=None)
def test_derivatives_are_those_of_the_projection(coefficients: Any) -> None:
    found = derivatives(coefficients, RAYS)
    for place in range(len(NAMES)):
        step = np.zeros(8)
        step[place] = 1e-6
        numeric = (project(coefficients + step, RAYS) - project(coefficients - step, RAYS)) / 2e-6
        np.testing.assert_allclose(found[place], numeric, atol=1e-7)


@given(COEFFICIENTS)
@settings(max_examples=20, deadline=None)
def test_the_area_is_the_determinant_of_the_projection(coefficients: Any) -> None:
    across, down = np.array([1e-6, 0]), np.array([0, 1e-6])
    along_x = (project(coefficients, RAYS + across) - project(coefficients, RAYS - across)) / 2e-6
    along_y = (project(coefficients, RAYS + down) - project(coefficients, RAYS - down)) / 2e-6
    determinant = along_x[:, 0] * along_y[:, 1] - along_x[:, 1] * along_y[:, 0]
    found = area(coefficients, RAYS)
    proper = along_x[:, 0] + along_y[:, 1] > 0
    np.testing.assert_allclose(found[proper], determinant[proper], atol=1e-6)
    assert (found[~proper] <= 0).all()


def test_beyond_a_pole_there_is_no_area() -> None:
    coefficients = np.array([0, 0, 0, 0, 0, -4.0, 0, 0])
    assert area(coefficients, np.array([[0.1, 0.0], [0.9, 0.0]])).tolist()[1] <= 0 < area(coefficients, RAYS[:1] / 9)[0]


@pytest.mark.parametrize("focal_length", [50.0, 161.5, 900.0])
def test_a_lens_of_opencvs_own_direction_keeps_its_coefficients(focal_length: float) -> None:
    k1, k2, k3, p1, p2 = -0.2, 0.06, -0.01, 0.001, -0.002
    lens = CameraLens("opencv", 240, 160, (k1, k2, k3, p1, p2, 0.02, -0.01))
    found = convert_opencv(frame_sample(lens, choose_intrinsics(lens, focal_length=focal_length)))
    unit = focal_length / lens.scale
    expected = [k1 * unit**2, k2 * unit**4, p1 * unit, p2 * unit, k3 * unit**6]
    np.testing.assert_allclose(found.coefficients, expected, rtol=1e-5)
    assert found.error.maximum < 1e-6


def test_kalibrs_four_keep_tangential_terms() -> None:
    lens = CameraLens("opencv", 240, 160, (-0.1, 0.03, 0.0, 0.001, -0.002, 0.02, -0.01))
    found = convert_kalibr(frame_sample(lens, choose_intrinsics(lens, focal_length=lens.scale)))
    np.testing.assert_allclose(found.coefficients, [-0.1, 0.03, 0.001, -0.002], rtol=1e-5)
    assert found.focal_length is None


def test_the_camera_matrix_stays_as_stated_where_the_model_is_exact(lenses: Mapping[str, CameraLens]) -> None:
    intrinsics = choose_intrinsics(lenses["barrel as OpenCV writes it"], focal_length=123.0)
    found = convert_opencv(frame_sample(lenses["barrel as OpenCV writes it"], intrinsics))
    assert (found.focal_length, found.principal_point) == (None, None)
    assert found.notes == ()


def test_a_fitted_camera_matrix_is_better_and_told() -> None:
    lens = CameraLens("division", 1392, 512, (0.238, -0.048, 0.047, 0.005, -0.018))
    sample = frame_sample(lens, choose_intrinsics(lens, focal_length=980))
    kept = convert(sample, [Model("radtan", (0, 1, 2, 3), 4)])
    found = convert_kalibr(sample)
    assert found.error.rms < 0.7 * kept.error.rms
    assert found.focal_length == pytest.approx(980, rel=0.01)
    assert "Camera matrix fitted" in found.notes[0]


def test_kalibrs_four_are_fitted_for_themselves(lenses: Mapping[str, CameraLens]) -> None:
    """Leaving k3 out of OpenCV's five is many times further off."""
    lens = lenses["barrel as OpenCV writes it"]
    sample = frame_sample(lens, choose_intrinsics(lens, focal_length=150))
    five = np.zeros(8)
    five[:4] = convert_opencv(sample).coefficients[:4]
    x, y = sample.intrinsics.principal_point
    seen = 150 * project(five, sample.check.rays) + [x, y]
    cut = float(np.sqrt(np.mean(((seen - sample.check.measured) ** 2).sum(axis=1))))
    assert convert_kalibr(sample).error.rms < cut / 5


def test_a_denominator_is_used_where_five_are_not_exact() -> None:
    lens = CameraLens("division", 1392, 512, (0.238, -0.048, 0.047, 0.005, -0.018))
    found = convert_opencv(frame_sample(lens, choose_intrinsics(lens, focal_length=980)))
    assert len(found.coefficients) == 8
    assert found.error.maximum < 0.05


def test_fits_that_fold_are_refused() -> None:
    lens = CameraLens("division", 1242, 375, (0.5, 0.1, 0.1, 0.01, -0.01))
    assert lens.is_invertible()
    with pytest.raises(CannotExport, match="radtan folds within the frame") as caught:
        export_lens(lens, "kalibr", camera_name="front", intrinsics=choose_intrinsics(lens))
    assert "opencv-yaml" in (caught.value.hint or "")


def test_the_error_is_that_of_the_stated_principal_point(lenses: Mapping[str, CameraLens]) -> None:
    """No homography makes up for a principal point that is off: the file would be wrong by it."""
    lens = lenses["wide"]
    x, y = lens.center
    errors = [
        convert_kalibr(frame_sample(lens, Intrinsics(160, (x + away, y), "given"))).error.rms for away in (0, 5, 20)
    ]
    assert errors[0] < errors[1] < errors[2]


def test_yaml_holds_the_numbers_of_the_fit(lenses: Mapping[str, CameraLens]) -> None:
    lens = lenses["barrel"]
    intrinsics = choose_intrinsics(lens, focal_length=130)
    found = convert_kalibr(frame_sample(lens, intrinsics))
    camera = yaml.safe_load(export_lens(lens, "kalibr", camera_name="x", intrinsics=intrinsics).content)["cam0"]
    assert tuple(camera["distortion_coeffs"]) == found.coefficients
