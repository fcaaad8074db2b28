"""The printable report of a calibration, made by a worker: its figures, and an image before and after."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from app.calibration.calibration import Calibration, LineResiduals
from app.calibration.comparison import Difference
from app.calibration.lens import CameraLens
from app.calibration.line_table import CalibrationLines, unpacked_lines
from app.calibration.report.report import ReportPicture, report_html
from app.errors import ClearLinesError, InvalidInput
from app.formats.reference_camera import ReferenceCamera
from app.images import decode_eight_bit
from app.jobs.calibration_answers import difference_to, jpeg
from app.jobs.tasks import errors_that_travel
from app.vision.undistorted_view import undistorted_view

LONGEST_SIDE = 1300
"""px of a picture; paper shows no finer."""


@dataclass(frozen=True)
class ReportInputs:
    """What a report is made from.

    Attributes:
        result: ``Calibration.as_dict``.
        lines: npz bytes of its lines; ``None`` without any.
        images: Ids of its images, in its order.
        picture: Name and file of the image to show; ``None`` without one.
        reference: What to compare with.
        created: When the calibration was made.
    """

    result: Mapping[str, Any]
    lines: bytes | None
    images: tuple[int, ...]
    camera_name: str
    picture: tuple[str, bytes] | None
    reference: ReferenceCamera | None
    created: datetime


def report_task(inputs: ReportInputs, max_pixels: int) -> bytes:
    """Return the report as one page of HTML, UTF-8, that loads nothing and runs no script.

    Args:
        inputs: What it is made from.
        max_pixels: Greatest number of pixels that is decoded.

    Raises:
        ClearLinesError: Always one of the tree, with the reason.
    """
    with errors_that_travel(inputs.camera_name, "the report"):
        stored = Calibration.from_dict(inputs.result)
        calibration = replace(stored, lines=_residuals(inputs.lines, inputs.images))
        reference = inputs.reference
        page = report_html(
            calibration,
            camera_name=inputs.camera_name,
            created=inputs.created,
            pictures=_pictures(calibration, inputs.picture, max_pixels),
            difference=None if reference is None else _difference(calibration.lens, reference),
        )
        return page.encode()


def _difference(lens: CameraLens, reference: ReferenceCamera) -> Difference | None:
    """Return how far a lens is from a reference; nothing where that one is beyond comparing."""
    try:
        return difference_to(lens, reference)
    except InvalidInput:
        return None


def _residuals(content: bytes | None, images: Sequence[int]) -> tuple[LineResiduals, ...]:
    """Return the lines by image; each is numbered by its segment's id."""
    if content is None:
        return ()
    lines = unpacked_lines(content)
    return tuple(_of_image(lines, np.flatnonzero(lines.image_id == image)) for image in images)


def _of_image(lines: CalibrationLines, rows: NDArray[np.intp]) -> LineResiduals:
    columns = (lines.probability, lines.rms, lines.maximum, lines.length)
    return LineResiduals(lines.segment_id[rows], *(column[rows].astype(np.float64) for column in columns))


def _pictures(
    calibration: Calibration, picture: tuple[str, bytes] | None, max_pixels: int
) -> tuple[ReportPicture, ...]:
    """Return an image before and after; none where it can't be read or the lens can't be taken out."""
    if picture is None:
        return ()
    name, content = picture
    try:
        pixels = decode_eight_bit(content, max_pixels=max_pixels)
        corrected = undistorted_view(calibration.lens).render(pixels)
    except ClearLinesError:
        return ()
    return (
        ReportPicture(f"{name}, as it was taken", jpeg(_smaller(pixels))),
        ReportPicture(f"{name}, corrected", jpeg(_smaller(corrected))),
    )


def _smaller(pixels: NDArray[np.uint8]) -> NDArray[np.uint8]:
    height, width = pixels.shape[:2]
    scale = LONGEST_SIDE / max(width, height)
    if scale >= 1:
        return pixels
    target = (max(1, round(width * scale)), max(1, round(height * scale)))
    return np.asarray(cv2.resize(pixels, target, interpolation=cv2.INTER_AREA), np.uint8)
