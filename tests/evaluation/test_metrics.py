from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.evaluation import metrics as formula
from app.evaluation.tallies import GRID_TAUS, GRID_THRESHOLDS, LAYOUT, METRICS, OFFSET_BINS, metrics

count = st.integers(0, 50)


@given(count, count, count)
def test_f1_is_the_harmonic_mean_of_precision_and_recall(tp: int, fp: int, fn: int) -> None:
    p, r = formula.precision(tp, fp, fn), formula.recall(tp, fp, fn)
    assert formula.f1(tp, fp, fn) == pytest.approx(formula.harmonic_mean(p, r))


def test_quantiles_of_a_histogram() -> None:
    histogram = np.zeros(300)
    histogram[100:200] = 1.0  # spread evenly from 1 to 2 px
    assert formula.offset_quantile(histogram, 0.5, 3.0) == pytest.approx(1.5)
    assert formula.offset_quantile(histogram, 0.95, 3.0) == pytest.approx(1.95)
    assert math.isnan(formula.offset_quantile(np.zeros(300), 0.5, 3.0))


@given(st.lists(st.floats(0, 3), min_size=1, max_size=60), st.sampled_from([0.5, 0.95]))
def test_quantiles_are_those_of_the_values_but_for_a_bin(values: list[float], share: float) -> None:
    bins = np.minimum(np.array(values) * 100, 299).astype(int)
    found = formula.offset_quantile(np.bincount(bins, minlength=300), share, 3.0)
    # between the neighbours that an empirical quantile may take
    low, high = (np.quantile(values, share, method=method) for method in ("inverted_cdf", "higher"))
    assert low - 0.0101 <= found <= high + 0.0101


def test_quality_by_hand() -> None:
    assert formula.quality(1, 1) == 1
    assert formula.quality(0, 0) == 0
    assert formula.quality(1, 0) == 0
    # 60 of 100 labelled, 60 of 80 predicted: 60 / (100 + 80 - 60)
    assert formula.quality(0.6, 0.75) == pytest.approx(60 / 120)


def parts() -> dict[str, object]:
    return {
        "tp": 4,
        "fp": 2,
        "fn": 1,
        "grid_tp": np.full((4, 10), 4),
        "grid_fp": np.full((4, 10), 2),
        "labelled": 500,
        "labelled_covered": 400,
        "predicted": 640,
        "predicted_covered": 480,
        "detected": 4,
        "predictions_on_detected": 6,
        "merging": 1,
        "sampled": 300,
        "offset_sum": 150,
        "offset_histogram": np.eye(OFFSET_BINS)[50] * 300,
        "bias_sum": -2,
        "angle_sum": 0.04,
        "translation_sum": 3,
        "liou_sum": 3.2,
    }


def test_every_metric_of_known_tallies() -> None:
    found = metrics(LAYOUT.pack(parts()))  # type: ignore[arg-type]
    assert tuple(found) == METRICS
    assert (found.pop("f1_grid") == 8 / 11).all()
    assert {name: value.item() for name, value in found.items()} == pytest.approx(
        {
            "f1": 8 / 11,
            "precision": 4 / 6,
            "recall": 4 / 5,
            "tp": 4,
            "fp": 2,
            "fn": 1,
            "mean_f1": 8 / 11,
            "completeness": 0.8,
            "correctness": 0.75,
            "quality": 0.6 / 0.95,
            "fragmentation": 1.5,
            "merge": 0.25,
            "redundancy": 80 / 480,
            "offset_mean": 0.5,
            "offset_median": 0.505,
            "offset_p95": 0.5095,
            "bias": -0.5,
            "angle_error": 0.01,
            "translation_error": 0.75,
            "mean_liou": 0.8,
        }
    )


def test_the_grid_is_that_of_the_definition() -> None:
    assert GRID_TAUS == (1, 2, 3, 5)
    assert GRID_THRESHOLDS == (0.5, 0.55, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95)


def test_many_draws_at_once_are_the_same_as_one_by_one() -> None:
    random = np.random.default_rng(5)
    images = random.integers(0, 20, (7, LAYOUT.size)).astype(float)
    weights = random.poisson(1.0, (11, 7)).astype(float)
    together = metrics(weights @ images)
    for draw, weight in enumerate(weights):
        alone = metrics(np.repeat(images, weight.astype(int), axis=0).sum(axis=0))
        for name, value in alone.items():
            assert together[name][draw] == pytest.approx(value, nan_ok=True), name


def test_a_missing_part_is_refused() -> None:
    with pytest.raises(KeyError):
        LAYOUT.pack({"tp": 1})
