"""Where the polynomial of OpenCV's direction turns back."""

from __future__ import annotations

import numpy as np

from app.calibration.lens import CameraLens


def test_a_point_beyond_the_fold_has_no_measured_point() -> None:
    # r (1 - r^2 / 3) turns back at r = 1, half a diagonal: 400 px
    lens = CameraLens("opencv", 640, 480, (-1 / 3, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    center = np.array([319.5, 239.5])
    away = np.array([[0.0, 0.0], [399.0, 0.0], [401.0, 0.0], [0.0, 800.0]])
    found = lens.distort(center + away)
    assert np.isfinite(found[:2]).all()
    assert np.isnan(found[2:]).all()
    np.testing.assert_allclose(found[1] - center, [399 - 399**3 / (3 * 400**2), 0.0], atol=1e-9)


def test_a_polynomial_that_never_turns_back_reaches_everywhere() -> None:
    for k1 in (0.0, 0.2):
        lens = CameraLens("opencv", 640, 480, (k1, 0.0, 0.0, 0.0, 0.0, 0.01, 0.0))
        assert np.isfinite(lens.distort([[1e4, 5e3], [0.0, 0.0]])).all()
