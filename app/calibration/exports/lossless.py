"""ClearLines' own file: the lens as it is, in its own model, with everything known of how it was found."""

from __future__ import annotations

import json

from app.calibration.exports.draft import Draft

FORMAT = "clearlines-camera"
VERSION = 1
CONVENTION = (
    "Points in px, x to the right, y down, centre of the first pixel at (0, 0). Coefficients are for lengths in "
    "units of 'scale' from the image centre ((width - 1) / 2, (height - 1) / 2); cx and cy are the distortion "
    "centre's offset from it in the same unit."
)


def write_lossless(draft: Draft) -> bytes:
    """Write UTF-8 JSON; numbers are read back as the same doubles."""
    x, y = draft.intrinsics.principal_point
    fields = {
        "format": FORMAT,
        "version": VERSION,
        "camera_name": draft.camera_name,
        "convention": CONVENTION,
        "lens": draft.lens.as_dict(),
        "intrinsics": {
            "focal_length": draft.intrinsics.focal_length,
            "principal_point": [x, y],
            "source": draft.intrinsics.source,
            "meaning": draft.intrinsics.told,
        },
        "conversion_error": {"rms": 0.0, "maximum": 0.0},
        "calibration": draft.calibration,
    }
    # lone surrogates of a broken name can't be encoded and are escaped; all else stays readable
    text = json.dumps(fields, ensure_ascii=False, indent=2, allow_nan=False) + "\n"
    return text.encode("utf-8", "backslashreplace")
