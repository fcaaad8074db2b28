"""What straight brush strokes touch: all candidates whose polyline comes within the brush's radius."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from app.vision import Segments

Array = NDArray[np.float64]

CANVAS = (1120.0, 820.0)
"""px that the page leaves for the image in a window of 1440 x 900."""
BRUSH = 8.0
"""px, radius of the page's brush on the screen; on the image never taken for more."""
MOST_ANCHORS = 330
"""Places in all that strokes begin and end at; evenly spread over the candidates."""
STEP = 2.0
"""px between the places of a stroke that are looked at."""
BLOCK = 2048
WORD = 64


def brush_radius(size: tuple[int, int]) -> float:
    """Return the radius of the page's brush in px of an image that is fitted to the page."""
    fitted = min(CANVAS[0] / size[0], CANVAS[1] / size[1])
    return min(BRUSH, BRUSH / fitted)


def strokes(segments: Segments, size: tuple[int, int], radius: float | None = None) -> NDArray[np.bool_]:
    """Return what straight strokes between places of an image's candidates touch.

    Args:
        segments: S candidates, px.
        size: Width and height of the image, px.
        radius: Of the brush in px of the image; the page's if left out.

    Returns:
        bool ``(K, S)``: distinct sets of two candidates or more.
    """
    count = len(segments)
    if count < 2:
        return np.zeros((0, count), bool)
    reach = _reach(segments, size, brush_radius(size) if radius is None else radius)
    anchors = _anchors(segments, max(2, min(5, MOST_ANCHORS // count)))
    one, other = np.triu_indices(len(anchors), 1)
    length = np.hypot(*(anchors[one] - anchors[other]).T)
    order = np.argsort(length)
    found = np.zeros((0, reach.shape[-1]), np.uint64)
    for first in range(0, len(order), BLOCK):
        rows = order[first : first + BLOCK]
        words = _along(reach, anchors[one[rows]], anchors[other[rows]], float(length[rows[-1]]))
        found = np.unique(np.concatenate([found, words]), axis=0)
    bits = (found[:, :, None] >> np.arange(WORD, dtype=np.uint64)) & np.uint64(1)
    touched = bits.reshape(len(found), -1)[:, :count].astype(bool)
    return touched[touched.sum(axis=1) > 1]


def _anchors(segments: Segments, each: int) -> Array:
    spread = (np.arange(each) + 0.5) / each
    rows = segments.offsets[:-1, None] + np.rint((segments.counts[:, None] - 1) * spread).astype(np.int64)
    return segments.points[rows].astype(np.float64).reshape(-1, 2)


def _reach(segments: Segments, size: tuple[int, int], radius: float) -> NDArray[np.uint64]:
    """Return for each pixel which candidates are within the radius, one bit each, uint64 ``(H, W, words)``."""
    width, height = size
    words = -(-len(segments) // WORD)
    reach = np.zeros((height, width, words), np.uint64)
    for index, points in enumerate(segments):
        mask = np.zeros((height, width), np.uint8)
        cv2.polylines(mask, [np.rint(points).astype(np.int32)], isClosed=False, color=1, thickness=round(2 * radius))
        reach[..., index // WORD] |= mask.astype(np.uint64) << np.uint64(index % WORD)
    return reach


def _along(reach: NDArray[np.uint64], start: Array, end: Array, longest: float) -> NDArray[np.uint64]:
    """Return all candidates that strokes come near, uint64 ``(K, words)``."""
    height, width, _ = reach.shape
    spread = np.linspace(0, 1, max(2, int(longest / STEP) + 1), dtype=np.float32)[:, None]
    x, y = (
        np.rint(start[:, axis].astype(np.float32) * (1 - spread) + end[:, axis].astype(np.float32) * spread).astype(
            np.int32
        )
        for axis in range(2)
    )
    inside = reach[np.clip(y, 0, height - 1), np.clip(x, 0, width - 1)]
    return np.bitwise_or.reduce(inside, axis=0)
