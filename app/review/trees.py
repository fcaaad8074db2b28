"""Boosted trees as plain arrays: evaluation, what each feature adds, and JSON.

The trees are grown by scikit-learn's histogram gradient boosting and read off it once (`app.review.boosting`); from
then on they are numbers. A node with a feature sends ``x <= threshold`` to the left, and an unknown x where it says; a
leaf is its own child. What a feature adds to a tree's value is the change of the node's mean along the path (Saabas
2014, "Interpreting random forests").
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.errors import InvalidInput

Array = NDArray[np.float64]

MOST_NODES = 100_000
"""Nodes of all trees that a model read from JSON may have."""


@dataclass(frozen=True, eq=False)
class Trees:
    """T trees of N nodes in all.

    Attributes:
        roots: int64 ``(T,)``, node that each tree starts at.
        feature: int64 ``(N,)``, column that a node asks; -1 at a leaf.
        threshold: float64 ``(N,)``.
        left: int64 ``(N,)``, child for ``x <= threshold``; at a leaf, the leaf itself.
        right: int64 ``(N,)``, child for greater x; at a leaf, the leaf itself.
        unknown_left: bool ``(N,)``, whether an unknown x goes to the left.
        value: float64 ``(N,)``, mean of what lies below a node; at a leaf, what it adds.
        depth: Steps from the farthest leaf to its root.
    """

    roots: NDArray[np.int64]
    feature: NDArray[np.int64]
    threshold: Array
    left: NDArray[np.int64]
    right: NDArray[np.int64]
    unknown_left: NDArray[np.bool_]
    value: Array
    depth: int

    def evaluate(self, features: NDArray[Any]) -> Array:
        """Return the sum over all trees for features ``(S, F)``, float64 ``(S,)``."""
        if not len(self.roots):
            return np.zeros(len(features))
        return self.value[self._walk(features, None)].sum(axis=1)

    def contributions(self, features: NDArray[Any]) -> Array:
        """Return what each feature adds to the sum, float64 ``(S, F)``; the roots' means are in none of them."""
        added = np.zeros(features.shape)
        if len(self.roots):
            self._walk(features, added)
        return added

    def _walk(self, features: NDArray[Any], added: Array | None) -> NDArray[np.int64]:
        """Return the leaf of each candidate in each tree, int64 ``(S, T)``; add to `added` along the way."""
        rows = np.arange(len(features))[:, None]
        node = np.broadcast_to(self.roots, (len(features), len(self.roots))).copy()
        for _ in range(self.depth):
            asked = self.feature[node]
            x = features[rows, np.maximum(asked, 0)]
            to_left = np.where(np.isnan(x), self.unknown_left[node], x <= self.threshold[node])
            child = np.where(to_left, self.left[node], self.right[node])
            if added is not None:
                inner = asked >= 0
                change = self.value[child] - self.value[node]
                np.add.at(added, (np.broadcast_to(rows, node.shape)[inner], asked[inner]), change[inner])
            node = child
        return node

    def as_dict(self) -> dict[str, Any]:
        """Return the arrays as JSON-serialisable lists."""
        return {
            "roots": self.roots.tolist(),
            "feature": self.feature.tolist(),
            "threshold": [float(f"{value:.7g}") for value in self.threshold],
            "left": self.left.tolist(),
            "right": self.right.tolist(),
            "unknown_left": self.unknown_left.astype(int).tolist(),
            "value": [float(f"{value:.6g}") for value in self.value],
            "depth": self.depth,
        }

    @classmethod
    def from_dict(cls, fields: Mapping[str, Any], columns: int) -> Trees:
        """Return the trees that `as_dict` gave the fields of.

        Args:
            fields: The fields.
            columns: F, that the trees may ask for.

        Raises:
            InvalidInput: If a field is missing, too large, or leads nowhere.
        """
        try:
            whole = {name: np.asarray(fields[name], np.int64) for name in ("roots", "feature", "left", "right")}
            real = {name: np.asarray(fields[name], np.float64) for name in ("threshold", "value")}
            unknown, depth = np.asarray(fields["unknown_left"], bool), int(fields["depth"])
        except (KeyError, TypeError, ValueError, OverflowError) as error:
            raise InvalidInput("the trees of a model can't be read", where="trees", expected="lists") from error
        count = len(whole["feature"]) if whole["feature"].ndim == 1 else -1
        nodes = [whole["feature"], whole["left"], whole["right"], real["threshold"], real["value"], unknown]
        pointers = np.concatenate([whole[name].reshape(-1) for name in ("roots", "left", "right")])
        if (
            not 0 <= count <= MOST_NODES
            or any(each.shape != (count,) for each in nodes)
            or ((pointers < 0) | (pointers >= count)).any()
            or ((whole["feature"] < -1) | (whole["feature"] >= columns)).any()
            or not 0 <= depth <= 64
            or not all(np.isfinite(each).all() for each in real.values())
        ):
            raise InvalidInput("the trees of a model don't fit together", where="trees")
        return cls(
            whole["roots"].reshape(-1),
            whole["feature"],
            real["threshold"],
            whole["left"],
            whole["right"],
            unknown,
            real["value"],
            depth,
        )


def no_trees() -> Trees:
    """Return trees that add nothing."""
    none, real = np.zeros(0, np.int64), np.zeros(0)
    return Trees(none, none, real, none, none, none.astype(bool), real, 0)


def joined(trees: Sequence[Trees]) -> Trees:
    """Return all trees of several as one."""
    starts = np.cumsum([0, *(len(each.feature) for each in trees)])
    pairs = list(zip(trees, starts, strict=False))
    if not pairs:
        return no_trees()
    return Trees(
        np.concatenate([each.roots + start for each, start in pairs]),
        np.concatenate([each.feature for each in trees]),
        np.concatenate([each.threshold for each in trees]),
        np.concatenate([each.left + start for each, start in pairs]),
        np.concatenate([each.right + start for each, start in pairs]),
        np.concatenate([each.unknown_left for each in trees]),
        np.concatenate([each.value for each in trees]),
        max(each.depth for each in trees),
    )
