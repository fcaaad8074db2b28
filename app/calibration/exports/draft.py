"""What a format's writer is given, and what it tells of it in every file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.calibration.exports.conversion import Conversion
from app.calibration.exports.intrinsics import Intrinsics
from app.calibration.exports.names import one_line
from app.calibration.lens import CameraLens

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Draft:
    """A file to be written.

    Attributes:
        lens: Our lens.
        intrinsics: To state in it.
        camera_name: As a person wrote it.
        conversion: The lens as the format holds it.
        calibration: The calibration that the lens is from, as its ``as_dict`` gives it.
    """

    lens: CameraLens
    intrinsics: Intrinsics
    camera_name: str
    conversion: Conversion
    calibration: Mapping[str, Any] | None = None

    @property
    def name(self) -> str:
        """The camera's name, safe between quotes and in comments."""
        return one_line(self.camera_name)

    @property
    def focal_length(self) -> float:
        """Focal length of the file's camera matrix, px."""
        return self.conversion.focal_length or self.intrinsics.focal_length

    @property
    def principal_point(self) -> tuple[float, float]:
        """Principal point of the file's camera matrix, px, pixel centre at integers."""
        return self.conversion.principal_point or self.intrinsics.principal_point

    @property
    def camera_matrix(self) -> Array:
        """K of the measured image, float64 ``(3, 3)``, px: rays, distorted, to measured points."""
        return _matrix(self.focal_length, self.principal_point)

    @property
    def corrected_matrix(self) -> Array:
        """K of the corrected image, float64 ``(3, 3)``, px: rays to corrected points. As stated."""
        return _matrix(self.intrinsics.focal_length, self.intrinsics.principal_point)

    @property
    def lines(self) -> tuple[str, ...]:
        """What a reader must know, one sentence each, without line breaks: for comments, fields and answers."""
        return (
            f"Camera {self.name}, {self.lens.width} x {self.lens.height} px, by ClearLines.",
            f"Lens: {self.conversion.model}, refitted over the frame from the {self.lens.family} model.",
            f"Conversion error in the measured image: {self.conversion.error.told}.",
            f"Focal length {self.intrinsics.focal_length:.6g} px: {self.intrinsics.told}.",
            *self.conversion.notes,
        )


def _matrix(focal_length: float, principal_point: tuple[float, float]) -> Array:
    x, y = principal_point
    return np.array([[focal_length, 0, x], [0, focal_length, y], [0, 0, 1]], np.float64)
