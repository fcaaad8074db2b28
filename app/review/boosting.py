"""Trees grown by scikit-learn's histogram gradient boosting, read off as plain arrays.

Friedman, "Greedy function approximation: a gradient boosting machine", Annals of Statistics 29, 2001.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.review.trees import Trees, joined, no_trees

Array = NDArray[np.float64]

COPIES = 3
"""Of an example of mean weight, where weights differ."""
FEWEST = 150
"""Candidates from which trees are grown; fewer make them guess."""
ROUNDS, LEAVES, LEAST_IN_LEAF = 70, 8, 15
RATE, SHRINKAGE, COLUMNS = 0.08, 5.0, 0.4


def grow_trees(features: NDArray[Any], kept: NDArray[np.bool_], weight: Array, seed: int) -> tuple[float, Trees]:
    """Grow boosted trees.

    Args:
        features: ``(N, F)``, NaN where unknown.
        kept: bool ``(N,)``, both values.
        weight: Of each candidate, ``(N,)``.
        seed: Of the columns drawn.

    Returns:
        Log odds that the trees start from, and the trees.
    """
    # imported here: a server that only suggests needs no library for learning
    from sklearn.ensemble import HistGradientBoostingClassifier
    from threadpoolctl import threadpool_limits

    model = HistGradientBoostingClassifier(
        max_iter=ROUNDS,
        learning_rate=RATE,
        max_leaf_nodes=LEAVES,
        min_samples_leaf=LEAST_IN_LEAF,
        l2_regularization=SHRINKAGE,
        max_features=COLUMNS,
        early_stopping=False,  # pyright: ignore[reportArgumentType] - its default is a word
        random_state=seed,
    )
    # columns that say nothing (nothing known, or one value) are no use to it, and it refuses those without any value
    telling = np.flatnonzero(
        [np.ptp(column[np.isfinite(column)]) > 0 if np.isfinite(column).any() else False for column in features.T]
    )
    if not len(telling):
        return _log_odds(kept, weight), no_trees()
    with threadpool_limits(1):
        rows = _copies(weight)
        model.fit(features[np.ix_(rows, telling)], kept[rows])
    trees = joined([_tree(stage[0].nodes) for stage in model._predictors])
    feature = np.where(trees.feature >= 0, telling[np.maximum(trees.feature, 0)], -1)
    return float(np.ravel(model._baseline_prediction)[0]), replace(trees, feature=feature)


def _copies(weight: Array) -> NDArray[np.int64]:
    """Return each row as often as its weight says; given as weights, they would cost the library ten times the time."""
    rows = np.arange(len(weight))
    if np.ptp(weight) == 0:
        return rows
    return np.repeat(rows, np.rint(COPIES * weight / weight.mean()).astype(np.int64))


def _log_odds(kept: NDArray[np.bool_], weight: Array) -> float:
    return float(np.log(((weight * kept).sum() + 0.5) / ((weight * ~kept).sum() + 0.5)))


def _tree(nodes: NDArray[Any]) -> Trees:
    """Read one tree off the library's records."""
    leaf = nodes["is_leaf"].astype(bool)
    own = np.arange(len(nodes))
    left = np.where(leaf, own, nodes["left"].astype(np.int64))
    right = np.where(leaf, own, nodes["right"].astype(np.int64))
    value = nodes["value"].astype(np.float64)
    count = nodes["count"].astype(np.float64)
    # children come after their parents, so that going backwards their means are known
    for node in own[::-1]:
        if not leaf[node]:
            children = [left[node], right[node]]
            value[node] = np.average(value[children], weights=np.maximum(count[children], 1e-9))
    return Trees(
        np.zeros(1, np.int64),
        np.where(leaf, -1, nodes["feature_idx"].astype(np.int64)),
        np.where(leaf, 0.0, nodes["num_threshold"].astype(np.float64)),
        left,
        right,
        nodes["missing_go_to_left"].astype(bool),
        value,
        int(nodes["depth"].max()),
    )
