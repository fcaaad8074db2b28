"""Keeping one segment per edge."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from app.vision.arcs import Arcs
from app.vision.tracing import Trace

_LARGEST_SHARE = 0.4
_PARALLEL = 0.95


def uncovered(
    arcs: Arcs, samples: Trace, priority: NDArray[np.float64], width: float, shape: tuple[int, int]
) -> NDArray[np.bool_]:
    """Choose the samples that stay when no edge may be covered twice.

    Arcs are painted into the image, the best first. One that runs over the paint of arcs in its direction for more
    than 40 % of its way goes; of the others the painted ends go.

    Args:
        arcs: Arcs of one image.
        samples: Their samples, walk ``i`` being arc ``i``.
        priority: float64 ``(n,)``; the largest is painted first.
        width: How far from an arc the paint reaches, px.
        shape: Height and width of the image.

    Returns:
        bool ``(m,)``, the samples that stay: a run without a gap for each arc that stays.
    """
    bounds = samples.bounds(len(arcs))
    cells, painted = _cells(arcs, samples, width, shape)
    owner = np.full(shape[0] * shape[1], -1, np.int32)
    kept = np.zeros(len(samples.u), bool)
    tangent = arcs.tangent
    for arc in np.lexsort((np.arange(len(arcs)), -priority)):
        begin, end = bounds[arc], bounds[arc + 1]
        if begin == end:
            continue
        owners = owner[cells[begin:end]]
        free = (owners < 0) | (np.abs(tangent[owners] @ tangent[arc]) <= _PARALLEL)
        count = int(np.count_nonzero(free))
        if count < (1 - _LARGEST_SHARE) * (end - begin):
            continue
        if count < end - begin:
            first = int(free.argmax())
            last = end - begin - int(free[::-1].argmax())
            begin, end = begin + first, begin + last
        kept[begin:end] = True
        owner[painted[begin:end][samples.hit[begin:end]]] = arc
    return kept


def _cells(
    arcs: Arcs, samples: Trace, width: float, shape: tuple[int, int]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Flat index of each sample's pixel, ``(m,)``, and of the pixels to paint there, ``(m, p)``."""
    height, columns = shape
    position = arcs.positions(samples.walk, samples.u)
    steep = np.abs(arcs.tangent[samples.walk, 0]) < np.abs(arcs.tangent[samples.walk, 1])
    main = np.abs(arcs.tangent[samples.walk]).max(axis=1)
    across = np.where(steep, position[:, 0], position[:, 1])
    x = np.clip(samples.cells[:, 0], 0, columns - 1)
    y = np.clip(samples.cells[:, 1], 0, height - 1)
    own = np.where(steep, x, y)
    reach = int(np.ceil(width * np.sqrt(2)))
    painted = []
    for shift in range(-reach, reach + 1):
        near = np.abs(own + shift - across) * main <= width
        moved = np.clip(np.where(near, own + shift, own), 0, np.where(steep, columns, height) - 1)
        painted.append(np.where(steep, y * columns + moved, moved * columns + x))
    return y * columns + x, np.stack(painted, axis=1)
