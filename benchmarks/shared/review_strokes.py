"""Straight strokes of the label page's brush: where they may begin and end, and what they touch.

Among tens of thousands of strokes the good ones are looked for in a raster, and what a chosen one touches is then
found by the page's own rule (`shared.review_touching`), which alone counts.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import cv2
import numpy as np
from numpy.typing import NDArray

from app.vision import Segments

from .review_touching import BESIDE, nearest_lines, touched_lines

Array = NDArray[np.float64]

CANVAS = (1120.0, 820.0)
"""px that the page leaves for the image in a window of 1440 x 900."""
BRUSH = 8.0
"""px, radius of the page's brush on the screen; on the image never taken for more."""
MOST_ANCHORS = 330
"""Places in all that strokes begin and end at; evenly spread over the candidates."""
GRID = (12, 9)
"""Places beside the candidates that strokes may begin or end at: those of an even grid."""
SHORTEST = 0.5
"""Radii; what is shorter is a click."""
STEP = 2.0
"""px between the places of a stroke that are looked at."""
BLOCK = 2048
WORD = 64


@dataclass(frozen=True, eq=False)
class Strokes:
    """K strokes over the S candidates of an image.

    Attributes:
        segments: The candidates, px.
        radius: Of the brush, px of the image.
        ends: float64 ``(K, 2, 2)``, where they begin and end.
        lines: int64 ``(K, 2)``, the candidates they begin and end on; `BESIDE` for none.
        touched: bool ``(K, S)``, nearly: as far as the raster tells.
    """

    segments: Segments
    radius: float
    ends: Array
    lines: NDArray[np.int64]
    touched: NDArray[np.bool_]
    _exact: dict[int, NDArray[np.bool_]] = field(default_factory=dict, repr=False)

    def exactly(self, stroke: int) -> NDArray[np.bool_]:
        """Return what a stroke touches on the page, bool ``(S,)``."""
        if stroke not in self._exact:
            start, end = self.ends[stroke]
            self._exact[stroke] = touched_lines(self.segments, start, end, self.radius)
        return self._exact[stroke]


def brush_radius(size: tuple[int, int]) -> float:
    """Return the radius of the page's brush in px of an image that is fitted to the page."""
    fitted = min(CANVAS[0] / size[0], CANVAS[1] / size[1])
    return min(BRUSH, BRUSH / fitted)


def strokes(segments: Segments, size: tuple[int, int], radius: float | None = None) -> Strokes:
    """Return strokes between places of an image's candidates, and from these to places beside them.

    Args:
        segments: S candidates, px.
        size: Width and height of the image, px.
        radius: Of the brush in px of the image; the page's if left out.

    Returns:
        Those that touch two candidates or more; of such as touch, begin on and end on the same ones, one.
    """
    count, radius = len(segments), brush_radius(size) if radius is None else radius
    if count < 2:
        return no_strokes(segments, radius)
    reach = _reach(segments, size, radius)
    places = np.concatenate([_anchors(segments, max(2, min(5, MOST_ANCHORS // count))), _grid(size)])
    near = nearest_lines(segments, places, radius)
    one, other = np.triu_indices(len(places), 1)
    length = np.hypot(*(places[one] - places[other]).T)
    rows = np.argsort(length, kind="stable")
    rows = rows[((near[one[rows]] != BESIDE) | (near[other[rows]] != BESIDE)) & (length[rows] >= SHORTEST * radius)]
    if not len(rows):
        return no_strokes(segments, radius)
    words = np.concatenate(
        [
            _along(reach, places[one[block]], places[other[block]], float(length[block[-1]]))
            for block in np.split(rows, range(BLOCK, len(rows), BLOCK))
        ]
    )
    lines = np.sort(np.stack([near[one[rows]], near[other[rows]]], axis=1), axis=1)
    _, first = np.unique(np.concatenate([words, lines.view(np.uint64)], axis=1), axis=0, return_index=True)
    bits = (words[first][:, :, None] >> np.arange(WORD, dtype=np.uint64)) & np.uint64(1)
    touched = bits.reshape(len(first), -1)[:, :count].astype(bool)
    several = touched.sum(axis=1) > 1
    chosen = rows[first[several]]
    ends = np.stack([places[one[chosen]], places[other[chosen]]], axis=1)
    return Strokes(segments, radius, ends, lines[first[several]], touched[several])


def no_strokes(segments: Segments, radius: float) -> Strokes:
    """Return none."""
    none = np.zeros((0, len(segments)), bool)
    return Strokes(segments, radius, np.zeros((0, 2, 2)), np.zeros((0, 2), np.int64), none)


def _anchors(segments: Segments, each: int) -> Array:
    spread = (np.arange(each) + 0.5) / each
    rows = segments.offsets[:-1, None] + np.rint((segments.counts[:, None] - 1) * spread).astype(np.int64)
    return segments.points[rows].astype(np.float64).reshape(-1, 2)


def _grid(size: tuple[int, int]) -> Array:
    x, y = (number * (np.arange(steps) + 0.5) / steps for number, steps in zip(size, GRID, strict=True))
    return np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)


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
