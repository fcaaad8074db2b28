"""What is known of a lens near an answer."""

from __future__ import annotations

import numpy as np
import pytest

from app.vision.lens_evidence import UPRIGHT_SD
from app.vision.lens_hierarchy import BENDING, LensPosterior, higher_sds, lens_posterior, priors
from app.vision.lens_mixture import Equations

HERE = 0.1 * np.eye(5)[0]
UPRIGHT = np.array([4, 5, 6, 7, 12, 13, 14, 15])


def says(k1: np.ndarray, sd: float) -> Equations:
    """One segment each that asks for a k1, looked at from a lens of k1 = 0.1."""
    along = np.eye(5)[0]
    curvature = np.tile(sd**-2 * np.outer(along, along), (len(k1), 1, 1))
    return Equations(-((k1 - HERE[0]) / sd**2)[:, None] * along, curvature, curvature, curvature)


def known_of(said: Equations, k1: float = 0.1) -> LensPosterior:
    return lens_posterior(said, UPRIGHT[: len(said.gradient)], HERE, k1, steps=False)


def spread(posterior: LensPosterior) -> float:
    """Standard deviation of k1."""
    apart = posterior.parameters[:, 0] - posterior.mean[0]
    return float(np.sqrt(posterior.weight @ (posterior.covariance[:, 0, 0] + apart**2)))


def bending(posterior: LensPosterior) -> float:
    return float(posterior.weight @ np.repeat(BENDING, len(priors(0.1).weight)))


def test_structures_that_agree_to_their_noise_tell_more_than_those_that_differ():
    generator = np.random.default_rng(0)
    close, apart = (known_of(says(0.1 + sd * generator.normal(size=8), 0.002)) for sd in (0.002, UPRIGHT_SD))
    assert spread(close) < 0.3 * spread(apart)
    assert bending(close) < 0.2
    assert bending(apart) > 0.5
    assert close.mean[0] == pytest.approx(0.1, abs=0.004)
    assert spread(apart) == pytest.approx(UPRIGHT_SD / np.sqrt(8), rel=0.6)


def test_one_structure_alone_cannot_show_that_it_does_not_bend():
    alone = known_of(says(np.array([0.1]), 0.002))
    assert spread(alone) > 0.4 * UPRIGHT_SD


def test_a_structure_far_astray_is_left_out():
    k1 = np.array([0.1, 0.101, 0.099, 0.1, 0.1005, 0.0995, 0.1, 0.4])
    assert known_of(says(k1, 0.002)).mean[0] == pytest.approx(0.1, abs=0.003)


def test_nothing_said_leaves_the_prior():
    nothing = says(np.zeros(3), 1e9)
    posterior, laws = known_of(nothing), priors(0.1)
    assert laws.weight.sum() == pytest.approx(1)
    assert posterior.mean == pytest.approx(laws.weight @ laws.mean, abs=1e-9)
    for covariance, sds in zip(posterior.covariance[: len(laws.sd)], laws.sd, strict=True):
        assert np.sqrt(np.diag(covariance)) == pytest.approx(sds)


def test_weights_add_up_and_covariances_are_positive():
    posterior = known_of(says(np.linspace(0.05, 0.15, 8), 0.01))
    assert posterior.weight.sum() == pytest.approx(1)
    assert (np.linalg.eigvalsh(posterior.covariance) > 0).all()


def test_doubt_about_which_segments_are_straight_widens():
    said = says(np.full(8, 0.1), 0.01)
    sure, doubtful = known_of(said), known_of(said._replace(known=0.3 * said.known))
    assert spread(doubtful) > 1.2 * spread(sure)


def test_a_wider_lens_may_have_larger_higher_coefficients():
    narrow, wide = higher_sds(0.02), higher_sds(0.3)
    assert (narrow[:, :2] < wide[:, :2]).all()
    assert (narrow[0, :2] < narrow[1, :2]).all()
    assert (narrow[:, 2:] == wide[:, 2:]).all()
