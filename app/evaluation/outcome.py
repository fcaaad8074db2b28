"""What became of each prediction and of each label, whatever the protocol."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray


class Outcome(IntEnum):
    """What a protocol says about one segment."""

    HIT = 0
    """A prediction that counts as true positive; a label that was found."""
    FALSE_ALARM = 1
    """A prediction that counts as false positive."""
    MISS = 2
    """A label that wasn't found."""
    IGNORED = 3
    """A prediction or label that counts neither way."""


@dataclass(frozen=True, eq=False)
class Outcomes:
    """The outcome of every segment of one image.

    Attributes:
        predictions: int8 ``(P,)``: ``HIT``, ``FALSE_ALARM`` or ``IGNORED``.
        labels: int8 ``(L,)``: ``HIT``, ``MISS`` or ``IGNORED``.
    """

    predictions: NDArray[np.int8]
    labels: NDArray[np.int8]

    def counted(self, outcome: Outcome) -> int:
        """Return how many segments a picture shows with this outcome; hits are counted among the predictions."""
        of_predictions = int((self.predictions == outcome).sum())
        of_labels = int((self.labels == outcome).sum())
        return of_predictions if outcome is Outcome.HIT else of_predictions + of_labels


def prediction_outcomes(hit: NDArray[np.bool_], ignored: NDArray[np.bool_]) -> NDArray[np.int8]:
    """Return the outcome of each prediction from two masks ``(P,)``; being a hit comes first."""
    return np.select([hit, ignored], [Outcome.HIT, Outcome.IGNORED], Outcome.FALSE_ALARM).astype(np.int8)


def label_outcomes(found: NDArray[np.bool_], ignored: NDArray[np.bool_]) -> NDArray[np.int8]:
    """Return the outcome of each label from two masks ``(L,)``; being ignored comes first."""
    return np.select([ignored, found], [Outcome.IGNORED, Outcome.HIT], Outcome.MISS).astype(np.int8)
