"""What a brush touches, by the label page's own rule (`frontend/src/canvas/touching.ts` and `scene.ts`).

A line is touched if any part of its polyline comes within the brush's radius of the straight stroke; a press belongs
to the nearest line within the radius. `frontend/src/labelling/tools/stroke_cases.json` holds both sides to the same
answers.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from app.vision import Segments

Array = NDArray[np.float64]

BESIDE = -1
"""Where a stroke begins or ends on no line."""


def touched_lines(segments: Segments, start: Array, end: Array, radius: float) -> NDArray[np.bool_]:
    """Tell which of S lines a straight stroke touches.

    Args:
        segments: The lines, px.
        start: ``(2,)``, where the stroke begins, px.
        end: ``(2,)``, where it ends, px.
        radius: Of the brush, px.

    Returns:
        bool ``(S,)``.
    """
    from_, to, line = _pieces(segments)
    low, high = np.minimum(start, end) - radius, np.maximum(start, end) + radius
    near = np.flatnonzero(
        ((np.maximum(from_, to) >= low) & (np.minimum(from_, to) <= high)).all(axis=1)  # the others are out of reach
    )
    one, other = from_[near], to[near]
    squared = np.minimum.reduce(
        [
            _squared_distance(one, start, end),
            _squared_distance(other, start, end),
            _squared_distance(start, one, other),
            _squared_distance(end, one, other),
        ]
    )
    hit = (squared <= radius**2) | _cross(start, end, one, other)
    touched = np.zeros(len(segments), bool)
    touched[line[near[hit]]] = True
    return touched


def nearest_lines(segments: Segments, places: Array, radius: float) -> NDArray[np.int64]:
    """Return for each of P places ``(P, 2)`` the nearest line within the radius, int64 ``(P,)``; else `BESIDE`."""
    nearest = np.full(len(places), BESIDE, np.int64)
    from_, to, line = _pieces(segments)
    for number, place in enumerate(places):
        squared = _squared_distance(place, from_, to)
        closest = np.flatnonzero(squared == squared.min())
        if squared[closest[0]] <= radius**2:
            nearest[number] = line[closest].min()  # of equally near ones the page takes the first
    return nearest


def _pieces(segments: Segments) -> tuple[Array, Array, NDArray[np.int64]]:
    """Return both ends ``(N, 2)`` of all pieces of all lines, and the line of each; a line of one point is a piece."""
    points = segments.points.astype(np.float64)
    line = segments.segment_of_point
    following = np.minimum(np.arange(len(points)) + 1, segments.offsets[1:][line] - 1)
    inner = (following > np.arange(len(points))) | (segments.counts[line] == 1)
    return points[inner], points[following[inner]], line[inner].astype(np.int64)


def _squared_distance(points: Array, start: Array, end: Array) -> Array:
    """Return the squared distance of points from straight pieces; any of the three may be one or many."""
    chord = end - start
    squared = (chord**2).sum(axis=-1)
    share = ((points - start) * chord).sum(axis=-1) / np.where(squared > 0, squared, 1.0)
    foot = start + np.clip(share, 0.0, 1.0)[..., None] * chord
    return ((points - foot) ** 2).sum(axis=-1)


def _cross(start: Array, end: Array, one: Array, other: Array) -> NDArray[np.bool_]:
    """Tell whether each piece's ends lie on both sides of the stroke, and the stroke's on both sides of the piece."""
    return (_side(start, end, one) * _side(start, end, other) < 0) & (
        _side(one, other, start) * _side(one, other, end) < 0
    )


def _side(start: Array, end: Array, point: Array) -> Array:
    chord, offset = end - start, point - start
    return chord[..., 0] * offset[..., 1] - chord[..., 1] * offset[..., 0]
