"""Lines in bins."""

from __future__ import annotations

import numpy as np
import pytest

from app.calibration.observations import BINS, KEPT, Observed, observe
from app.vision.frame import center_of
from app.vision.segments import Segments

SIZE = 640, 480


def of_points(*lines: np.ndarray, probability: np.ndarray | None = None):
    return observe([Observed(Segments.from_list(lines), probability)], *SIZE)


def arc(radius: float, count: int = 200) -> np.ndarray:
    angle = np.linspace(-0.2, 0.2, count)
    return np.stack([320 + radius * np.sin(angle), 100 + radius * (1 - np.cos(angle))], -1)


def test_bins_of_a_bent_line_lie_on_it():
    observed = of_points(arc(400))
    x = observed.scale * observed.x[0] + center_of(*SIZE)[0] - 320
    y = observed.scale * observed.y[0] + center_of(*SIZE)[1] - 100
    # without the correction for the bend within bins they would lie 0.26 px inside
    np.testing.assert_allclose(np.hypot(x, y - 400), 400, atol=2e-3)


def test_basis_is_orthonormal_and_blind_to_lines():
    rng = np.random.default_rng(0)
    t = np.sort(rng.uniform(0, 1, 300)) ** 1.5
    observed = of_points(np.stack([50 + 300 * t, 200 + 0 * t], -1))
    weight, basis = observed.weight[0], observed.basis[0]
    gram = (basis / np.maximum(weight, 1e-12)) @ basis.T
    np.testing.assert_allclose(gram, np.eye(5), atol=1e-9)
    np.testing.assert_allclose(basis @ observed.x[0], 0, atol=1e-9)


def test_roughness_is_the_noise_of_the_points():
    rng = np.random.default_rng(0)
    lines = [arc(300, 250) + rng.normal(0, 0.2, (250, 2)) for _ in range(30)]
    assert float(np.median(of_points(*lines).roughness)) == pytest.approx(0.2, rel=0.05)


def test_six_points_tell_degrees_two_to_five():
    x = np.linspace(100, 400, 6)
    observed = of_points(np.stack([x, 50 + 0.001 * (x - 250) ** 2], -1))
    assert observed.known[0].tolist() == [True, True, True, True, False]
    assert np.isnan(observed.roughness[0])
    assert (observed.weight[0] > 0).sum() == 6 <= BINS


def test_leaves_out_what_can_tell_nothing():
    line = np.stack([np.linspace(10, 200, 50), np.full(50, 30.0)], -1)
    speck = np.stack([np.linspace(10, 16, 20), np.full(20, 30.0)], -1)
    still = np.full((10, 2), 7.0)
    observed = of_points(line, line[:3], speck, still, line, probability=np.array([0.5, 1, 1, 1, 0]))
    assert observed.index.tolist() == [0]
    assert observed.probability.tolist() == [0.5]


def test_kept_lines_may_still_be_wrong():
    observed = of_points(arc(500))
    assert observed.probability.tolist() == [KEPT]
    assert KEPT < 1


def test_no_lines_are_no_error():
    assert len(observe([Observed(Segments.empty())], *SIZE)) == 0
