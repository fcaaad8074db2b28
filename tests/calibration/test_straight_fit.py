"""How lines bend under a lens, their law and their loss."""

from __future__ import annotations

import numpy as np
import pytest

from app.calibration.lens import FAMILY_NAMES, CameraLens, Family
from app.calibration.line_loss import line_loss
from app.calibration.line_noise import LineNoise, estimate_noise, variances
from app.calibration.observations import observe
from app.calibration.straight_fit import amplitudes, amplitudes_and_slopes

SIZE = 800, 600
TRUE = {
    "brown": (0.12, 0.02, 0.0, 0.001, -0.001, 0.02, -0.01),
    "opencv": (-0.1, 0.02, 0.0, 0.001, -0.001, 0.02, -0.01),
    "division": (0.15, 0.02, 0.0, 0.02, -0.01),
}


@pytest.mark.parametrize("family", FAMILY_NAMES)
def test_straight_lines_do_not_bend_under_their_lens(lines_through, family: Family):
    lens = CameraLens(family, *SIZE, TRUE[family])
    observed = observe(lines_through(lens, 20, noise=0.0), *SIZE)
    bent = amplitudes(observed, family, np.zeros(len(lens.parameters)))
    left = amplitudes(observed, family, np.asarray(lens.parameters))
    assert np.abs(bent).max() > 0.5
    assert np.abs(left).max() < 1e-3


@pytest.mark.parametrize("family", FAMILY_NAMES)
def test_slopes_are_derivatives(lines_through, family: Family):
    lens = CameraLens(family, *SIZE, TRUE[family])
    observed = observe(lines_through(lens, 15, noise=0.3, seed=3), *SIZE)
    parameters = np.asarray(lens.parameters)
    _, slopes = amplitudes_and_slopes(observed, family, parameters)
    for index in range(len(parameters)):
        step = 1e-5 * np.eye(len(parameters))[index]
        ahead, behind = (amplitudes(observed, family, parameters + sign * step) for sign in (1, -1))
        expected = (ahead - behind) / 2e-5
        np.testing.assert_allclose(slopes[..., index], expected, atol=0.02 * np.abs(expected).max())


def test_pull_is_the_derivative_of_the_loss(lines_through):
    observed = observe(lines_through(CameraLens.identity("brown", *SIZE), 12), *SIZE)
    rng = np.random.default_rng(0)
    variance = rng.uniform(0.01, 0.1, (12, 5)) ** 2
    bends = rng.normal(0, [1, 0.2, 0.1, 0.05, 0.03], (12, 5)) * np.geomspace(0.01, 3, 12)[:, None]
    found = line_loss(observed, bends, variance, 4.0)
    for degree in range(5):
        step = 1e-7 * np.eye(5)[degree]
        ahead, behind = (line_loss(observed, bends + sign * step, variance, 4.0).loss for sign in (1, -1))
        np.testing.assert_allclose(found.pull[:, degree], (ahead - behind) / 2e-7, rtol=1e-4, atol=1e-5)
    assert found.straight[0] > 0.99
    assert found.straight[-1] < 0.01


def test_finds_the_law_that_amplitudes_were_drawn_from(lines_through):
    images = lines_through(CameraLens.identity("brown", *SIZE), 120, images=4)
    observed = observe(images, *SIZE)
    rng = np.random.default_rng(0)
    for law in (LineNoise(6.0, 0.0, 50.0), LineNoise(1.0, 0.08, 50.0)):
        bends = rng.normal(size=(120, 5)) * np.sqrt(variances(observed, law))
        found = estimate_noise(observed, bends, np.ones(120), np.zeros((120, 5)))
        expected = variances(observed, law)
        assert np.median(variances(observed, found)[:, 0] / expected[:, 0]) == pytest.approx(1, abs=0.3)
        assert np.median(variances(observed, found)[:, 4] / expected[:, 4]) == pytest.approx(1, abs=0.3)
