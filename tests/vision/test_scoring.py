"""Features and the score made of them."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.vision.native.records import FINDING
from app.vision.scoring import FEATURES, INTERCEPT, LEAST_SCORE, WEIGHTS, measure_features, score

GOOD = {"chord": 200, "samples": 200, "hits": 198, "close": 190, "rms": 0.1, "mean_norm": 200}


def finding(**values: float) -> np.ndarray:
    found = np.zeros(1, FINDING)
    for name, value in {**GOOD, **values}.items():
        found[name] = value
    return found


def scored(**values: float) -> float:
    return float(score(measure_features(finding(**values)))[0])


def test_the_score_is_the_logistic_of_the_weighted_sum() -> None:
    features = measure_features(finding())
    evidence = INTERCEPT + sum(WEIGHTS[name] * values[0] for name, values in features.items())
    assert scored() == pytest.approx(1 / (1 + np.exp(-evidence)))


def test_every_weight_has_its_feature() -> None:
    assert set(WEIGHTS) <= set(FEATURES)


def test_a_well_supported_segment_is_better_than_a_doubtful_one() -> None:
    assert scored() > 2 * scored(hits=90, close=40, rms=0.5, longest_gap=50)


@given(
    st.fixed_dictionaries(
        {
            name: st.floats(0 if name != "contrast" else -1e6, 1e6, width=32)
            for name in FINDING.names or ()
            if name not in ("arc", "first", "last", "samples")
        }
    )
)
def test_any_measurement_gives_a_score_between_zero_and_one(values: dict[str, float]) -> None:
    # a segment has two samples at least
    assert 0 <= scored(**{**values, "samples": 2.0}) <= 1


def test_no_findings_have_no_scores() -> None:
    assert score(measure_features(np.zeros(0, FINDING))).shape == (0,)


def test_operating_points_rise_from_recall_to_precise() -> None:
    assert 0 <= LEAST_SCORE["recall"] < LEAST_SCORE["balanced"] < LEAST_SCORE["precise"] < 1
