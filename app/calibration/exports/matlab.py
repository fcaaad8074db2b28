"""MATLAB: a MAT-file with what ``cameraParameters`` takes; the first pixel's centre is (1, 1) there."""

from __future__ import annotations

import io

import numpy as np
from scipy.io import savemat

from app.calibration.exports.conversion import Conversion
from app.calibration.exports.draft import Draft
from app.calibration.exports.frame_sample import FrameSample
from app.calibration.exports.projection_fit import Model, convert

NAME = "cameraParameters"
MODELS = (
    Model(NAME, (0, 1, 2, 3, 4), 5),
    Model(NAME, (0, 1, 2, 3, 4), 5, free=True),
    Model(NAME, (0, 1, 2, 3), 5, free=True),
    Model(NAME, (0, 1, 2, 3), 5),
    Model(NAME, (0, 1), 5),
)
PIXEL_CENTER = 1.0
HEADER = b"MATLAB 5.0 MAT-file, written by ClearLines"
HEADER_BYTES = 116


def convert_matlab(sample: FrameSample) -> Conversion:
    """Fit three radial and two tangential coefficients, the most that MATLAB has.

    Raises:
        CannotExport: If each fit folds within the frame.
    """
    return convert(sample, MODELS)


def write_matlab(draft: Draft) -> bytes:
    """Write a MAT-file of version 5; ``IntrinsicMatrix`` is K transposed, as MATLAB had it before it took K itself."""
    k1, k2, p1, p2, k3 = draft.conversion.coefficients
    matrix = draft.camera_matrix
    matrix[:2, 2] += PIXEL_CENTER
    stream = io.BytesIO()
    savemat(
        stream,
        {
            "K": matrix,
            "IntrinsicMatrix": matrix.T,
            "RadialDistortion": np.array([[k1, k2, k3]]),
            "TangentialDistortion": np.array([[p1, p2]]),
            "ImageSize": np.array([[draft.lens.height, draft.lens.width]], np.float64),
            "Skew": 0.0,
            "CameraName": draft.name,
            "ConversionError": np.array([list(draft.conversion.error)]),
            "Notes": np.array([[line] for line in draft.lines], object),
        },
    )
    # scipy puts the time of day and the platform where readers look for nothing
    return HEADER.ljust(HEADER_BYTES) + stream.getvalue()[HEADER_BYTES:]
