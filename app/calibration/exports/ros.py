"""ROS ``camera_info`` YAML, as ``camera_info_manager`` and ``image_proc`` read it (sensor_msgs/CameraInfo)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.calibration.exports.conversion import Conversion
from app.calibration.exports.draft import Draft
from app.calibration.exports.frame_sample import FrameSample
from app.calibration.exports.names import file_stem
from app.calibration.exports.projection_fit import Model, convert
from app.calibration.exports.yaml_text import commented_yaml

PLUMB_BOB, RATIONAL = "plumb_bob", "rational_polynomial"
MODELS = (
    Model(PLUMB_BOB, (0, 1, 2, 3, 4), 5),
    Model(RATIONAL, (0, 1, 2, 3, 4, 5, 6, 7), 8),
    Model(PLUMB_BOB, (0, 1, 2, 3, 4), 5, free=True),
    Model(RATIONAL, (0, 1, 2, 3, 4, 5, 6, 7), 8, free=True),
    Model(PLUMB_BOB, (0, 1, 2, 3), 5),
    Model(PLUMB_BOB, (0, 1), 5),
)


def convert_ros(sample: FrameSample) -> Conversion:
    """Fit ``plumb_bob``, and ``rational_polynomial`` where that isn't exact.

    Raises:
        CannotExport: If each fit folds within the frame.
    """
    return convert(sample, MODELS)


def write_ros(draft: Draft) -> bytes:
    """Write camera_info YAML; the rectified image has the stated camera matrix and isn't turned."""
    projection = np.column_stack([draft.corrected_matrix, np.zeros(3)])
    return commented_yaml(
        draft.lines,
        {
            "image_width": draft.lens.width,
            "image_height": draft.lens.height,
            # camera_info_manager warns of any other character
            "camera_name": file_stem(draft.camera_name),
            "camera_matrix": _matrix(draft.camera_matrix),
            "distortion_model": draft.conversion.model,
            "distortion_coefficients": _matrix(np.array([draft.conversion.coefficients])),
            "rectification_matrix": _matrix(np.eye(3)),
            "projection_matrix": _matrix(projection),
        },
    )


def _matrix(values: NDArray[np.float64]) -> dict[str, Any]:
    rows, columns = values.shape
    return {"rows": rows, "cols": columns, "data": values.ravel().tolist()}
