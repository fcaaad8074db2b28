"""Learning from decisions what a person keeps.

A logistic regression and boosted trees, both by scikit-learn, give log odds that are averaged, and the prior's are
mixed in as long as few images are decided. What is said of how good the result is comes from images that a model had
not seen: folds are of whole images, as the candidates of one image are alike.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from app.errors import InvalidInput
from app.review.boosting import FEWEST, grow_trees
from app.review.calibration import CalibrationReport, calibration_report, fit_platt
from app.review.features import FEATURES
from app.review.suggestion_model import SuggestionModel
from app.review.trees import Trees, joined

Array = NDArray[np.float64]

FOLDS = 4
PRIOR_IMAGES = 2.0
"""Images decided at which the prior and what was learnt weigh alike."""
CALIBRATION_IMAGES = 3.0
"""Images tested at which half of a correction is believed."""
STRENGTH = 0.03
"""Of the logistic regression: inverse of the penalty on its weights."""
TREES_SHARE = 0.5
"""Of the log odds, where there are trees."""
MOST_EXAMPLES_TESTED = 5000
"""Candidates that the folds are made of; more make the test slow and no surer."""


@dataclass(frozen=True, eq=False)
class TrainingSet:
    """N judged candidates.

    Attributes:
        features: float32 ``(N, F)``, see `app.review.features`.
        kept: bool ``(N,)``, whether a person kept it; ambiguous ones are left out beforehand.
        image_index: int ``(N,)``, equal for candidates of one image.
        weight: float ``(N,)``, or ``None`` where all count alike.
    """

    features: NDArray[np.float32]
    kept: NDArray[np.bool_]
    image_index: NDArray[np.int64]
    weight: Array | None = None

    def __post_init__(self) -> None:
        features = np.asarray(self.features, np.float32)
        count = len(features)
        if features.ndim != 2 or features.shape[1] != len(FEATURES):
            raise InvalidInput(
                f"features of shape {features.shape}", where="features", expected=f"(N, {len(FEATURES)})"
            )
        weight = np.ones(count) if self.weight is None else np.asarray(self.weight, np.float64)
        columns = {
            "kept": np.asarray(self.kept, bool),
            "image_index": np.asarray(self.image_index, np.int64),
            "weight": weight,
        }
        for name, values in columns.items():
            if values.shape != (count,):
                raise InvalidInput(f"{name} of shape {values.shape}", where=name, expected=f"({count},)")
            object.__setattr__(self, name, values)
        object.__setattr__(self, "features", features)

    def __len__(self) -> int:
        return len(self.kept)

    @property
    def images(self) -> int:
        """Number of images."""
        return len(np.unique(self.image_index))

    def select(self, chosen: NDArray[Any]) -> TrainingSet:
        """Return the chosen examples, by mask or index ``(M,)``."""
        assert self.weight is not None  # noqa: S101 - set in __post_init__
        return TrainingSet(self.features[chosen], self.kept[chosen], self.image_index[chosen], self.weight[chosen])


class Trained(NamedTuple):
    """A model, and what it is worth on images it had not seen; no report with fewer than two images or one verdict."""

    model: SuggestionModel
    report: CalibrationReport | None


def train(examples: TrainingSet, *, seed: int, prior: SuggestionModel) -> Trained:
    """Learn from judged candidates.

    Args:
        examples: Judged candidates of any number of images, even none.
        seed: Of the folds and of the trees.
        prior: The model to start from; the answer where there is nothing to learn from.
    """
    if not len(examples) or examples.kept.all() or not examples.kept.any():
        return Trained(prior, None)
    model = _fitted(examples, seed, prior)
    if examples.images < 2:
        return Trained(model, None)
    tested = _some_images(examples, seed)
    evidence, seen = _evidence_on_unseen(tested, seed, prior)
    if not seen.any():
        return Trained(model, None)
    weight = tested.weight
    slope, offset = fit_platt(evidence[seen], tested.kept[seen], None if weight is None else weight[seen])
    # candidates of one image are off together, so that few images say little however many candidates they have
    trust = tested.images / (tested.images + CALIBRATION_IMAGES)
    slope, offset = 1 + trust * (slope - 1), trust * offset
    probability = 1 / (1 + np.exp(-np.clip(slope * evidence[seen] + offset, -700, 700)))
    report = calibration_report(probability, tested.kept[seen], tested.image_index[seen])
    return Trained(replace(model, slope=slope, offset=offset), report)


def _fitted(examples: TrainingSet, seed: int, prior: SuggestionModel) -> SuggestionModel:
    """Return the model before calibration."""
    regression = _regression(examples)
    learnt = regression
    if len(examples) >= FEWEST:
        assert examples.weight is not None  # noqa: S101 - set in __post_init__
        base, trees = grow_trees(examples.features, examples.kept, examples.weight, seed)
        grown = replace(regression, intercept=base, weight=np.zeros(len(FEATURES)), trees=trees)
        learnt = mixed(regression, grown, TREES_SHARE)
    return mixed(prior, learnt, examples.images / (examples.images + PRIOR_IMAGES))


def mixed(first: SuggestionModel, second: SuggestionModel, share: float) -> SuggestionModel:
    """Return the model whose log odds are ``(1 - share)`` of the first's and ``share`` of the second's."""
    if share <= 0:
        return first
    parts = [(first, (1 - share) * first.slope), (second, share * second.slope)]
    # in units of the second's scales; the first's mean moves into the intercept
    mean, scale = second.mean, second.scale
    weight = sum((by * part.weight * scale / part.scale for part, by in parts), np.zeros(len(FEATURES)))
    intercept = sum(
        by * (part.intercept + float(((mean - part.mean) / part.scale) @ part.weight)) for part, by in parts
    )
    intercept += (1 - share) * first.offset + share * second.offset
    trees = [_scaled(part.trees, by) for part, by in parts if len(part.trees.roots) and by > 0]
    return SuggestionModel(intercept, mean, scale, weight, joined(trees))


def _scaled(trees: Trees, by: float) -> Trees:
    return replace(trees, value=trees.value * by)


def _regression(examples: TrainingSet) -> SuggestionModel:
    from sklearn.linear_model import LogisticRegression
    from threadpoolctl import threadpool_limits

    table = examples.features.astype(np.float64)
    known = np.isfinite(table)
    count = np.maximum(known.sum(axis=0), 1)
    mean = np.where(known, table, 0).sum(axis=0) / count
    spread = np.sqrt(np.where(known, (table - mean) ** 2, 0).sum(axis=0) / count)
    scale = np.where(spread > 1e-6, spread, 1.0)
    standard = np.clip(np.where(known, (table - mean) / scale, 0.0), -5, 5)
    with threadpool_limits(1):
        model = LogisticRegression(C=STRENGTH, max_iter=300, tol=1e-3)
        model.fit(standard, examples.kept, sample_weight=examples.weight)
    return SuggestionModel(float(np.ravel(model.intercept_)[0]), mean, scale, model.coef_[0].astype(np.float64))


def _some_images(examples: TrainingSet, seed: int) -> TrainingSet:
    if len(examples) <= MOST_EXAMPLES_TESTED:
        return examples
    images, number = np.unique(examples.image_index, return_inverse=True)
    order = np.random.default_rng([seed, 1]).permutation(len(images))
    total = np.cumsum(np.bincount(number)[order])
    chosen = order[: max(2, int(np.searchsorted(total, MOST_EXAMPLES_TESTED)))]
    return examples.select(np.isin(number, chosen))


def _evidence_on_unseen(examples: TrainingSet, seed: int, prior: SuggestionModel) -> tuple[Array, NDArray[np.bool_]]:
    """Return the log odds of each candidate by models that didn't see its image, and where there are any."""
    images, number = np.unique(examples.image_index, return_inverse=True)
    folds = min(FOLDS, len(images))
    fold = (np.random.default_rng([seed, 2]).permutation(len(images)) % folds)[number]
    evidence, seen = np.zeros(len(examples)), np.zeros(len(examples), bool)
    for test in range(folds):
        held = fold == test
        rest = examples.select(~held)
        if rest.kept.all() or not rest.kept.any():
            continue
        evidence[held] = _fitted(rest, seed, prior).evidence(examples.features[held])
        seen[held] = True
    return evidence, seen
