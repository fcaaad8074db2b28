"""OpenCV's FileStorage, as YAML and as JSON: what ``cv2.FileStorage`` and OpenCV's calibration samples read."""

from __future__ import annotations

import cv2
import numpy as np

from app.calibration.exports.conversion import Conversion
from app.calibration.exports.draft import Draft
from app.calibration.exports.frame_sample import FrameSample
from app.calibration.exports.projection_fit import Model, convert

MODELS = (
    Model("OpenCV with 5 coefficients", (0, 1, 2, 3, 4), 5),
    Model("OpenCV rational with 8 coefficients", (0, 1, 2, 3, 4, 5, 6, 7), 8),
    Model("OpenCV with 5 coefficients", (0, 1, 2, 3, 4), 5, free=True),
    Model("OpenCV rational with 8 coefficients", (0, 1, 2, 3, 4, 5, 6, 7), 8, free=True),
    Model("OpenCV with 4 coefficients", (0, 1, 2, 3), 5),
    Model("OpenCV with 2 coefficients", (0, 1), 5),
)


def convert_opencv(sample: FrameSample) -> Conversion:
    """Fit OpenCV's models; a file has 5 coefficients, or 8 where 5 aren't exact.

    Raises:
        CannotExport: If each fit folds within the frame.
    """
    return convert(sample, MODELS)


def write_opencv_yaml(draft: Draft) -> bytes:
    """Write FileStorage YAML, with comments."""
    return _written(draft, ".yaml", cv2.FILE_STORAGE_FORMAT_YAML)


def write_opencv_json(draft: Draft) -> bytes:
    """Write FileStorage JSON; it has no comments, so the field ``notes`` has what they would say."""
    return _written(draft, ".json", cv2.FILE_STORAGE_FORMAT_JSON)


def _written(draft: Draft, suffix: str, kind: int) -> bytes:
    storage = cv2.FileStorage(suffix, cv2.FILE_STORAGE_WRITE | cv2.FILE_STORAGE_MEMORY | kind)
    if kind == cv2.FILE_STORAGE_FORMAT_YAML:
        for line in draft.lines:
            storage.writeComment(line)
    error = draft.conversion.error
    storage.write("camera_name", _quoted(draft.name))
    storage.write("image_width", draft.lens.width)
    storage.write("image_height", draft.lens.height)
    storage.write("camera_matrix", draft.camera_matrix)
    storage.write("distortion_coefficients", np.array([draft.conversion.coefficients]).T)
    storage.write("focal_length_source", _quoted(draft.intrinsics.source))
    storage.write("conversion_error_rms", error.rms)
    storage.write("conversion_error_maximum", error.maximum)
    if kind == cv2.FILE_STORAGE_FORMAT_JSON:
        storage.write("notes", _quoted(" ".join(draft.lines)))
    return storage.releaseAndGetString().encode()


def _quoted(text: str) -> str:
    # OpenCV keeps quotes that it is given; without them the name "true" would be read back as a number
    return f'"{text}"'
