"""mrcal's ``.cameramodel``: a Python literal with comments, of the models LENSMODEL_OPENCV5 and LENSMODEL_OPENCV8."""

from __future__ import annotations

from app.calibration.exports.conversion import Conversion
from app.calibration.exports.draft import Draft
from app.calibration.exports.frame_sample import FrameSample
from app.calibration.exports.projection_fit import Model, convert

MODELS = (
    Model("LENSMODEL_OPENCV5", (0, 1, 2, 3, 4), 5),
    Model("LENSMODEL_OPENCV8", (0, 1, 2, 3, 4, 5, 6, 7), 8),
    Model("LENSMODEL_OPENCV5", (0, 1, 2, 3, 4), 5, free=True),
    Model("LENSMODEL_OPENCV8", (0, 1, 2, 3, 4, 5, 6, 7), 8, free=True),
    Model("LENSMODEL_OPENCV4", (0, 1, 2, 3), 4),
    Model("LENSMODEL_OPENCV4", (0, 1), 4),
)


def convert_mrcal(sample: FrameSample) -> Conversion:
    """Fit mrcal's OpenCV models.

    Raises:
        CannotExport: If each fit folds within the frame.
    """
    return convert(sample, MODELS)


def write_mrcal(draft: Draft) -> bytes:
    """Write a camera at the origin of the reference frame."""
    focal_length, (x, y) = draft.focal_length, draft.principal_point
    intrinsics = [float(value) for value in (focal_length, focal_length, x, y, *draft.conversion.coefficients)]
    lines = [
        *(f"# {line}" for line in draft.lines),
        "{",
        f"    'lensmodel': '{draft.conversion.model}',",
        "    # fx, fy, cx, cy, then the distortion",
        f"    'intrinsics': {intrinsics!r},",
        "    'extrinsics': [0.0, 0.0, 0.0, 0.0, 0.0, 0.0],",
        f"    'imagersize': [{draft.lens.width}, {draft.lens.height}],",
        "}",
        "",
    ]
    return "\n".join(lines).encode()
