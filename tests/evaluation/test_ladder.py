from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.errors import InvalidInput
from app.evaluation.bootstrap import bootstrap_weights
from app.evaluation.ladder import exceeds_noise, ladder


def test_a_rise_is_shown_only_beyond_one_standard_error() -> None:
    noise = np.array([-0.01, 0.01])
    assert not exceeds_noise(0.009, 0.009 + noise)
    assert exceeds_noise(0.011, 0.011 + noise)


def test_a_rise_without_noise_must_still_be_a_step() -> None:
    assert not exceeds_noise(0.0009, np.full(5, 0.0009))
    assert exceeds_noise(0.0011, np.full(5, 0.0011))
    assert not exceeds_noise(0.0, np.zeros(5))


def test_the_shown_best_stays_until_it_is_clearly_exceeded() -> None:
    noise = np.random.default_rng(0).normal(0, 0.02, (5, 500))
    values = np.array([0.5, 0.51, 0.45, 0.6, 0.59])
    assert ladder(values, values[:, None] + noise).tolist() == [0, 0, 0, 3, 3]


def test_many_small_rises_add_up_against_the_one_shown() -> None:
    """Each is within the noise of the one before, the third isn't within that of the first."""
    values = np.array([0.5, 0.505, 0.52])
    drawn = values[:, None] + np.array([[0.0], [1.0], [0.0]]) * np.array([-0.01, 0.01])
    assert ladder(values, drawn).tolist() == [0, 0, 2]


def test_nobody_climbs_by_luck() -> None:
    """Of 300 submissions of pure chance, the Ladder shows far less than the best seen."""
    random = np.random.default_rng(1)
    answers = random.random((300, 100)) < 0.5
    weights = bootstrap_weights(np.arange(100), 300, seed=0)
    values, drawn = answers.mean(axis=1), answers @ weights.T / 100
    shown = ladder(values, drawn)
    assert len(set(shown.tolist())) < 8
    assert values.max() >= values[shown[-1]] >= values[0]


@given(values=st.lists(st.floats(0, 1), max_size=8))
def test_a_shown_best_never_falls(values: list[float]) -> None:
    scores = np.array(values)
    shown = ladder(scores, np.repeat(scores[:, None], 3, axis=1))
    assert (np.diff(scores[shown]) >= 0).all()
    assert (shown <= np.arange(len(scores))).all()


def test_draws_of_other_submissions_are_refused() -> None:
    with pytest.raises(InvalidInput, match="don't go with"):
        ladder(np.zeros(3), np.zeros((2, 10)))
