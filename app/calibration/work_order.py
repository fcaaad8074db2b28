"""What whoever has a calibration made gives, and gets: plain arrays and fields, so that any process may do the work."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.vision.segments import Segments


@dataclass(frozen=True, eq=False)
class StoredLines:
    """Lines of one image.

    Attributes:
        segment_ids: int64 ``(S,)``.
        segments: Their points, px.
        probability: float64 ``(S,)`` in [0, 1] that each is straight; ``None`` where a person kept all of them.
    """

    image_id: int
    name: str
    segment_ids: NDArray[np.int64]
    segments: Segments
    probability: NDArray[np.float64] | None


@dataclass(frozen=True, eq=False)
class CalibrationInputs:
    """What one calibration is made from.

    Attributes:
        images: Images with at least one line.
        unlabelled: Candidates of images that nobody has labelled yet, for the advice.
        parameters: What was read and what there was: ids of ``images`` in their order, number of ``segments``,
            ``images_available``, ``segments_available``, the bounds, and the ``newest_decision`` that was known.
    """

    images: tuple[StoredLines, ...]
    unlabelled: tuple[StoredLines, ...]
    parameters: dict[str, Any]


@dataclass(frozen=True, eq=False)
class CalibrationFound:
    """What a worker made of a camera's lines.

    Attributes:
        parameters: Those of the inputs.
        result: ``Calibration.as_dict``.
        lines: npz bytes of `app.calibration.line_table`.
        advice: ``{"cells": [...], "images": [{"image_id", "gain"}]}``.
    """

    parameters: dict[str, Any]
    result: dict[str, Any]
    lines: bytes
    advice: dict[str, Any]
