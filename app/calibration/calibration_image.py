"""What a calibration is made of: the lines of one image."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.errors import InvalidInput
from app.vision.segments import Segments

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class CalibrationImage:
    """An image's lines.

    Attributes:
        name: What the image is called in the result.
        segments: In px.
        probability: float64 ``(S,)`` in [0, 1] of being straight; ``None`` if a person kept them all.
    """

    name: str
    segments: Segments
    probability: Array | None = None

    def __post_init__(self) -> None:
        if self.probability is not None and np.shape(self.probability) != (len(self.segments),):
            raise InvalidInput(
                f"{np.size(self.probability)} probabilities for {len(self.segments)} segments", where=self.name
            )
