"""What suggestions would have spared, image by image, and how much each feature counts."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from app.review.feature_weights import feature_weights, linear_weights
from app.review.features import FEATURES
from app.review.learning_curve import (
    PRIOR_THRESHOLDS,
    LearningCurve,
    gains,
    keys_by_hand,
    keys_with,
    learning_curve,
    recommended_thresholds,
)
from app.review.prior import prior_model
from app.review.thresholds import Thresholds
from app.review.training import TrainingSet, train

ROOT = Path(__file__).resolve().parent.parent.parent
WORDS = ROOT / "frontend" / "src" / "labelling" / "suggestions" / "feature_words.ts"


def examples(images: int, per_image: int = 12, *, seed: int = 3) -> TrainingSet:
    """Candidates of which one feature tells all, the other way round than the prior has it."""
    random = np.random.default_rng(seed)
    count = images * per_image
    kept = random.random(count) < 0.4
    features = np.full((count, len(FEATURES)), np.nan, np.float32)
    features[:, FEATURES.index("score")] = np.where(kept, -2, 2) + random.normal(0, 0.4, count)
    return TrainingSet(features, kept, np.repeat(np.arange(images), per_image))


def test_keys_with_suggestions_are_counted() -> None:
    thresholds = Thresholds(0.8, 0.2)
    probability = np.array([0.9, 0.9, 0.1, 0.1, 0.5])
    # all right: one key accepts four, one judges the last
    assert keys_with(probability, np.array([True, True, False, False, True]), thresholds) == 2
    # one kept wrongly, one rejected wrongly: two keys each
    assert keys_with(probability, np.array([True, False, True, False, True]), thresholds) == 6
    # nothing is suggested: no key accepts it
    assert keys_with(np.full(3, 0.5), np.array([True, True, False]), thresholds) == 3


@pytest.mark.parametrize(("kept", "count", "keys"), [(0, 10, 1), (2, 10, 5), (5, 10, 10), (10, 10, 10), (1, 1, 1)])
def test_keys_by_hand_are_those_of_the_cheaper_way(kept: int, count: int, keys: int) -> None:
    assert keys_by_hand(np.arange(count) < kept) == keys


def test_each_image_is_judged_by_a_model_of_those_before_it() -> None:
    given = examples(6)
    curve = learning_curve(given, seed=0, prior=prior_model())
    before = [int(curve.images_before[given.image_index == image][0]) for image in range(6)]
    assert before == [0, 1, 2, 3, 4, 4]
    first = given.image_index == 0
    np.testing.assert_allclose(curve.probability[first], prior_model().probability(given.features[first]))
    right = (curve.probability >= 0.5) == given.kept
    assert right[first].mean() < right[given.image_index >= 4].mean()

    entries = gains(curve, given, Thresholds(0.5, 0.5))
    assert [entry.images for entry in entries] == before
    assert {entry.candidates for entry in entries} == {12}
    assert entries[-1].keys == 1 + 2 * int((~right[given.image_index == 5]).sum())


def test_what_comes_later_changes_nothing_before_it() -> None:
    whole, part = examples(5), examples(5)
    chosen = part.image_index < 3
    short = learning_curve(part.select(chosen), seed=0, prior=prior_model())
    long = learning_curve(whole, seed=0, prior=prior_model())
    np.testing.assert_allclose(short.probability, long.probability[chosen])


def test_thresholds_follow_from_images_after_the_first() -> None:
    curve = LearningCurve(np.array([0.01, 0.99, 0.6, 0.4]), np.array([0, 0, 1, 1]))
    assert recommended_thresholds(curve, 0.5, PRIOR_THRESHOLDS) == Thresholds(0.5, 0.5)
    alone = LearningCurve(curve.probability[:2], curve.images_before[:2])
    assert recommended_thresholds(alone, 0.5, PRIOR_THRESHOLDS) == PRIOR_THRESHOLDS


def test_weights_name_what_counts_and_which_way() -> None:
    given = examples(4)
    model = train(given, seed=0, prior=prior_model()).model
    weights = feature_weights(model, given.features)
    assert weights[0].feature == "score"
    assert weights[0].weight < 0
    sizes = [abs(each.weight) for each in weights]
    assert sizes == sorted(sizes, reverse=True)
    assert len({each.feature for each in linear_weights(prior_model())}) > 10


def test_the_pages_have_words_for_every_feature() -> None:
    said = re.findall(r'^  (?:"([^"]+)"|(\w+)): words\(', WORDS.read_text(), re.MULTILINE)
    assert {quoted or plain for quoted, plain in said} == set(FEATURES)
