"""How far each line of a calibration is from straight, as one table that is stored apart from the result."""

from __future__ import annotations

import io
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

COLUMNS: Mapping[str, type[np.generic]] = {
    "image_id": np.int64,
    "segment_id": np.int64,
    "rms": np.float32,
    "maximum": np.float32,
    "length": np.float32,
    "probability": np.float32,
}


@dataclass(frozen=True, eq=False)
class CalibrationLines:
    """L lines of a calibration, one array ``(L,)`` for each column.

    Attributes:
        rms: RMS distance of its points from its straight line, in the image as it was taken, px.
        maximum: Largest distance, px.
        length: px.
        probability: That it is a straight line of the scene, in [0, 1].
    """

    image_id: NDArray[np.int64]
    segment_id: NDArray[np.int64]
    rms: NDArray[np.float32]
    maximum: NDArray[np.float32]
    length: NDArray[np.float32]
    probability: NDArray[np.float32]

    def __len__(self) -> int:
        return len(self.segment_id)


def no_lines() -> CalibrationLines:
    """Return a table without a line."""
    columns: dict[str, Any] = {name: np.zeros(0, kind) for name, kind in COLUMNS.items()}
    return CalibrationLines(**columns)


def packed_lines(lines: CalibrationLines) -> bytes:
    """Return lines as bytes: plain arrays in an npz."""
    stream = io.BytesIO()
    np.savez_compressed(stream, **{name: getattr(lines, name).astype(kind) for name, kind in COLUMNS.items()})
    return stream.getvalue()


def unpacked_lines(content: bytes) -> CalibrationLines:
    """Return the lines that `packed_lines` made bytes of."""
    with np.load(io.BytesIO(content), allow_pickle=False) as arrays:
        return CalibrationLines(*(arrays[name] for name in COLUMNS))
