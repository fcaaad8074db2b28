"""What predictions are scored against: the labels of an image, some of which may be left out of the count."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.errors import InvalidSegments
from app.vision.segments import Segments


@dataclass(frozen=True, eq=False)
class GroundTruth:
    """The labels of one image.

    Attributes:
        segments: L labels, px.
        ignored: bool ``(L,)``; an ignored label is neither to be found nor held against who finds it.

    Raises:
        InvalidSegments: When ``ignored`` doesn't have one value per label.
    """

    segments: Segments
    ignored: NDArray[np.bool_]

    def __post_init__(self) -> None:
        ignored = np.asarray(self.ignored, dtype=bool)
        if ignored.shape != (len(self.segments),):
            raise InvalidSegments(
                f"the ignore mask has shape {ignored.shape}", where="ignored", expected=f"({len(self.segments)},)"
            )
        object.__setattr__(self, "ignored", ignored)

    def __len__(self) -> int:
        return len(self.segments)


def ground_truth(labels: Segments, ambiguous: Segments | None = None, min_length: float = 0.0) -> GroundTruth:
    """Return the labels and the ambiguous ones behind them; ambiguous and short ones are ignored.

    Args:
        labels: The labels that were kept, px.
        ambiguous: Labels of which nobody can say whether they are one; they follow after ``labels``.
        min_length: Labels whose arc length is less, px, are ignored as well.
    """
    if ambiguous is None or not len(ambiguous):
        segments = labels
    else:
        segments = Segments(
            np.concatenate([labels.points, ambiguous.points]),
            np.concatenate([labels.offsets, labels.offsets[-1] + ambiguous.offsets[1:]]),
        )
    is_ambiguous = np.arange(len(segments)) >= len(labels)
    return GroundTruth(segments, is_ambiguous | (segments.lengths() < min_length))


def long_enough(predictions: Segments, min_length: float) -> Segments:
    """Return the predictions whose arc length is at least ``min_length`` px: shorter ones aren't scored."""
    return predictions if min_length <= 0 else predictions.select(predictions.lengths() >= min_length)
