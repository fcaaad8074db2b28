"""Learning from decisions, and the model as JSON."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from app.errors import InvalidInput
from app.review.features import FEATURES
from app.review.prior import prior_model
from app.review.suggestion_model import SuggestionModel
from app.review.training import Trained, TrainingSet, mixed, train

F = len(FEATURES)
SCORE, LENGTH = FEATURES.index("score"), FEATURES.index("length")


def made_up(images: int, seed: int, each: int = 60) -> TrainingSet:
    """Return candidates that are kept with the odds of three times their score less twice their length."""
    random = np.random.default_rng(seed)
    values = random.normal(size=(images * each, F))
    odds = 3 * values[:, SCORE] - 2 * values[:, LENGTH] - 1
    kept = random.random(len(odds)) < 1 / (1 + np.exp(-odds))
    return TrainingSet(at(values), kept, np.repeat(np.arange(images), each))


def at(values: np.ndarray) -> np.ndarray:
    """Return features that are so many scales from what is typical."""
    prior = prior_model()
    return (prior.mean + values * prior.scale).astype(np.float32)


@pytest.fixture(scope="module")
def trained() -> Trained:
    return train(made_up(20, 1), seed=3, prior=prior_model())


def test_what_decides_is_learnt_and_told(trained: Trained) -> None:
    unseen = made_up(10, 2)
    p = trained.model.probability(unseen.features)
    assert ((p > 0.5) == unseen.kept).mean() > 0.78
    values = np.zeros((1, F))
    values[0, [SCORE, LENGTH]] = 2, 2
    reasons = trained.model.reasons(at(values))[0]
    assert reasons.speaks_for[0] == "score"
    assert "length" in reasons.against


def test_the_report_is_of_unseen_images_and_honest(trained: Trained) -> None:
    report = trained.report
    assert report is not None
    assert (report.count, report.images) == (1200, 20)
    assert report.ece < 0.05
    assert report.error_rate < 0.22 < report.base_error_rate
    assert report.gain == pytest.approx(1 - report.error_rate / report.base_error_rate)
    unseen = made_up(40, 5)
    p = trained.model.probability(unseen.features)
    assert p.mean() == pytest.approx(unseen.kept.mean(), abs=0.04)
    json.dumps(report.as_dict())


def test_json_gives_the_same_model_again(trained: Trained) -> None:
    features = made_up(3, 9).features
    features[::7] = np.nan
    again = SuggestionModel.from_dict(json.loads(json.dumps(trained.model.as_dict())))
    assert again.probability(features) == pytest.approx(trained.model.probability(features), abs=1e-4)
    assert again.reasons(features[:5]) == trained.model.reasons(features[:5])


def test_the_same_seed_gives_the_same_model() -> None:
    one, other = (train(made_up(3, 1), seed=3, prior=prior_model()).model for _ in range(2))
    assert json.dumps(one.as_dict()) == json.dumps(other.as_dict())


def test_nothing_to_learn_from_leaves_the_prior() -> None:
    prior = prior_model()
    examples = made_up(2, 1)
    for nothing in (np.zeros(0, np.int64), np.flatnonzero(examples.kept), np.flatnonzero(~examples.kept)):
        assert train(examples.select(nothing), seed=0, prior=prior) == (prior, None)


def test_one_image_moves_the_prior_but_does_not_replace_it() -> None:
    prior, examples = prior_model(), made_up(1, 4)
    learnt = train(examples, seed=0, prior=prior)
    assert learnt.report is None
    before, after = (model.evidence(examples.features) for model in (prior, learnt.model))
    assert np.corrcoef(before, after)[0, 1] > 0.3
    assert not np.allclose(before, after)


def test_weights_count() -> None:
    examples = made_up(2, 1, each=40)
    heavy = replace(examples, weight=np.where(examples.kept, 9.0, 1.0))
    light = train(examples, seed=0, prior=prior_model()).model.probability(examples.features).mean()
    assert train(heavy, seed=0, prior=prior_model()).model.probability(examples.features).mean() > light + 0.1


def test_a_mixture_of_models_mixes_their_log_odds() -> None:
    random = np.random.default_rng(1)
    first, second = (
        SuggestionModel(random.normal(), random.normal(size=F), np.full(F, scale), random.normal(size=F))
        for scale in (1.0, 2.0)
    )
    first = replace(first, slope=0.5, offset=0.3)
    features = random.normal(size=(5, F)) * 0.3
    blend = mixed(first, second, 0.25)
    assert blend.log_odds(features) == pytest.approx(0.75 * first.log_odds(features) + 0.25 * second.log_odds(features))


def test_the_prior_is_sensible() -> None:
    prior = prior_model()
    rows = np.tile(prior.mean, (2, 1))
    rows[0, SCORE] += 2 * prior.scale[SCORE]
    rows[1, SCORE] -= 2 * prior.scale[SCORE]
    good, bad = prior.probability(rows)
    assert 0.02 < bad < good < 0.98


@pytest.mark.parametrize(
    ("change", "where"),
    [
        ({"version": "0"}, "version"),
        ({"features": ["length"]}, "version"),
        ({"mean": [0.0]}, "model"),
        ({"intercept": "much"}, "model"),
        ({"slope": float("nan")}, "model"),
        ({"scale": [0.0] * F}, "scale"),
    ],
)
def test_a_model_that_fits_not_is_refused(change: dict[str, object], where: str) -> None:
    with pytest.raises(InvalidInput, match=where):
        SuggestionModel.from_dict(prior_model().as_dict() | change)


def test_examples_that_do_not_fit_together_are_refused() -> None:
    with pytest.raises(InvalidInput, match="features"):
        TrainingSet(np.zeros((2, 3), np.float32), np.zeros(2, bool), np.zeros(2, np.int64))
    with pytest.raises(InvalidInput, match="kept"):
        TrainingSet(np.zeros((2, F), np.float32), np.zeros(3, bool), np.zeros(2, np.int64))
    with pytest.raises(InvalidInput, match="features"):
        prior_model().probability(np.zeros((2, 3)))
