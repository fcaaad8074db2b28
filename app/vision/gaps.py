"""What the image says about the gap between two segments that may be one."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from app.vision.arcs import Arcs, turn
from app.vision.edges import Gradient

_SAMPLES = 16
_SUPPORT_NORM = 25.0
_SUPPORT_COSINE = float(np.cos(np.radians(22.5)))
_CROSSING_NORM = 60.0
_GREY_CHANGE = 25.0
_CONTRAST_RATIO = 0.5


def effective_gaps(
    arcs: Arcs,
    first: NDArray[np.int64],
    second: NDArray[np.int64],
    leave: NDArray[np.float64],
    enter: NDArray[np.float64],
    same_polarity: bool,
    field: Gradient,
) -> NDArray[np.float64]:
    """Length of gaps in px, made longer or shorter by the evidence for an interrupted edge.

    Longer where the grey levels beside the arcs or their contrasts differ; shorter where the gradient goes on
    through the gap, and where nothing crosses it.

    Args:
        arcs: All arcs.
        first: int64 ``(m,)``, arcs before the gaps.
        second: int64 ``(m,)``, arcs after them.
        leave: float64 ``(m, 2)`` px, where the gaps begin.
        enter: float64 ``(m, 2)`` px, where they end.
        same_polarity: Whether the bright side is the same before and after.
        field: Gradient of the equalised image.
    """
    vector = enter - leave
    gap = np.hypot(vector[:, 0], vector[:, 1])
    effective = gap.copy()
    means = arcs.traits / arcs.sums[:, :1]
    if same_polarity:
        changed = np.abs(means[first, :2] - means[second, :2]).min(axis=1) > _GREY_CHANGE
        effective[changed] *= 1.7
    contrast = np.sort(np.stack([means[first, 2], means[second, 2]]), axis=0)
    effective[contrast[0] < _CONTRAST_RATIO * contrast[1]] *= 1.5

    long = np.flatnonzero(gap > 1.5)
    direction = vector[long] / gap[long, None]
    support, crossed = _look(field, leave[long], vector[long], direction)
    effective[long] *= 1 - 0.7 * support
    effective[long[~crossed]] *= 0.5
    return effective


def _look(
    field: Gradient, leave: NDArray[np.float64], vector: NDArray[np.float64], direction: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Share of the gap with an edge along it, and whether an edge runs across it."""
    height, width = field.norm.shape
    across = turn(direction)
    steps = (np.arange(_SAMPLES) + 0.5) / _SAMPLES
    middle = leave[:, None, :] + steps[None, :, None] * vector[:, None, :]
    supported = np.zeros(middle.shape[:2], bool)
    crossed = np.zeros(len(leave), bool)
    for shift in (-1.0, 0.0, 1.0):
        place = np.rint(middle + shift * across[:, None, :]).astype(np.int64)
        flat = np.clip(place[..., 1], 0, height - 1) * width + np.clip(place[..., 0], 0, width - 1)
        norm, gx, gy = field.norm.ravel()[flat], field.x.ravel()[flat], field.y.ravel()[flat]
        normal_part = np.abs(gx * across[:, None, 0] + gy * across[:, None, 1])
        supported |= (norm >= _SUPPORT_NORM) & (normal_part >= _SUPPORT_COSINE * norm)
        if shift == 0:
            along_part = np.abs(gx * direction[:, None, 0] + gy * direction[:, None, 1])
            crossed = np.any(along_part > _CROSSING_NORM, axis=1)
    return supported.mean(axis=1), crossed
