"""Kalibr's camera chain: pinhole with ``radtan``, which has two radial and two tangential terms, no third radial one.

Leaving k3 out of five fitted coefficients would be off by many px in the corners, so four are fitted for themselves.
"""

from __future__ import annotations

from app.calibration.exports.conversion import Conversion
from app.calibration.exports.draft import Draft
from app.calibration.exports.frame_sample import FrameSample
from app.calibration.exports.projection_fit import Model, convert
from app.calibration.exports.yaml_text import commented_yaml

RADTAN = "radtan"
MODELS = (
    Model(RADTAN, (0, 1, 2, 3), 4),
    Model(RADTAN, (0, 1, 2, 3), 4, free=True),
    Model(RADTAN, (0, 1), 4),
    Model(RADTAN, (0,), 4),
)


def convert_kalibr(sample: FrameSample) -> Conversion:
    """Fit k1, k2, p1 and p2.

    Raises:
        CannotExport: If each fit folds within the frame.
    """
    return convert(sample, MODELS)


def write_kalibr(draft: Draft) -> bytes:
    """Write a chain of one camera."""
    focal_length, (x, y) = draft.focal_length, draft.principal_point
    camera = {
        "cam_overlaps": [],
        "camera_model": "pinhole",
        "distortion_coeffs": list(draft.conversion.coefficients),
        "distortion_model": RADTAN,
        "intrinsics": [float(focal_length), float(focal_length), float(x), float(y)],
        "resolution": [draft.lens.width, draft.lens.height],
        "rostopic": "/cam0/image_raw",
    }
    return commented_yaml(draft.lines, {"cam0": camera})
