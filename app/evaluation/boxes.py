"""Bounding boxes of segments and their intersection over union, as protocol official-v1 uses them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from app.vision.segments import Segments

MINIMUM_SIDE = 10.0
"""Sides shorter than this are padded to it, px."""

_BLOCK_CELLS = 1 << 14  # cells of one block: arrays of 128 kB stay in the processor's cache


def padded_boxes(segments: Segments, minimum_side: float = MINIMUM_SIDE) -> NDArray[np.float64]:
    """Return the box of each segment, sides that are too short padded on both ends alike.

    A horizontal or vertical line has a box without area, so that without padding its overlap with anything is 0.

    Args:
        segments: S segments, px.
        minimum_side: Least width and height of a box, px.

    Returns:
        float64 ``(S, 4)``: ``x0, y0, x1, y1`` in px, the extremes of the points themselves (no half pixel added).
    """
    boxes = segments.boxes().astype(np.float64)
    low, high = boxes[:, :2], boxes[:, 2:]
    side = high - low
    padding = np.where(side < minimum_side, (minimum_side - side) / 2, 0.0)
    return np.concatenate([low - padding, high + padding], axis=1)


def box_iou(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the intersection over union of every box of ``a`` with every box of ``b``.

    ``IoU = |a & b| / (|a| + |b| - |a & b|)``, 0 where both have no area.

    Args:
        a: float64 ``(A, 4)``, ``x0, y0, x1, y1``.
        b: float64 ``(B, 4)``.

    Returns:
        float64 ``(A, B)`` in [0, 1].

    Example:
        >>> box_iou(np.array([[0.0, 0, 10, 10]]), np.array([[0.0, 0, 10, 20], [50, 50, 60, 60]]))
        array([[0.5, 0. ]])
    """
    iou = np.empty((len(a), len(b)))
    for rows, block in iou_blocks(a, b):
        iou[rows] = block
    return iou


def iou_blocks(a: NDArray[np.float64], b: NDArray[np.float64]) -> Iterator[tuple[slice, NDArray[np.float64]]]:
    """Yield the rows of the IoU matrix block by block, so that memory stays bounded however many there are.

    Args:
        a: float64 ``(A, 4)``.
        b: float64 ``(B, 4)``.

    Yields:
        The rows' slice of ``a``, and their IoU with all of ``b``, float64 ``(rows, B)``.
    """
    rows = max(1, _BLOCK_CELLS // max(1, len(b)))
    area_b = _area(b)
    for start in range(0, len(a), rows):
        block = a[start : start + rows, None, :]
        intersection = _common_side(block[..., 0], block[..., 2], b[:, 0], b[:, 2])
        intersection *= _common_side(block[..., 1], block[..., 3], b[:, 1], b[:, 3])
        union = _area(block) + area_b
        union -= intersection
        # where the union is nothing, so is the intersection
        np.maximum(union, np.finfo(np.float64).tiny, out=union)
        intersection /= union
        yield slice(start, start + len(block)), intersection


def _common_side(
    low: NDArray[np.float64], high: NDArray[np.float64], other_low: NDArray[np.float64], other_high: NDArray[np.float64]
) -> NDArray[np.float64]:
    side = np.minimum(high, other_high)
    side -= np.maximum(low, other_low)
    return np.maximum(side, 0.0, out=side)


def _area(boxes: NDArray[np.float64]) -> NDArray[np.float64]:
    return (boxes[..., 2] - boxes[..., 0]) * (boxes[..., 3] - boxes[..., 1])
