"""Edges of the vehicle itself, found by their staying in place over the images of one camera.

A bonnet's rim or a windscreen frame repeats in every image at the same place and looks like a perfect long curve, which
would be taken for the lens's own doing. A segment is static if enough other images have an edge of the same direction
at the same place, and clearly more often than beside it: regular structures (kerbs, lane markings, horizons) also hit
by chance, but just as well a little to the side.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from app.vision.segments import Segments

Array = NDArray[np.float64]

CELL = 2.5
"""px; edge maps are kept at this coarseness."""
REACH = 2
"""Cells around a point within which it counts as hit: 5 px."""
DIRECTIONS = 30
"""Direction sectors of 6 degrees each, one bit of a map's cell per sector."""
SAMPLES = 16
HIT_SHARE = 0.5
"""Share of a segment's samples that must be hit for an image to count as a hit."""
BESIDE = (-36.0, -24.0, 24.0, 36.0)
"""px; shifts along the normal at which chance hits are counted."""
FEWEST_IMAGES = 4
MOST_COMPARED = 60
LEAST_HIT_RATE, LEAST_EXCESS = 0.25, 1.5


def static_segments(segments_per_image: Sequence[Segments], width: int, height: int) -> list[NDArray[np.bool_]]:
    """Tell which segments of each image belong to the vehicle rather than to the scene.

    Args:
        segments_per_image: Segments in px of the images of one camera.
        width: Image width in px.
        height: Image height in px.

    Returns:
        One bool ``(S,)`` for each image; all False where there are fewer than four images.
    """
    masks = [np.zeros(len(segments), bool) for segments in segments_per_image]
    if len(segments_per_image) < FEWEST_IMAGES:
        return masks
    # of a long drive, evenly spaced images tell as much as all of them
    step = -(-len(segments_per_image) // MOST_COMPARED)
    compared = range(0, len(segments_per_image), step)
    maps = {image: _edge_map(segments_per_image[image], width, height) for image in compared}
    for image, segments in enumerate(segments_per_image):
        if not len(segments):
            continue
        others = [maps[other] for other in compared if other != image]
        samples, normals, wanted = _samples(segments)
        hits = _hits(others, samples, wanted)
        chance = np.mean([_hits(others, samples + shift * normals[:, None], wanted) for shift in BESIDE], axis=0)
        masks[image] = (hits >= LEAST_HIT_RATE * len(others)) & (hits - chance >= LEAST_EXCESS)
    return masks


def _edge_map(segments: Segments, width: int, height: int) -> NDArray[np.uint32]:
    """Return cells with one bit for each direction of an edge nearby, uint32 ``(rows, columns)``."""
    cells = np.zeros((int(height / CELL) + 2, int(width / CELL) + 2), np.uint32)
    if not len(segments):
        return cells
    sector = np.repeat(_sectors(_directions(segments)), segments.counts)
    bits = np.zeros_like(sector, dtype=np.uint32)
    for turn in (-1, 0, 1):
        bits |= np.left_shift(np.uint32(1), ((sector + turn) % DIRECTIONS).astype(np.uint32))
    column, row = _cells(segments.points.astype(np.float64), cells)
    np.bitwise_or.at(cells, (row, column), bits)
    for axis in (0, 1):
        spread = cells.copy()
        for shift in range(1, REACH + 1):
            near, far = [slice(None)] * 2, [slice(None)] * 2
            near[axis], far[axis] = slice(shift, None), slice(None, -shift)
            if cells.shape[axis] > shift:
                spread[tuple(near)] |= cells[tuple(far)]
                spread[tuple(far)] |= cells[tuple(near)]
        cells = spread
    return cells


def _samples(segments: Segments) -> tuple[Array, Array, NDArray[np.uint32]]:
    """Return points spread over each segment ``(S, 16, 2)``, its normal ``(S, 2)`` and the bit of its direction."""
    rows = segments.offsets[:-1, None] + np.round((segments.counts[:, None] - 1) * np.linspace(0, 1, SAMPLES)).astype(
        np.int64
    )
    direction = _directions(segments)
    bit = np.left_shift(np.uint32(1), _sectors(direction).astype(np.uint32))
    normals = np.stack([-direction[:, 1], direction[:, 0]], -1)
    return segments.points[rows].astype(np.float64), normals, bit


def _hits(maps: Sequence[NDArray[np.uint32]], samples: Array, wanted: NDArray[np.uint32]) -> Array:
    """Count the maps that have an edge of the wanted direction along most of the samples, float64 ``(S,)``."""
    hits = np.zeros(len(samples))
    if maps:
        # all maps are of one camera and so of one size
        column, row = _cells(samples, maps[0])
        for cells in maps:
            hit = (cells[row, column] & wanted[:, None]) != 0
            hits += hit.mean(1) >= HIT_SHARE
    return hits


def _cells(points: Array, cells: NDArray[np.uint32]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    rows, columns = cells.shape
    place = np.floor((points + 0.5) / CELL).astype(np.int64)
    # the last row and column stay empty: what lies outside the image hits nothing
    outside = (place < 0).any(-1) | (place[..., 0] >= columns - 1) | (place[..., 1] >= rows - 1)
    return np.where(outside, columns - 1, place[..., 0]), np.where(outside, rows - 1, place[..., 1])


def _directions(segments: Segments) -> Array:
    chord = segments.points[segments.offsets[1:] - 1].astype(np.float64) - segments.points[segments.offsets[:-1]]
    length = np.hypot(*chord.T)
    return np.where(length[:, None] > 0, chord / np.where(length > 0, length, 1.0)[:, None], [1.0, 0.0])


def _sectors(direction: Array) -> NDArray[np.int64]:
    angle = np.arctan2(direction[:, 1], direction[:, 0]) % np.pi
    return np.floor(angle / np.pi * DIRECTIONS).astype(np.int64) % DIRECTIONS
