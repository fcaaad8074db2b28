"""What a fit says of each line and of each image."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from app.calibration.calibration import ImageFit, LineResiduals
from app.calibration.calibration_image import CalibrationImage
from app.calibration.lens_solver import SolvedLens
from app.calibration.observations import LineObservations
from app.vision.sampson import sampson_residuals

Array = NDArray[np.float64]

STRAIGHT = 0.5
"""Probability from which a line counts as straight."""


def weighed(observed: LineObservations, solved: SolvedLens, image: CalibrationImage, number: int) -> CalibrationImage:
    """Return an image with what the fit holds of its lines; those that it had no use for are of none."""
    rows = observed.image == number
    probability = np.zeros(len(image.segments))
    probability[observed.index[rows]] = solved.lines.straight[rows]
    return CalibrationImage(image.name, image.segments, probability)


def line_residuals(
    observed: LineObservations, solved: SolvedLens, image: CalibrationImage, number: int
) -> LineResiduals:
    """Return the residuals of the lines of image number `number` that were used."""
    rows = np.flatnonzero(observed.image == number)
    index = observed.index[rows]
    chosen = image.segments.select(index)
    distance = np.abs(sampson_residuals(chosen, solved.lens)) if len(index) else np.zeros(0)
    starts = chosen.offsets[:-1]
    return LineResiduals(
        segment=index,
        probability=solved.lines.straight[rows],
        rms=np.sqrt(np.add.reduceat(distance**2, starts) / chosen.counts) if len(index) else np.zeros(0),
        maximum=np.maximum.reduceat(distance, starts) if len(index) else np.zeros(0),
        length=observed.length[rows],
    )


def image_fits(
    images: Sequence[CalibrationImage], lines: Sequence[LineResiduals], moved: Array, several: bool
) -> tuple[ImageFit, ...]:
    """Return how well each image fits, given its lines and by how many px the lens moves without it."""
    found: list[ImageFit] = []
    for image, found_lines, shift in zip(images, lines, moved, strict=True):
        straight = found_lines.probability >= STRAIGHT
        rms = float(np.sqrt(np.mean(found_lines.rms[straight] ** 2))) if straight.any() else None
        left_out = float(shift) if several else None
        found.append(ImageFit(image.name, len(image.segments), int(straight.sum()), rms, left_out))
    return tuple(found)
