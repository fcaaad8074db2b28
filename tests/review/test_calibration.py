"""Reports of probabilities, and the calibration of log odds."""

from __future__ import annotations

import numpy as np
import pytest

from app.review.calibration import calibration_report, fit_platt


def test_a_report_by_hand() -> None:
    report = calibration_report([0.9, 0.9, 0.1, 0.3], [True, False, False, False], [0, 0, 1, 1])
    assert report.brier == pytest.approx((0.01 + 0.81 + 0.01 + 0.09) / 4)
    assert report.log_loss == pytest.approx(-np.log([0.9, 0.1, 0.9, 0.7]).mean())
    # bins: two of 0.9 with half kept, one of 0.1 and one of 0.3 with none
    assert report.ece == pytest.approx((2 * 0.4 + 0.1 + 0.3) / 4)
    assert (report.count, report.images) == (4, 2)
    assert report.error_rate == report.base_error_rate == 0.25
    assert report.gain == 0
    assert [each.count for each in report.bins] == [0, 1, 0, 1, 0, 0, 0, 0, 0, 2]
    assert report.bins[0].observed is None
    assert report.bins[9].observed == 0.5


def test_probabilities_of_zero_and_one_have_a_finite_loss() -> None:
    report = calibration_report([1.0, 0.0], [False, True], [0, 0])
    assert np.isfinite(report.log_loss)
    assert report.error_rate == 1


@pytest.mark.parametrize(("slope", "offset"), [(1.0, 0.0), (0.5, -1.0), (2.0, 0.7)])
def test_platt_finds_slope_and_offset_again(slope: float, offset: float) -> None:
    random = np.random.default_rng(0)
    evidence = random.normal(0, 2, 20000)
    kept = random.random(len(evidence)) < 1 / (1 + np.exp(-(slope * evidence + offset)))
    assert fit_platt(evidence, kept) == pytest.approx((slope, offset), abs=0.08)


def test_platt_stays_calm_with_hardly_anything_and_with_certainty() -> None:
    slope, offset = fit_platt([3.0, -3.0], [True, False])
    assert 0.3 < slope < 2
    assert abs(offset) < 0.5
    slope, _ = fit_platt(np.r_[np.full(50, 5.0), np.full(50, -5.0)], np.r_[np.ones(50, bool), np.zeros(50, bool)])
    assert 0.05 <= slope < 5


def test_weights_count_as_copies() -> None:
    evidence, kept = np.array([1.0, -1.0, 0.5]), np.array([True, False, False])
    weighted = fit_platt(evidence, kept, np.array([1.0, 2.0, 3.0]))
    copied = fit_platt(evidence[[0, 1, 1, 2, 2, 2]], kept[[0, 1, 1, 2, 2, 2]])
    assert weighted == pytest.approx(copied)
