"""Segments as bins along their chord: what the lens fit sees of them.

A segment of any length becomes at most 24 mean points with weights, and orthonormal polynomials over them, so that the
cost of a fit doesn't grow with the length of the segments. The bend of a segment is read off as the amplitudes of the
quadratic and the cubic polynomial; what neither they nor a line explain is its roughness, the best sign that an edge
isn't one straight line of the scene.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import ArrayLike, NDArray

from app.vision.frame import center_of, half_diagonal
from app.vision.segments import Segments

Array = NDArray[np.float64]

BINS = 24
FEWEST_FILLED = 8
FEWEST_POINTS = 16
MOST_ROUGHNESS = 0.5
"""px; a segment with more is no edge of one straight line."""
SIGMA_FLOOR, SIGMA_ROUGHNESS, SIGMA_LENGTH = 0.035, 1.7, 0.5
"""Error of a bend: px that no number of points averages out on a segment of 100 px, multiple of the roughness that
points do average out, and the power of the length that the former grows with (longer ones were merged of more)."""
SIGMA_LYING, ROUGHNESS_LYING = 1.14, 0.76
"""Factors of the former two for segments nearer to the horizontal."""


@dataclass(frozen=True, eq=False)
class BinnedSegments:
    """Segments of one camera, in bins; coordinates in half diagonals from the image centre.

    Attributes:
        image: int64 ``(S,)``, index of the image a segment comes from.
        index: int64 ``(S,)``, index of the segment within that image's segments.
        x: float64 ``(S, 24)``, mean of each bin's points; 0 where the bin is empty.
        y: Likewise.
        weight: float64 ``(S, 24)``, share of the segment's points in the bin.
        quadratic: float64 ``(S, 24)``, weight times the orthonormal polynomial of degree 2 along the chord.
        cubic: Likewise of degree 3.
        sigma: float64 ``(S,)`` px, expected error of both amplitudes.
        roughness: float64 ``(S,)`` px, RMS of what a cubic leaves in the measured image.
        vertical: bool ``(S,)``, chord nearer to the vertical than to the horizontal.
        length: float64 ``(S,)`` px, chord.
        middle: float64 ``(S, 2)``, middle of the chord as a share of the frame's width and height.
        scale: Half diagonal in px.
    """

    image: NDArray[np.int64]
    index: NDArray[np.int64]
    x: Array
    y: Array
    weight: Array
    quadratic: Array
    cubic: Array
    sigma: Array
    roughness: Array
    vertical: NDArray[np.bool_]
    length: Array
    middle: Array
    scale: float

    def __len__(self) -> int:
        return len(self.image)

    def select(self, chosen: ArrayLike) -> BinnedSegments:
        """Return the chosen segments: a boolean mask ``(S,)`` or indices."""
        rows = np.asarray(chosen)
        columns = {field.name: getattr(self, field.name) for field in fields(self) if field.name != "scale"}
        return BinnedSegments(**{name: column[rows] for name, column in columns.items()}, scale=self.scale)


def bin_segments(segments_per_image: Sequence[Segments], width: int, height: int) -> BinnedSegments:
    """Bin the segments of one camera; those that can tell nothing about a lens are left out.

    Left out are segments of fewer than 16 points or 8 filled bins, and those whose roughness is 0.5 px or more.

    Args:
        segments_per_image: Segments in px, one entry for each image.
        width: Image width in px.
        height: Image height in px.
    """
    counts = np.concatenate([np.zeros(0, np.int64), *(segments.counts for segments in segments_per_image)])
    image = np.repeat(np.arange(len(segments_per_image)), [len(segments) for segments in segments_per_image])
    index = np.concatenate([np.zeros(0, np.int64), *(np.arange(len(s)) for s in segments_per_image)])
    scale = half_diagonal(width, height)
    points = np.concatenate([np.zeros((0, 2)), *(segments.points for segments in segments_per_image)])
    points = (points - center_of(width, height)) / scale
    ends = np.cumsum(counts)
    of_point = np.repeat(np.arange(len(counts)), counts)

    first, last = points[ends - counts], points[ends - 1]
    chord = last - first
    length = np.hypot(*chord.T)
    safe = np.where(length > 0, length, 1.0)
    direction = chord / safe[:, None]
    along = ((points - first[of_point]) * direction[of_point]).sum(1) / safe[of_point]
    cell = of_point * BINS + np.clip((along * BINS).astype(np.int64), 0, BINS - 1)

    size = len(counts) * BINS
    filled = np.bincount(cell, minlength=size).reshape(-1, BINS).astype(np.float64)
    x, y, t = (
        np.bincount(cell, values, size).reshape(-1, BINS) / np.maximum(filled, 1)
        for values in (points[:, 0], points[:, 1], along)
    )
    weight = filled / np.maximum(counts, 1)[:, None]
    number = (filled > 0).sum(1)
    basis = orthonormal_polynomials(t, weight)

    across = scale * ((y - first[:, 1:]) * direction[:, :1] - (x - first[:, :1]) * direction[:, 1:])
    rest = across - sum((weight * b * across).sum(1, keepdims=True) * b for b in basis)
    roughness = np.sqrt((weight * rest**2).sum(1))
    spread = SIGMA_ROUGHNESS * roughness * np.sqrt(number / np.maximum(number - 4, 1))
    # neighbouring edge points share the blur of the image: about every third is independent
    independent = np.maximum(np.minimum(number, counts / 3), 1)
    vertical = np.abs(chord[:, 1]) > np.abs(chord[:, 0])
    floor = SIGMA_FLOOR * (scale * safe / 100) ** SIGMA_LENGTH * np.where(vertical, 1.0, SIGMA_LYING)
    spread = spread * np.where(vertical, 1.0, ROUGHNESS_LYING)
    binned = BinnedSegments(
        image=image.astype(np.int64),
        index=index.astype(np.int64),
        x=x,
        y=y,
        weight=weight,
        quadratic=weight * basis[2],
        cubic=weight * basis[3],
        sigma=np.sqrt(floor**2 + spread**2 / independent),
        roughness=roughness,
        vertical=vertical,
        length=scale * length,
        middle=0.5 + scale * (first + chord / 2) / (width, height),
        scale=scale,
    )
    usable = (counts >= FEWEST_POINTS) & (number >= FEWEST_FILLED) & (length > 0) & (roughness < MOST_ROUGHNESS)
    return binned.select(usable)


def orthonormal_polynomials(t: Array, weight: Array) -> list[Array]:
    """Return polynomials of degree 0 to 3 in t, orthonormal under the weights, row by row (Gram-Schmidt).

    Args:
        t: float64 ``(S, B)``.
        weight: float64 ``(S, B)``, each row adding up to 1.

    Returns:
        Four arrays ``(S, B)``; a degree that a row has too few filled bins for is 0 there.
    """
    center = (weight * t).sum(1, keepdims=True)
    spread = np.sqrt((weight * (t - center) ** 2).sum(1, keepdims=True))
    u = (t - center) / np.where(spread > 0, spread, 1.0)
    basis: list[Array] = []
    for degree in range(4):
        power = u**degree
        for _ in range(2):  # once more, against the cancellation of the first pass
            for lower in basis:
                power = power - (weight * lower * power).sum(1, keepdims=True) * lower
        norm = np.sqrt((weight * power**2).sum(1, keepdims=True))
        basis.append(np.where(norm > 1e-6, power / np.where(norm > 1e-6, norm, 1.0), 0.0))
    return basis
