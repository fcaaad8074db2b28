"""Segments in bins."""

from __future__ import annotations

import numpy as np
import pytest

from app.vision.bins import BINS, SIGMA_FLOOR, SIGMA_LYING, bin_segments, orthonormal_polynomials
from app.vision.segments import Segments


def test_polynomials_are_orthonormal_under_uneven_weights():
    generator = np.random.default_rng(0)
    t = np.sort(generator.uniform(0, 1, (5, 12)))
    weight = generator.uniform(0.1, 1, (5, 12))
    weight[:, 3] = 0
    weight /= weight.sum(1, keepdims=True)
    basis = orthonormal_polynomials(t, weight)
    for i, first in enumerate(basis):
        for j, second in enumerate(basis):
            assert (weight * first * second).sum(1) == pytest.approx(np.full(5, float(i == j)), abs=1e-9)


def test_a_degree_without_enough_bins_is_zero():
    basis = orthonormal_polynomials(np.array([[0.1, 0.9, 0.0]]), np.array([[0.5, 0.5, 0.0]]))
    assert basis[1].any()
    assert not basis[2].any()
    assert not basis[3].any()


def test_bins_hold_means_and_shares_of_the_points():
    points = np.stack([np.arange(240.0), np.full(240, 50.0)], -1)
    binned = bin_segments([Segments.from_list([points])], 241, 101)
    assert len(binned) == 1
    assert binned.weight[0] == pytest.approx(np.full(BINS, 1 / BINS), abs=0.005)
    assert binned.x[0, 0] * binned.scale + 120 == pytest.approx(4.5, abs=0.5)
    assert binned.y[0] == pytest.approx(np.zeros(BINS), abs=1e-12)
    assert binned.length[0] == pytest.approx(239)
    assert not binned.vertical[0]
    assert binned.roughness[0] == pytest.approx(0, abs=1e-9)
    assert binned.sigma[0] == pytest.approx(SIGMA_FLOOR * np.sqrt(2.39) * SIGMA_LYING)


def test_roughness_is_what_a_cubic_leaves():
    x = np.linspace(0, 239, 2400)
    cubic = 3 * (x / 239) ** 3 - 2 * (x / 239) ** 2
    smooth, rough = (np.stack([x, 50 + cubic + wave * np.sin(x / 6)], -1) for wave in (0.0, 0.3))
    binned = bin_segments([Segments.from_list([smooth, rough])], 241, 101)
    assert binned.roughness[0] < 0.01
    # bins of 10 px average over part of the wave
    assert 0.1 < binned.roughness[1] < 0.3 / np.sqrt(2)
    assert binned.sigma[1] > binned.sigma[0]


def test_image_and_index_lead_back_to_the_segment():
    line = np.stack([np.arange(100.0), np.arange(100.0)], -1)
    few = line[:4]
    binned = bin_segments([Segments.from_list([few, line]), Segments.empty(), Segments.from_list([line])], 120, 120)
    assert binned.image.tolist() == [0, 2]
    assert binned.index.tolist() == [1, 0]


@pytest.mark.parametrize(
    "polyline",
    [
        np.zeros((40, 2)),  # no extent
        np.array([[5.0, 5.0]]),
        np.repeat([[1.0, 1.0], [90.0, 90.0]], 20, axis=0),  # two bins only
    ],
)
def test_what_tells_nothing_is_left_out(polyline: np.ndarray):
    assert len(bin_segments([Segments.from_list([polyline])], 120, 120)) == 0


def test_nothing_gives_nothing():
    assert len(bin_segments([], 640, 480)) == 0
    assert len(bin_segments([Segments.empty()], 640, 480)) == 0
