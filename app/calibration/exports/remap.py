"""NumPy archive with the two maps that ``cv2.remap`` takes."""

from __future__ import annotations

import io
from functools import partial

import numpy as np

from app.calibration.exports.draft import Draft
from app.calibration.exports.pixel_map import pixel_map
from app.calibration.exports.undistorted_frame import source, view_matrix
from app.vision.undistorted_view import undistorted_view


def write_remap(draft: Draft) -> bytes:
    """Write ``map_x`` and ``map_y``, float32 ``(H, W)`` in px: where each pixel without distortion comes from."""
    view = undistorted_view(draft.lens)
    lookup = pixel_map(partial(source, view), draft.lens.width, draft.lens.height)
    stream = io.BytesIO()
    np.savez_compressed(
        stream,
        map_x=np.ascontiguousarray(lookup[:, :, 0]),
        map_y=np.ascontiguousarray(lookup[:, :, 1]),
        camera_matrix=draft.corrected_matrix,
        new_camera_matrix=view_matrix(view, draft.corrected_matrix),
        conversion_error=np.array(draft.conversion.error),
        camera_name=np.array(draft.name),
        notes=np.array(draft.lines),
    )
    return stream.getvalue()
