"""An image of a split and what was submitted for it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from app.evaluation.ground_truth import GroundTruth
from app.evaluation.rejected_lines import RejectedLines
from app.vision.segments import Segments


@dataclass(frozen=True)
class SplitImageInfo:
    """What a split knows of an image, its labels aside.

    Attributes:
        name: Its name.
        width: px; ``None`` if unknown, and then the image has no strata by distance and no camera.
        height: px; likewise.
        source: Dataset or place it comes from, if known.
        sequence: The drive it belongs to; images of one sequence are one cluster of the bootstrap.
        camera: Name of its camera.
        reference: The camera's distortion as known from elsewhere, ``{"K": 3 x 3, "D": [...]}`` in OpenCV's convention.
    """

    name: str
    width: int | None = None
    height: int | None = None
    source: str | None = None
    sequence: str | None = None
    camera: str | None = None
    reference: Mapping[str, Any] | None = None

    @property
    def size(self) -> tuple[int, int] | None:
        """Width and height, px, if both are known."""
        return None if self.width is None or self.height is None else (self.width, self.height)


@dataclass(frozen=True, eq=False)
class ScoredImage:
    """An image to be scored.

    Attributes:
        info: What the split knows of it.
        truth: Its L labels.
        predictions: All P segments that were submitted for it, px.
        rejected: Candidates that people rejected with a reason; they change no score.
    """

    info: SplitImageInfo
    truth: GroundTruth
    predictions: Segments
    rejected: RejectedLines | None = None
