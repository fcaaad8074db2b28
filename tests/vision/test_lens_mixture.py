"""The law of segments' bends."""

from __future__ import annotations

import numpy as np
import pytest

from app.vision.bins import bin_segments
from app.vision.brown import Brown
from app.vision.lens_fit import DIVISION
from app.vision.lens_mixture import (
    NOISE_LIMITS,
    Mixture,
    equations,
    mixture_of,
    responsibilities,
    with_noise_of,
)
from app.vision.sampson import Bend, bend

SIZE = 640, 480


def law(number: int) -> Mixture:
    each = np.ones(number)
    return Mixture(0.5 * each, 0.1 * each, 0.6 * each, 0.3 * each, (0.8, 1.3))


def amplitudes(generator: np.random.Generator, number: int, parameters: int = 3) -> Bend:
    slopes = generator.normal(0, 3, (2, number, parameters))
    return Bend(*generator.normal(0, 0.2, (2, number)), *slopes)


def moved(left: Bend, by: np.ndarray) -> Bend:
    """The amplitudes after a change of the parameters."""
    return left._replace(quadratic=left.quadratic + left.quadratic_slope @ by, cubic=left.cubic + left.cubic_slope @ by)


def test_a_bent_segment_is_less_likely_straight(segments_through):
    binned = bin_segments([segments_through(Brown.identity(*SIZE), 20, bent=0.5)], *SIZE)
    left = bend(binned, DIVISION, np.zeros(5))
    probability, loss = responsibilities(left, mixture_of(binned))
    assert probability[:10].max() < probability[10:].min()
    assert np.isfinite(loss).all()


def test_the_gradient_is_that_of_the_loss():
    left, mixture = amplitudes(np.random.default_rng(1), 12), law(12)
    # smaller ones are taken for 0.02 px, or the parabola of a step would be without bounds
    left = left._replace(quadratic=left.quadratic + 0.02 * np.sign(left.quadratic))
    left = left._replace(cubic=left.cubic + 0.02 * np.sign(left.cubic))
    said = equations(left, mixture)
    for index in range(3):
        by = 1e-6 * np.eye(3)[index]
        ahead, behind = (responsibilities(moved(left, change), mixture)[1] for change in (by, -by))
        assert said.gradient[:, index] == pytest.approx((ahead - behind) / 2e-6, rel=1e-4, abs=1e-4)


def test_what_is_known_is_the_curvature_of_the_loss():
    left, mixture = amplitudes(np.random.default_rng(2), 12), law(12)
    known = equations(left, mixture).known
    by = 1e-4 * np.eye(3)[0]
    there, ahead, behind = (responsibilities(moved(left, change), mixture)[1] for change in (0 * by, by, -by))
    assert known[:, 0, 0] == pytest.approx((ahead - 2 * there + behind) / 1e-8, rel=1e-3, abs=0.5)


def test_the_parabola_of_a_step_lies_above_the_loss():
    generator = np.random.default_rng(3)
    left, mixture = amplitudes(generator, 200), law(200)
    said, there = equations(left, mixture), responsibilities(left, mixture)[1]
    for by in generator.normal(0, 0.05, (50, 3)):
        above = there + said.gradient @ by + 0.5 * np.einsum("i,sij,j->s", by, said.normal, by)
        # amplitudes below 0.02 px are taken for that large, which costs at most 0.01 px in units of the Laplace scale
        assert (responsibilities(moved(left, by), mixture)[1] <= above + 0.02 / 0.3).all()


@pytest.mark.parametrize("factor", [0.3, 1.0, 1.4])
def test_noise_is_read_off_the_segments(factor: float):
    generator, number = np.random.default_rng(4), 3000
    mixture = law(number)._replace(noise=(1.0, 1.0))
    nothing = np.zeros((number, 0))
    left = Bend(factor * generator.normal(0, 0.1, number), generator.normal(0, 0.1, number), nothing, nothing)
    found = with_noise_of(mixture, left, np.ones(number)).noise
    assert found == pytest.approx((factor, 1.0), rel=0.05)


def test_no_segments_leave_the_noise_as_predicted_and_wild_ones_within_limits():
    nothing = np.zeros((5, 0))
    left = Bend(np.full(5, 99.0), np.zeros(5), nothing, nothing)
    assert with_noise_of(law(5), left, np.zeros(5)).noise == (1.0, 1.0)
    assert with_noise_of(law(5), left, np.ones(5)).noise[0] == NOISE_LIMITS[1]
