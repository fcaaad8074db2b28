from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.errors import InvalidInput
from app.evaluation import bootstrap as module
from app.evaluation.bootstrap import (
    Estimate,
    bootstrap,
    bootstrap_weights,
    clusters_of,
    estimates,
    interval,
    weight_blocks,
)


def mean_of(values: np.ndarray):
    return lambda weights: {"mean": weights @ values / weights.sum(axis=1)}


def test_images_of_a_sequence_are_one_cluster_and_others_each_their_own() -> None:
    assert clusters_of(["a", None, "b", "a", None, "b"]).tolist() == [0, 1, 2, 0, 3, 2]
    assert clusters_of([]).tolist() == []


@given(clusters=st.lists(st.integers(0, 5), min_size=1, max_size=20), seed=st.integers(0, 2**32))
def test_a_draw_takes_whole_clusters_as_many_as_there_are(clusters: list[int], seed: int) -> None:
    weights = bootstrap_weights(clusters, 7, seed=seed)
    assert weights.shape == (7, len(clusters))
    kinds = sorted(set(clusters))
    first = [clusters.index(kind) for kind in kinds]
    assert (weights[:, first].sum(axis=1) == len(kinds)).all()
    assert (weights == weights[:, [clusters.index(kind) for kind in clusters]]).all()
    assert (weights >= 0).all()
    assert (weights == np.rint(weights)).all()


def test_draws_are_those_of_the_seed_however_they_are_split(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = bootstrap_weights(np.arange(30), 50, seed=3)
    monkeypatch.setattr(module, "_BLOCK_WEIGHTS", 30 * 7)
    blocks = list(weight_blocks(np.arange(30), 50, seed=3))
    assert [len(block) for block in blocks] == [7] * 7 + [1]
    assert np.array_equal(np.concatenate(blocks), whole)
    assert not np.array_equal(bootstrap_weights(np.arange(30), 50, seed=4), whole)


def test_each_cluster_is_drawn_as_often_as_a_multinomial_says() -> None:
    weights = bootstrap_weights(np.arange(10), 20_000, seed=0)
    assert weights.mean(axis=0) == pytest.approx(np.ones(10), abs=0.03)
    assert weights.var(axis=0) == pytest.approx(np.full(10, 0.9), abs=0.05)
    assert np.cov(weights[:, 0], weights[:, 1])[0, 1] == pytest.approx(-0.1, abs=0.03)


def test_the_draws_of_a_mean_are_those_of_a_plain_loop() -> None:
    values = np.array([1.0, 4.0, 2.0, 8.0])
    drawn = bootstrap(mean_of(values), [0, 0, 1, 2], 30, seed=9)["mean"]
    for weights, mean in zip(bootstrap_weights([0, 0, 1, 2], 30, seed=9), drawn, strict=True):
        taken = [value for value, times in zip(values, weights, strict=True) for _ in range(int(times))]
        assert mean == pytest.approx(np.mean(taken), abs=1e-12)


def test_an_interval_is_percentiles_and_leaves_out_undefined_draws() -> None:
    values = np.arange(101.0)
    assert [float(end) for end in interval(values, 0.95)] == pytest.approx([2.5, 97.5])
    both = np.stack([np.concatenate([values, [np.nan] * 9]), np.full(110, np.nan)], axis=1)
    low, high = interval(both, 0.95)
    assert (low[0], high[0]) == pytest.approx((2.5, 97.5))
    assert np.isnan([low[1], high[1]]).all()


@pytest.mark.parametrize("level", [0.0, 1.0, -1.0, float("nan")])
def test_a_level_that_is_no_share_is_refused(level: float) -> None:
    with pytest.raises(InvalidInput, match="interval"):
        interval(np.arange(3.0), level)


@pytest.mark.parametrize(("clusters", "draws"), [([], 10), ([0], 0)])
def test_nothing_to_draw_is_refused(clusters: list[int], draws: int) -> None:
    with pytest.raises(InvalidInput, match="no bootstrap"):
        bootstrap_weights(clusters, draws, seed=0)


def test_one_cluster_says_nothing_about_chance() -> None:
    assert estimates(mean_of(np.array([1.0, 3.0])), [5, 5], 10, seed=0) == {"mean": Estimate(2.0, None, None)}


def test_an_undefined_metric_has_neither_value_nor_interval() -> None:
    found = estimates(lambda weights: {"ap": np.full(len(weights), np.nan)}, [0, 1], 10, seed=0)
    assert found["ap"].as_dict() == {"value": None, "low": None, "high": None}


@pytest.mark.parametrize("per_cluster", [1, 5])
def test_the_interval_covers_the_truth_as_often_as_it_says(per_cluster: int) -> None:
    """Images of a cluster share half of their variance; the true mean is 0."""
    random = np.random.default_rng(11)
    trials, clusters = 400, 60
    number = np.repeat(np.arange(clusters), per_cluster)
    weights = bootstrap_weights(number, 400, seed=5)
    covered = 0
    for _ in range(trials):
        values = random.normal(size=clusters)[number] + random.normal(size=len(number))
        low, high = interval(weights @ values / weights.sum(axis=1), 0.95)
        covered += bool(low <= 0 <= high)
    assert 0.91 <= covered / trials <= 0.98


def test_the_interval_of_f1_covers_that_of_all_images_as_often_as_it_says() -> None:
    """Samples of 40 images out of many, in which images with more lines are harder."""
    random = np.random.default_rng(4)
    labels = random.integers(2, 30, 20_000)
    tp = random.binomial(labels, np.clip(0.95 - 0.02 * labels + random.normal(0, 0.1, len(labels)), 0.05, 0.95))
    tallies = np.stack([tp, random.poisson(5, len(labels)), labels - tp], axis=1).astype(float)

    def f1_of(rows: np.ndarray):
        def measure(weights: np.ndarray) -> dict[str, np.ndarray]:
            hits, false_alarms, misses = (weights @ rows).T
            return {"f1": 2 * hits / (2 * hits + false_alarms + misses)}

        return measure

    truth = f1_of(tallies)(np.ones((1, len(tallies))))["f1"][0]
    covered = 0
    for _ in range(400):
        sample = tallies[random.integers(0, len(tallies), 40)]
        found = estimates(f1_of(sample), np.arange(40), 300, seed=1)["f1"]
        assert found.low is not None
        assert found.high is not None
        covered += found.low <= truth <= found.high
    assert 0.90 <= covered / 400 <= 0.98


def test_clustered_images_taken_as_independent_promise_too_much() -> None:
    number = np.repeat(np.arange(30), 8)
    values = np.random.default_rng(2).normal(size=30)[number]
    clustered = estimates(mean_of(values), number, 1000, seed=0)["mean"]
    alone = estimates(mean_of(values), np.arange(len(number)), 1000, seed=0)["mean"]
    assert clustered.low is not None
    assert clustered.high is not None
    assert alone.low is not None
    assert alone.high is not None
    assert clustered.high - clustered.low > 2 * (alone.high - alone.low)
