"""MSAC for the Brown-Conrady model."""

from __future__ import annotations

import numpy as np
import pytest

from app.vision.bins import bin_segments
from app.vision.brown import Brown
from app.vision.field import field_error
from app.vision.msac import THRESHOLD, mean_cost, msac_brown

LENS = Brown(640, 480, (319.5, 239.5), 400.0, (0.15, 0.0, 0.0))


def test_cost_is_squared_below_the_threshold_and_constant_above():
    assert mean_cost(np.array([0.0, 1.0, 100.0])) == pytest.approx((0 + 1 + THRESHOLD**2) / 3)


def test_recovers_the_lens_with_half_of_the_segments_bent(segments_through):
    binned = bin_segments([segments_through(LENS, 100, bent=0.5)], 640, 480)
    result = msac_brown(binned, 640, 480)
    assert field_error(LENS, result.brown, 640, 480).rms < 1.0
    radii = np.array([0.5, 1.0])
    expected = 0.15 * radii**2
    assert sum(k * radii ** (2 * i + 2) for i, k in enumerate(result.brown.k)) == pytest.approx(expected, abs=0.02)
    bent = binned.index < 50
    assert result.inliers[bent].mean() < 0.1
    assert result.inliers[~bent].mean() > 0.8
    assert result.cost < THRESHOLD**2


def test_same_seed_same_result(segments_through):
    binned = bin_segments([segments_through(LENS, 400, bent=0.6, noise=0.3)], 640, 480)
    first, second = (msac_brown(binned, 640, 480, seed=7) for _ in range(2))
    assert first.brown == second.brown
    assert first.cost == second.cost
    assert (first.inliers == second.inliers).all()


@pytest.mark.parametrize("count", [0, 1, 2])
def test_too_few_segments_are_no_error(segments_through, count: int):
    segments = segments_through(LENS, count)
    result = msac_brown(bin_segments([segments], 640, 480), 640, 480)
    assert len(result.inliers) == count
    assert result.brown.is_invertible()
