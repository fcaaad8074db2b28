"""Points of the frame with the rays that a lens sees them along: what every export is fitted to and measured on."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from app.calibration.exports.intrinsics import Intrinsics
from app.calibration.lens import CameraLens
from app.errors import CannotExport
from app.vision.frame import frame_grid

Array = NDArray[np.float64]

FIT_COLUMNS, CHECK_COLUMNS = 40, 67
"""Columns of the grid that is fitted to and of the finer one, of other points, that the error is told of."""
SMALLEST_SIDE = 8
"""px; on less there is nothing to fit."""


class ConversionError(NamedTuple):
    """How far a file's lens lies from ours over the frame: px of the measured image, with the file's camera matrix.

    Attributes:
        rms: Root mean square.
        maximum: Largest.
    """

    rms: float
    maximum: float

    @property
    def told(self) -> str:
        """The error as a phrase."""
        return f"{self.rms:.4f} px rms, {self.maximum:.4f} px at most"

    @classmethod
    def between(cls, points: Array, others: Array) -> ConversionError:
        """Return the distance of corresponding points ``(N, 2)``."""
        distance = np.hypot(*(points - others).T)
        return cls(float(np.sqrt(np.mean(distance**2))), float(distance.max()))


class Rays(NamedTuple):
    """Corresponding points, float64 ``(N, 2)`` each.

    Attributes:
        measured: px in the image as taken.
        corrected: px in the image without distortion.
        rays: (corrected - principal point) / focal length, no unit.
        area: ``(N,)``, area in the measured image per area in the corrected one.
    """

    measured: Array
    corrected: Array
    rays: Array
    area: Array


@dataclass(frozen=True, eq=False)
class FrameSample:
    """A lens, the intrinsics it is to be written with, and both at points of the frame.

    Attributes:
        lens: The lens.
        intrinsics: Stated in the file.
        fit: Points to fit to.
        check: Points to tell the error of.
    """

    lens: CameraLens
    intrinsics: Intrinsics
    fit: Rays
    check: Rays


def frame_sample(lens: CameraLens, intrinsics: Intrinsics) -> FrameSample:
    """Look at a lens over its frame.

    Raises:
        CannotExport: If the lens folds within its frame, or the frame is too small to fit to.
        InvalidInput: If the intrinsics belong to no camera of that image size.
    """
    intrinsics.require_plausible(lens)
    if min(lens.width, lens.height) < SMALLEST_SIDE:
        raise CannotExport(
            f"an image of {lens.width} x {lens.height} px",
            where="lens",
            expected=f"sides of {SMALLEST_SIDE} px or more",
        )
    if not lens.is_invertible():
        raise CannotExport(
            "the lens folds within the frame, so that no other model can stand for it",
            where="lens",
            hint="more lines near the corners of the frame would mend it; the ClearLines file holds it as it is",
        )
    return FrameSample(lens, intrinsics, _rays(lens, intrinsics, FIT_COLUMNS), _rays(lens, intrinsics, CHECK_COLUMNS))


def _rays(lens: CameraLens, intrinsics: Intrinsics, columns: int) -> Rays:
    measured = frame_grid(lens.width, lens.height, columns)
    corrected = lens.undistort(measured)
    rays = (corrected - intrinsics.principal_point) / intrinsics.focal_length
    return Rays(measured, corrected, rays, 1 / np.linalg.det(lens.jacobian(measured)))
