"""Refit to Brown-Conrady, from the division model and from OpenCV."""

from __future__ import annotations

import numpy as np
import pytest

from app.errors import InvalidInput
from app.vision.brown import Brown
from app.vision.conversion import OpenCVLens, opencv_to_brown, refit_brown
from app.vision.division import Division
from app.vision.field import field_error

K = [[460.8, 0.0, 312.0], [0.0, 460.8, 234.0], [0.0, 0.0, 1.0]]
D = [-0.15, 0.02, 0.0009, -0.0009, 0.0]


def test_a_brown_lens_is_its_own_refit():
    lens = Brown(640, 480, (330.0, 230.0), 400.0, (0.12, -0.03, 0.02), (0.001, -0.002))
    refit = refit_brown(lens, 640, 480, lens.center)
    assert refit.brown.k == pytest.approx(lens.k, abs=1e-4)
    assert refit.brown.p == pytest.approx(lens.p, abs=1e-4)
    assert refit.error.maximum < 0.01


@pytest.mark.parametrize("k1", [-0.2, 0.05, 0.2, 0.4])
def test_the_stated_error_is_the_measured_one(k1: float):
    lens = Division(640, 480, (k1, 0.0, 0.0), (0.01, -0.01))
    refit = refit_brown(lens, 640, 480, lens.center)
    assert refit.brown.is_invertible()
    assert refit.error == pytest.approx(field_error(lens, refit.brown, 640, 480), abs=1e-6)
    assert refit.error.rms < (0.05 if k1 < 0.3 else 0.6)
    assert refit.brown.k[0] == pytest.approx(k1, rel=0.25)


def test_opencv_calibration_keeps_its_undistortion():
    refit = opencv_to_brown(K, D, 640, 480)
    assert refit.brown.center == (312.0, 234.0)
    assert refit.brown.k[0] > 0  # OpenCV's barrel is negative, ours positive
    assert refit.error.rms < 0.1
    assert field_error(OpenCVLens(K, D), refit.brown, 640, 480).rms == pytest.approx(refit.error.rms, abs=1e-6)


def test_no_distortion_refits_to_none():
    refit = opencv_to_brown(K, [0, 0, 0, 0], 640, 480)
    assert np.abs([*refit.brown.k, *refit.brown.p]).max() < 1e-6


def test_a_frame_of_one_pixel_is_no_error():
    refit = refit_brown(Division(1, 1), 1, 1, (0.0, 0.0))
    assert np.isfinite([*refit.brown.k, *refit.brown.p, *refit.error]).all()


@pytest.mark.parametrize(
    ("k", "d", "where"),
    [
        ([[1, 0], [0, 1]], D, "K"),
        ([[-1, 0, 0], [0, 1, 0], [0, 0, 1]], D, "K"),
        (K, [0.1], "D"),
        (K, [0.1, 0, 0, float("nan")], "D"),
        ("focal length", D, "K"),
    ],
)
def test_what_is_no_calibration_is_refused(k: object, d: object, where: str):
    with pytest.raises(InvalidInput) as refusal:
        opencv_to_brown(k, d, 640, 480)  # type: ignore[arg-type]
    assert refusal.value.where == where
