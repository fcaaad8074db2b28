"""Sub-pixel polylines on an image: solid, dashed or dotted, on a dark casing."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

import cv2
import numpy as np
from numpy.typing import NDArray

_SHIFT = 4  # cv2 takes integers of 1/16 px
_FARTHEST = 1e6  # px; beyond it cv2's integers overflow
_MASK_PIXELS = 1 << 24  # size of a mask that is drawn larger than the picture


class Pattern(Enum):
    """How a line is interrupted; the second sign, beside colour, of what it means."""

    SOLID = "solid"
    DASHED = "dashed"
    DOTTED = "dotted"


@dataclass(frozen=True)
class Stroke:
    """How a line looks.

    Attributes:
        color: Blue, green, red in [0, 255].
        pattern: How it is interrupted.
        width: Width of the line, in units of the picture's line width.
    """

    color: tuple[int, int, int]
    pattern: Pattern
    width: float = 1.0


_CASING_COLOR = (15, 15, 15)
_CASING_OPACITY = 0.8


def draw_stroke(
    canvas: NDArray[np.uint8], polylines: Sequence[NDArray[np.floating]], stroke: Stroke, unit: float
) -> None:
    """Draw polylines into ``canvas``, all casings below all lines.

    Args:
        canvas: uint8 ``(H, W, 3)``, changed in place.
        polylines: Each ``(n, 2)`` in px; the point (x, y) is the centre of pixel (x, y).
        stroke: How they look.
        unit: Line width of the picture, px.
    """
    if not len(polylines):
        return
    width = stroke.width * unit
    casing = width + max(1.8, 0.8 * unit)
    if stroke.pattern is Pattern.DASHED:
        polylines = [dash for polyline in polylines for dash in dashes(polyline, 4.0 * width, 2.8 * width)]
    if stroke.pattern is Pattern.DOTTED:  # a dot is a line without length and with round ends
        polylines = [dot[None] for polyline in polylines for dot in along(polyline, 2.4 * width)]
    _blend(canvas, polylines, casing, _CASING_COLOR, _CASING_OPACITY)
    _blend(canvas, polylines, width, stroke.color, 1.0)


def along(polyline: NDArray[np.floating], spacing: float) -> NDArray[np.float64]:
    """Return points at equal steps of arc length, close to ``spacing`` px, from end to end: float64 ``(n, 2)``."""
    points, distance = _arc_length(polyline)
    count = max(1, round(distance[-1] / spacing)) + 1
    position = np.linspace(0.0, distance[-1], count)
    return np.stack([np.interp(position, distance, points[:, axis]) for axis in (0, 1)], axis=1)


def dashes(polyline: NDArray[np.floating], dash: float, gap: float) -> list[NDArray[np.float64]]:
    """Cut a polyline into dashes, stretched so that it begins and ends with a whole one.

    Args:
        polyline: ``(n, 2)``, px.
        dash: Length of a dash, px.
        gap: Length of a gap, px.

    Returns:
        Polylines, float64 ``(m, 2)`` each; the whole one where it is too short for two dashes.
    """
    points, distance = _arc_length(polyline)
    gaps = int((distance[-1] - dash) // (dash + gap))
    if gaps < 1:
        return [points]
    stretch = distance[-1] / (gaps * (dash + gap) + dash)
    starts = np.arange(gaps + 1) * (dash + gap) * stretch
    return [_cut(points, distance, start, start + dash * stretch) for start in starts]


def _cut(points: NDArray[np.float64], distance: NDArray[np.float64], start: float, end: float) -> NDArray[np.float64]:
    inside = points[(distance > start) & (distance < end)]
    ends = [[np.interp(at, distance, points[:, axis]) for axis in (0, 1)] for at in (start, end)]
    return np.concatenate([ends[:1], inside, ends[1:]])


def _arc_length(polyline: NDArray[np.floating]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    points = np.clip(np.asarray(polyline, dtype=np.float64), -_FARTHEST, _FARTHEST)
    steps = np.hypot(*np.diff(points, axis=0).T) if len(points) > 1 else np.zeros(0)
    return points, np.concatenate([[0.0], np.cumsum(steps)])


def _blend(
    canvas: NDArray[np.uint8],
    polylines: Sequence[NDArray[np.floating]],
    width: float,
    color: tuple[int, int, int],
    opacity: float,
) -> None:
    height, breadth = canvas.shape[:2]
    mask = _coverage(polylines, (breadth, height), width)
    touched = np.nonzero(mask)
    alpha = mask[touched].astype(np.float32)[:, None] * (opacity / 255.0)
    blended = canvas[touched] * (1.0 - alpha) + np.array(color, np.float32) * alpha
    canvas[touched] = np.rint(blended).astype(np.uint8)


def _coverage(polylines: Sequence[NDArray[np.floating]], size: tuple[int, int], width: float) -> NDArray[np.uint8]:
    """Return how much of each pixel the lines cover, uint8 ``(H, W)``; drawn larger for widths below a pixel."""
    factor = max(1, min(4, math.isqrt(_MASK_PIXELS // (size[0] * size[1]))))
    mask = np.zeros((size[1] * factor, size[0] * factor), np.uint8)
    # with cv2, an anti-aliased line of even thickness t is t + 1.4 px wide
    thickness = 2 * max(1, round((width * factor - 1.4) / 2))
    radius = max(1, round(width * factor / 2 * (1 << _SHIFT)))
    fixed = _fixed(polylines, factor)
    cv2.polylines(mask, [points for points in fixed if len(points) > 1], False, 255, thickness, cv2.LINE_AA, _SHIFT)
    for x, y in (points[0].tolist() for points in fixed if len(points) == 1):
        cv2.circle(mask, (x, y), radius, 255, cv2.FILLED, cv2.LINE_AA, _SHIFT)
    return mask if factor == 1 else cv2.resize(mask, size, interpolation=cv2.INTER_AREA).astype(np.uint8, copy=False)


def _fixed(polylines: Sequence[NDArray[np.floating]], factor: int) -> list[NDArray[np.int32]]:
    """Return the polylines on a mask ``factor`` times as large, in cv2's fixed-point integers."""
    points = np.concatenate(polylines).astype(np.float64)
    enlarged = (np.clip(points, -_FARTHEST, _FARTHEST) + 0.5) * factor - 0.5
    ends = np.cumsum([len(polyline) for polyline in polylines])
    return np.split(np.rint(enlarged * (1 << _SHIFT)).astype(np.int32), ends[:-1])
