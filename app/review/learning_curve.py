"""What suggestions would have spared on each image, by a model of the images finished before it.

The images are taken in the order in which they were finished: a model learns from the first ones and is tested on those
that come next, then it learns from these too ("test, then train"; Gama, Sebastião and Rodrigues, Machine Learning 90,
2013). So each image is judged once, by a model that hadn't seen it, and the numbers show how the model grew.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from app.review.suggestion_model import SuggestionModel
from app.review.thresholds import Thresholds, thresholds_for
from app.review.training import TrainingSet, train

Array = NDArray[np.float64]

GROWTH = 1.6
"""A model of the curve learns from so many times the images of the one before."""
PRIOR_THRESHOLDS = Thresholds(keep=0.8, reject=0.2)
"""Of the general model: it has seen none of the dataset's images, so more is left to a person."""


class ImageGain(NamedTuple):
    """What one image costs, with suggestions and without.

    Attributes:
        images: Images that the model had learnt from.
        candidates: Of the image.
        keys: With suggestions; see `keys_with`.
        keys_by_hand: Without; see `keys_by_hand`.
    """

    images: int
    candidates: int
    keys: int
    keys_by_hand: int


@dataclass(frozen=True, eq=False)
class LearningCurve:
    """The images of a training set in the order in which they were finished.

    Attributes:
        probability: float64 ``(N,)`` of each example, by a model that hadn't seen its image.
        images_before: int64 ``(N,)``, images that this model had learnt from.
    """

    probability: Array
    images_before: NDArray[np.int64]


def learning_curve(examples: TrainingSet, *, seed: int, prior: SuggestionModel) -> LearningCurve:
    """Judge each image by a model of the images before it.

    Args:
        examples: N judged candidates; the image that was finished first has the least index.
        seed: Of the trainings.
        prior: The model that they start from; it judges the first image.
    """
    images, number = np.unique(examples.image_index, return_inverse=True)
    probability = np.zeros(len(examples))
    before = np.zeros(len(examples), np.int64)
    for known, end in _stages(len(images)):
        model = train(examples.select(number < known), seed=seed, prior=prior).model if known else prior
        tested = (number >= known) & (number < end)
        probability[tested] = model.probability(examples.features[tested])
        before[tested] = known
    return LearningCurve(probability, before)


def gains(curve: LearningCurve, examples: TrainingSet, thresholds: Thresholds) -> list[ImageGain]:
    """Return what each image would have cost with suggestions of these thresholds, in the order of the curve."""
    found: list[ImageGain] = []
    for image in np.unique(examples.image_index):
        rows = examples.image_index == image
        kept = examples.kept[rows]
        keys = keys_with(curve.probability[rows], kept, thresholds)
        found.append(ImageGain(int(curve.images_before[rows][0]), int(rows.sum()), keys, keys_by_hand(kept)))
    return found


def keys_with(probability: Array, kept: NDArray[np.bool_], thresholds: Thresholds) -> int:
    """Return the keys and clicks that an image costs with suggestions.

    One accepts them, two each put a wrong one right (select it, judge it), one each judges what is left.

    Args:
        probability: ``(S,)``.
        kept: bool ``(S,)``, what a person decided.
        thresholds: From which probabilities on something is suggested.
    """
    keep, reject = probability >= thresholds.keep, probability < thresholds.reject
    wrong = int((keep & ~kept).sum() + (reject & kept).sum())
    left = int((~keep & ~reject).sum())
    return int((keep | reject).any()) + 2 * wrong + left


def keys_by_hand(kept: NDArray[np.bool_]) -> int:
    """Return the keys and clicks that an image costs without suggestions, by the cheaper of two ways.

    Either one judges each candidate, or two each keep a true one (select it, judge it) and one rejects the rest.
    """
    return min(len(kept), 2 * int(kept.sum()) + 1)


def recommended_thresholds(curve: LearningCurve, error_rate: float, otherwise: Thresholds) -> Thresholds:
    """Return thresholds at which what is accepted is wrong at most at a wanted rate.

    Args:
        curve: Its probabilities are those of images that the model hadn't seen, as those to come.
        error_rate: In [0, 1].
        otherwise: As long as there is no image but the first.
    """
    learnt = curve.images_before > 0
    return thresholds_for(curve.probability[learnt], error_rate) if learnt.any() else otherwise


def _stages(images: int) -> Iterator[tuple[int, int]]:
    """Yield how many images are known, and up to which one is tested then."""
    known = 0
    while known < images:
        end = min(images, max(known + 1, int(known * GROWTH)))
        yield known, end
        known = end
