"""COLMAP's ``cameras.txt`` with the simplest model that is exact enough; the first pixel's centre is (0.5, 0.5)."""

from __future__ import annotations

from app.calibration.exports.conversion import Conversion
from app.calibration.exports.draft import Draft
from app.calibration.exports.frame_sample import FrameSample
from app.calibration.exports.projection_fit import Model, convert

MODELS = (
    Model("SIMPLE_RADIAL", (0,), 1),
    Model("RADIAL", (0, 1), 2),
    Model("OPENCV", (0, 1, 2, 3), 4),
    Model("FULL_OPENCV", (0, 1, 2, 3, 4, 5, 6, 7), 8),
    Model("FULL_OPENCV", (0, 1, 2, 3, 4, 5, 6, 7), 8, free=True),
    Model("FULL_OPENCV", (0, 1, 2, 3, 4), 8, free=True),
    Model("FULL_OPENCV", (0, 1, 2, 3, 4), 8),
)
ONE_FOCAL_LENGTH = frozenset({"SIMPLE_RADIAL", "RADIAL"})
PIXEL_CENTER = 0.5


def convert_colmap(sample: FrameSample) -> Conversion:
    """Fit the models from the simplest on until one is exact enough.

    Raises:
        CannotExport: If each fit folds within the frame.
    """
    return convert(sample, MODELS)


def write_colmap(draft: Draft) -> bytes:
    """Write the list of cameras with this one, as camera 1."""
    focal_length, (x, y) = draft.focal_length, draft.principal_point
    focal_lengths = (focal_length,) * (1 if draft.conversion.model in ONE_FOCAL_LENGTH else 2)
    parameters = (*focal_lengths, x + PIXEL_CENTER, y + PIXEL_CENTER, *draft.conversion.coefficients)
    camera = ["1", draft.conversion.model, draft.lens.width, draft.lens.height, *(repr(float(p)) for p in parameters)]
    comments = [
        *draft.lines,
        "Principal point as COLMAP counts, from the outer corner of the first pixel: 0.5 px more than elsewhere.",
        "CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]",
    ]
    return "".join([*(f"# {line}\n" for line in comments), " ".join(map(str, camera)), "\n"]).encode()
