from __future__ import annotations

import json

import numpy as np
import pytest

from app.evaluation.bootstrap import interval
from app.evaluation.comparison import compare, is_tied


def mean_of(values: np.ndarray):
    return lambda weights: {"mean": weights @ values / weights.sum(axis=1)}


HARD = np.random.default_rng(0).uniform(0, 1, 50)
"""How well anything can do on each of 50 images."""
IMAGES = np.arange(50)


def test_a_submission_is_tied_with_itself() -> None:
    found = compare(mean_of(HARD), mean_of(HARD), IMAGES, 200, seed=0)["mean"]
    assert (found.difference, found.low, found.high, found.tied) == (0.0, 0.0, 0.0, True)


def test_a_small_but_steady_lead_is_told_though_the_scores_intervals_overlap() -> None:
    found = compare(mean_of(HARD), mean_of(HARD + 0.02), IMAGES, 500, seed=0)["mean"]
    assert found.difference == pytest.approx(0.02)
    assert (found.low, found.high) == pytest.approx((0.02, 0.02))
    assert not found.tied


def test_a_lead_within_its_noise_is_a_tie() -> None:
    other = HARD + np.random.default_rng(1).normal(0.005, 0.2, 50)
    found = compare(mean_of(HARD), mean_of(other), IMAGES, 500, seed=0)["mean"]
    assert found.tied
    assert found.low is not None
    assert found.high is not None
    assert found.low < 0 < found.high


def test_swapping_both_turns_the_sign() -> None:
    other = HARD + np.random.default_rng(1).normal(0.05, 0.2, 50)
    there = compare(mean_of(HARD), mean_of(other), IMAGES, 300, seed=4)["mean"]
    back = compare(mean_of(other), mean_of(HARD), IMAGES, 300, seed=4)["mean"]
    assert (back.a, back.b) == (there.b, there.a)
    assert there.difference is not None
    assert there.low is not None
    assert there.high is not None
    assert (back.difference, back.low, back.high) == pytest.approx((-there.difference, -there.high, -there.low))


def test_the_interval_of_the_difference_covers_it_as_often_as_it_says() -> None:
    random = np.random.default_rng(7)
    covered = 0
    for trial in range(200):
        shared = random.normal(size=40)
        a, b = shared + random.normal(0, 0.3, 40), shared + 0.1 + random.normal(0, 0.3, 40)
        found = compare(mean_of(a), mean_of(b), np.arange(40), 200, seed=trial)["mean"]
        assert found.low is not None
        assert found.high is not None
        covered += found.low <= 0.1 <= found.high
    assert 0.88 <= covered / 200 <= 0.985


def test_only_metrics_that_both_have_are_compared_and_undefined_ones_tell_nothing() -> None:
    def with_ap(weights: np.ndarray) -> dict[str, np.ndarray]:
        return {"f1": weights[:, 0], "ap": np.full(len(weights), np.nan)}

    found = compare(with_ap, with_ap, [0, 1], 10, seed=0)
    assert set(compare(with_ap, lambda weights: {"f1": weights[:, 0]}, [0, 1], 10, seed=0)) == {"f1"}
    assert json.loads(json.dumps(found["ap"].as_dict(), allow_nan=False)) == {
        "a": None,
        "b": None,
        "difference": None,
        "low": None,
        "high": None,
        "tied": True,
    }


def test_one_cluster_can_tell_nothing_apart() -> None:
    found = compare(mean_of(np.zeros(3)), mean_of(np.ones(3)), [2, 2, 2], seed=0)["mean"]
    assert (found.difference, found.low, found.high, found.tied) == (1.0, None, None, True)


def test_an_interval_that_touches_0_covers_it() -> None:
    low = np.array([0.0, -1.0, 0.1, -1.0, np.nan])
    high = np.array([1.0, 0.0, 1.0, -0.1, np.nan])
    assert is_tied(low, high).tolist() == [True, True, False, False, True]
    assert is_tied(*interval(np.zeros(5)))
