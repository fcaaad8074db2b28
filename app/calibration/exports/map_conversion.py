"""The error of a lens written as a map: only that of interpolating between exact points."""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import NDArray

from app.calibration.exports.conversion import Conversion
from app.calibration.exports.frame_sample import ConversionError, FrameSample
from app.calibration.exports.pixel_map import PlaneMap, interpolated
from app.calibration.exports.undistorted_frame import mapped_view, place, source, told

Array = NDArray[np.float64]


def convert_remap(sample: FrameSample) -> Conversion:
    """Tell how exact a map from the undistorted to the measured image is.

    Raises:
        CannotExport: If the image is too large for a map.
    """
    view = mapped_view(sample)
    there = _off(partial(source, view), place(view, sample.check.measured), sample)
    return Conversion("map of every pixel", (), _error(there), (told(view),))


def convert_stmap(sample: FrameSample) -> Conversion:
    """Tell how exact a pair of maps, there and back, is.

    Raises:
        CannotExport: If the image is too large for a map.
    """
    view = mapped_view(sample)
    there = _off(partial(source, view), place(view, sample.check.measured), sample)
    back = _off(partial(place, view), sample.check.measured, sample)
    return Conversion("two maps of every pixel", (), _error(np.concatenate([there, back])), (told(view),))


def _off(lookup: PlaneMap, points: Array, sample: FrameSample) -> Array:
    """Return by how much a map is off at the pixels next to points, px ``(N, 2)``, where it leads into the image."""
    size = np.array([sample.lens.width - 1, sample.lens.height - 1])
    pixels = np.unique(np.clip(np.round(points), 0, size), axis=0)
    exact = lookup(pixels)
    inside = np.isfinite(exact).all(axis=1) & (exact >= 0).all(axis=1) & (exact <= size).all(axis=1)
    return interpolated(lookup, pixels[inside]) - exact[inside]


def _error(off: Array) -> ConversionError:
    known = off[np.isfinite(off).all(axis=1)]
    return ConversionError.between(known, np.zeros_like(known)) if len(known) else ConversionError(0.0, 0.0)
