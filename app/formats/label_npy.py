"""Write the paper's label files."""

from __future__ import annotations

import io

import numpy as np

from app.vision.segments import Segments


def write_label_npy(segments: Segments) -> bytes:
    """Write segments as the paper does: an object array ``(S,)`` of float64 ``(n, 1, 2)``.

    `numpy.load(..., allow_pickle=True)` reads it back, as does `app.formats.inert_npy.read_label_npy`. The format
    holds points only: scores are left out.
    """
    # filled element by element: numpy would stack segments of equal length into one block
    array = np.empty(len(segments), dtype=object)
    for index, points in enumerate(segments):
        array[index] = points.astype(np.float64).reshape(-1, 1, 2)
    stream = io.BytesIO()
    np.save(stream, array, allow_pickle=True)
    return stream.getvalue()
