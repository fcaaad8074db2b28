"""Two photos for a camera's report: its lines as measured, and as the correction straightens them."""

from __future__ import annotations

from pathlib import PurePosixPath

import cv2
import numpy as np
from numpy.typing import NDArray

from app.calibration.report.report import ReportPicture
from app.commands.calibrate import CalibratedCamera
from app.errors import ClearLinesError
from app.formats.files import read_file
from app.images import decode_display
from app.images.browser import encode
from app.vision.segments import Segments
from app.vision.undistorted_view import undistorted_view

LONGEST = 1000
"""px of a picture's longer side; it is printed 88 mm across."""
COLOR = (0, 160, 255)  # orange in blue, green, red: seen on grey streets and on green
SHIFT = 4


def report_pictures(camera: CalibratedCamera) -> list[ReportPicture]:
    """Return the image with the most straight lines before and after the correction; none where there is no image."""
    lens = camera.calibration.lens
    best = max(range(len(camera.lines.images)), key=lambda index: camera.calibration.images[index].inliers)
    name = camera.lines.images[best].name
    file = camera.lines.files.get(name)
    if file is None or not lens.is_invertible():
        return []
    try:
        pixels = decode_display(read_file(file))
    except ClearLinesError:
        return []  # a report without pictures is better than none
    residuals = camera.calibration.lines[best]
    straight = camera.lines.images[best].segments.select(residuals.segment[residuals.probability >= 0.5])
    view = undistorted_view(lens)
    corrected = Segments(view.project(straight.points), straight.offsets)
    return [
        ReportPicture(f"{PurePosixPath(name).name}: lines as measured", _jpeg(pixels, straight)),
        ReportPicture("the same after the correction", _jpeg(view.render(pixels), corrected)),
    ]


def _jpeg(pixels: NDArray[np.uint8], segments: Segments) -> bytes:
    height, width = pixels.shape[:2]
    scale = min(1.0, LONGEST / max(height, width))
    size = (max(1, round(scale * width)), max(1, round(scale * height)))
    small = np.ascontiguousarray(cv2.resize(pixels, size, interpolation=cv2.INTER_AREA), np.uint8)
    for index in range(len(segments)):
        points = np.round((segments[index] + 0.5) * scale * (1 << SHIFT) - (1 << SHIFT) / 2).astype(np.int32)
        cv2.polylines(small, [points], False, COLOR, 2, cv2.LINE_AA, SHIFT)
    return encode(".jpg", small, [cv2.IMWRITE_JPEG_QUALITY, 82])
