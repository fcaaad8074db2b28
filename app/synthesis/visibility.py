"""Which samples of an edge can be seen: not hidden, and with how high a step of grey across."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from app.synthesis.rasteriser import Picture
from app.vision.image_reading import read_image

CLEAR_STEP = 8.0  # grey levels
FAINT_STEP = 4.0
REACH = 3  # samples to both sides over which a step is averaged
_ASIDE = 1.5  # px of the ideal picture
_SAME_DEPTH = 0.012  # relative
_SHARE_OF_STEP = 0.75  # of a blurred step that lies within 0.75 px of it
_RIVAL = 0.85  # of the rise 0.75 px beside the edge


def unhidden(
    picture: Picture,
    places: NDArray[np.float64],
    normals: NDArray[np.float64],
    inverse_depths: NDArray[np.float64],
) -> NDArray[np.bool_]:
    """Which samples nothing stands in front of.

    Looks at the surfaces on both sides and asks how deep each, continued to the sample itself, lies there: for the
    surfaces that meet in the edge that is its own depth whatever their slant, for one in front it is less.

    Args:
        picture: The ideal picture with its surfaces.
        places: Samples in the ideal picture, ``(n, 2)`` px.
        normals: Unit vectors across the edge there, ``(n, 2)``.
        inverse_depths: Of the samples, ``(n,)`` 1/m.
    """
    height, width = picture.surface.shape
    clear = np.ones(len(places), np.bool_)
    owned = np.zeros(len(places), np.bool_)
    x, y = places.T
    nearest, farthest = inverse_depths * (1 + _SAME_DEPTH), inverse_depths * (1 - _SAME_DEPTH)
    for side in (-_ASIDE, _ASIDE):
        column = np.rint(x + side * normals[:, 0]).astype(np.int64)
        row = np.rint(y + side * normals[:, 1]).astype(np.int64)
        inside = (column >= 0) & (row >= 0) & (column < width) & (row < height)
        a, b, c = picture.planes[np.where(inside, picture.surface[row * inside, column * inside], 0)].T
        here = a * x + b * y + c
        clear &= inside & (here <= nearest)
        owned |= (here >= farthest) & (here <= nearest)
    return clear & owned


def contrast(
    grey: NDArray[np.float32],
    points: NDArray[np.float64],
    normals: NDArray[np.float64],
    owners: NDArray[np.int64],
) -> NDArray[np.float32]:
    """How high the step across each sample is, grey levels; 0 where the steepest place isn't at the edge itself.

    An edge beside a stronger one, or one side of something thinner than the blur, has its steepest place elsewhere:
    no detector could find it where it truly is, so it isn't a label.

    Args:
        grey: The photo without noise, float32 ``(H, W)``.
        points: Samples in px, ``(n, 2)``, in order along each edge.
        normals: Unit vectors across the edge there, ``(n, 2)``.
        owners: The edge each sample belongs to, ``(n,)``.
    """
    offsets = np.array([-1.25, -0.75, -0.5, -0.25, 0.25, 0.5, 0.75, 1.25])
    at = points[:, None] + offsets[None, :, None] * normals[:, None]
    values = _smooth_along(read_image(grey, at), owners)
    step = values[:, 6] - values[:, 1]
    sign = np.sign(step)
    here, before, behind = (sign * (values[:, high] - values[:, low]) for low, high in ((2, 5), (0, 3), (4, 7)))
    steepest = (here > 0) & (here >= _RIVAL * np.maximum(before, behind))
    return np.where(steepest, np.abs(step) / _SHARE_OF_STEP, 0).astype(np.float32)


def _smooth_along(values: NDArray[np.float32], owners: NDArray[np.int64], reach: int = REACH) -> NDArray[np.float32]:
    """Mean over up to `reach` samples on both sides along the same edge: texture is not contrast."""
    total = np.zeros_like(values)
    count = np.zeros((len(values), 1), np.float32)
    for shift in range(-reach, reach + 1):
        low, high = max(0, -shift), min(len(values), len(values) - shift)
        if high <= low:
            continue
        same = (owners[low:high] == owners[low + shift : high + shift])[:, None].astype(np.float32)
        total[low:high] += same * values[low + shift : high + shift]
        count[low:high] += same
    return total / count
