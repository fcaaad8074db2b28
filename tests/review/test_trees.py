"""Trees as arrays say what the library that grew them says."""

from __future__ import annotations

import json

import numpy as np
import pytest

from app.errors import InvalidInput
from app.review.boosting import grow_trees
from app.review.trees import Trees, joined, no_trees


@pytest.fixture(scope="module")
def examples() -> tuple[np.ndarray, np.ndarray]:
    random = np.random.default_rng(0)
    features = random.normal(size=(600, 5)).astype(np.float32)
    features[random.random(features.shape) < 0.1] = np.nan
    kept = np.nan_to_num(features[:, 0]) * np.nan_to_num(features[:, 1], nan=1.0) > 0.2
    features[:, 4] = np.nan
    return features, kept


def test_trees_are_those_of_the_library(examples: tuple[np.ndarray, np.ndarray]) -> None:
    from sklearn.ensemble import HistGradientBoostingClassifier

    from app.review import boosting

    features, kept = examples
    base, trees = grow_trees(features, kept, np.ones(len(kept)), 7)
    library = HistGradientBoostingClassifier(
        max_iter=boosting.ROUNDS,
        learning_rate=boosting.RATE,
        max_leaf_nodes=boosting.LEAVES,
        min_samples_leaf=boosting.LEAST_IN_LEAF,
        l2_regularization=boosting.SHRINKAGE,
        max_features=boosting.COLUMNS,
        early_stopping=False,  # pyright: ignore[reportArgumentType]
        random_state=7,
    ).fit(features[:, :4], kept)
    assert base + trees.evaluate(features) == pytest.approx(library.decision_function(features[:, :4]), abs=1e-6)


def test_contributions_add_up_to_the_value_less_the_roots(examples: tuple[np.ndarray, np.ndarray]) -> None:
    features, kept = examples
    _, trees = grow_trees(features, kept, np.ones(len(kept)), 1)
    added = trees.contributions(features)
    assert added.sum(axis=1) == pytest.approx(trees.evaluate(features) - trees.value[trees.roots].sum(), abs=1e-9)
    assert (added[:, 4] == 0).all()
    assert np.abs(added[:, :2]).mean() > 3 * np.abs(added[:, 2:4]).mean()


def test_a_tree_by_hand() -> None:
    tree = Trees(
        np.array([0]),
        np.array([0, -1, -1]),
        np.array([1.0, 0, 0]),
        np.array([1, 1, 2]),
        np.array([2, 1, 2]),
        np.array([False, False, False]),
        np.array([0.5, -1.0, 2.0]),
        1,
    )
    features = np.array([[0.0], [1.0], [1.5], [np.nan]])
    assert tree.evaluate(features).tolist() == [-1, -1, 2, 2]
    assert joined([tree, tree]).evaluate(features).tolist() == [-2, -2, 4, 4]
    assert tree.contributions(features)[:, 0].tolist() == [-1.5, -1.5, 1.5, 1.5]
    again = Trees.from_dict(json.loads(json.dumps(tree.as_dict())), 1)
    assert again.evaluate(features).tolist() == [-1, -1, 2, 2]


@pytest.mark.parametrize(
    "change",
    [{"left": [5, 1, 2]}, {"feature": [3, -1, -1]}, {"value": [1.0]}, {"depth": 10**9}, {"threshold": ["a", 0, 0]}],
)
def test_trees_that_lead_nowhere_are_refused(change: dict[str, object]) -> None:
    fields = {
        "roots": [0],
        "feature": [0, -1, -1],
        "threshold": [1.0, 0, 0],
        "left": [1, 1, 2],
        "right": [2, 1, 2],
        "unknown_left": [0, 0, 0],
        "value": [0.5, -1, 2],
        "depth": 1,
    }
    Trees.from_dict(fields, 2)
    with pytest.raises(InvalidInput, match="trees"):
        Trees.from_dict(fields | change, 2)


def test_no_trees_add_nothing() -> None:
    assert no_trees().evaluate(np.ones((3, 2))).tolist() == [0, 0, 0]
    assert Trees.from_dict(no_trees().as_dict(), 2).evaluate(np.ones((1, 2))).tolist() == [0]
