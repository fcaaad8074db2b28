"""Images labelled by the same idea of what is a line, and suggestions for each that were learnt on others alone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.review.prior import prior_model
from app.review.training import TrainingSet, train

from .review_images import ReviewImage

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Collection:
    """Images that are labelled by the same idea of what is a line."""

    name: str
    images: Sequence[ReviewImage]

    @property
    def candidates(self) -> int:
        """Candidates in all."""
        return sum(len(image.kept) for image in self.images)

    def examples(self, chosen: NDArray[np.int64]) -> TrainingSet:
        """Return the candidates of the chosen images, with their true verdicts."""
        images = [self.images[index] for index in chosen]
        counts = [len(image.kept) for image in images]
        return TrainingSet(
            np.concatenate([image.features for image in images]),
            np.concatenate([image.kept for image in images]),
            np.repeat(np.arange(len(images)), counts),
        )


def held_out(collection: Collection, folds: int, known: int | None = None) -> list[Array]:
    """Return the probabilities of each image's candidates by models that learnt on other images alone.

    Args:
        collection: The images.
        folds: How many models are trained.
        known: How many images each learns from; all others if left out.
    """
    order = np.random.default_rng(0).permutation(len(collection.images))
    found: dict[int, Array] = {}
    for fold in range(folds):
        test, rest = order[fold::folds], np.setdiff1d(order, order[fold::folds])
        learnt = np.random.default_rng([1, fold]).permutation(rest)[:known]
        prior = prior_model()
        model = train(collection.examples(learnt), seed=0, prior=prior).model if len(learnt) else prior
        found |= {int(index): model.probability(collection.images[index].features) for index in test}
    return [found[index] for index in range(len(collection.images))]
