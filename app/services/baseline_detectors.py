"""Detectors that every board is measured by: the pre-labelling pipeline before any filter, and OpenCV's LSD."""

from __future__ import annotations

import cv2
import numpy as np

from app.vision.intensity import to_eight_bit
from app.vision.parameters import DetectionParameters
from app.vision.prelabel import detect_for_prelabel
from app.vision.segments import Segments


def detect_candidates(gray: np.ndarray, min_length: float) -> Segments:
    """Run the pipeline on an image: all candidates of at least that extent, px, before the straightness filter.

    Args:
        gray: uint8 or uint16 ``(H, W)``.
        min_length: Shortest candidate, px; the pipeline's default when 0.
    """
    chosen = DetectionParameters() if min_length <= 0 else DetectionParameters(min_length=min_length)
    return detect_for_prelabel(gray, chosen).candidates


def detect_lsd(gray: np.ndarray, min_length: float) -> Segments:
    """Run OpenCV's line segment detector, with its defaults and refinement.

    Source: Grompone von Gioi, Jakubowicz, Morel and Randall, "LSD: a line segment detector" (IPOL 2012). The score is
    ``n / (1 + n)`` with n the negative logarithm of the number of false alarms: it keeps LSD's own order.

    Args:
        gray: uint8 or uint16 ``(H, W)``.
        min_length: Shorter ones are left out, px.

    Returns:
        Segments of two points each.
    """
    detector = cv2.createLineSegmentDetector(cv2.LSD_REFINE_ADV)
    lines, _, _, significance = detector.detect(to_eight_bit(gray))
    if lines is None or not len(lines):
        return Segments.empty()
    ends = np.asarray(lines, np.float32).reshape(-1, 2, 2)
    strength = np.maximum(np.asarray(significance, np.float64).reshape(-1), 0.0)
    long_enough = np.hypot(*(ends[:, 1] - ends[:, 0]).T) >= max(min_length, 1.0)
    ends, strength = ends[long_enough], strength[long_enough]
    return Segments.from_list(list(ends), (strength / (1 + strength)).astype(np.float32))
