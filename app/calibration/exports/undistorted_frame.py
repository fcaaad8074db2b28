"""The image that maps lead to: the view of the whole corrected frame, and its ways there and back without rounding."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from app.calibration.exports.frame_sample import FrameSample
from app.calibration.lens import CameraLens
from app.errors import CannotExport
from app.vision.undistorted_view import SMALLEST, UndistortedView, undistorted_view

Array = NDArray[np.float64]

MOST_PIXELS = 32_000_000
"""Of an image that a map is written for; more would take gigabytes to make."""
SAME = 0.01
"""px within which going there and back must arrive."""


def mapped_view(sample: FrameSample) -> UndistortedView:
    """Return the view that a map is made for.

    Raises:
        CannotExport: If the image is too large for a map.
    """
    width, height = sample.lens.width, sample.lens.height
    if width * height > MOST_PIXELS:
        raise CannotExport(
            f"{width} x {height} px are too many for a map", where="lens", expected=f"at most {MOST_PIXELS} pixels"
        )
    return undistorted_view(sample.lens)


def place(view: UndistortedView, measured: Array) -> Array:
    """Map measured points ``(N, 2)`` in px into the view, px."""
    return view.scale * view.lens.undistort(measured) + view.offset


def source(view: UndistortedView, points: Array) -> Array:
    """Map points ``(N, 2)`` of the view to the measured image, px; NaN where the lens shows nothing."""
    found = view.measured(points)
    if not (isinstance(view.lens, CameraLens) and view.lens.family == "opencv"):
        return found
    # a polynomial in this direction has values beyond its fold too, back within the image
    apart = np.hypot(*(place(view, found) - points).T)
    return np.where((apart < SAME)[:, None], found, np.nan)


def view_matrix(view: UndistortedView, matrix: Array) -> Array:
    """Return K of the view for K of the corrected image, both ``(3, 3)`` in px."""
    (x, y), scale = view.offset, view.scale
    return np.array([[scale, 0, x], [0, scale, y], [0, 0, 1]]) @ matrix


def told(view: UndistortedView) -> str:
    """Say what the view shows."""
    (x, y), cut = view.offset, " Its corners are cut off." if view.scale <= SMALLEST else ""
    return (
        f"The undistorted image has the same size and shows the whole frame: {view.scale:.6f} times the corrected "
        f"image, shifted by ({x:.4f}, {y:.4f}) px.{cut}"
    )
