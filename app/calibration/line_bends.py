"""What the lines of a camera still bend under a lens, and how a displacement of the corrected image would change it.

Each segment becomes up to 24 mean points along its chord. Its residuals are the first-order distances in the measured
image of `app.vision.sampson`; to first order a displacement d of the corrected points changes them by
``n . d / |J^T n|`` less the shift and the turn that the refitted line takes up. What is left is told by the amplitudes
of orthonormal polynomials of degree 2 to 6 along the segment, of independent noise each.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.calibration.bspline import SplineGrid
from app.calibration.corrected_lines import ImageLines
from app.calibration.lens import CameraLens
from app.calibration.mean_points import BINS, mean_points
from app.vision.segments import Segments

Array = NDArray[np.float64]

DEGREES = 7
"""Degrees 0 to 6; the first two belong to the line."""
SHORTEST = 40.0
"""px of chord; the bend of a shorter segment is lost in its noise."""
MOST_SEGMENTS = 4000
CORRELATED = 3.0
"""Edge points that one independent point stands for: they share the blur of the image."""
FLOOR = 0.02
"""px; error of an amplitude that no number of points averages out."""


@dataclass(frozen=True, eq=False)
class LineBends:
    """Bends of S segments as rows of A amplitudes, and their change by the coefficients of a field.

    Attributes:
        image: int64 ``(S,)``, the image of each.
        bend: float64 ``(S, A)`` px.
        slopes: float64 ``(S, A, 2 C)``, derivatives by the C coefficients along x, then along y.
        sigma: float64 ``(S, A)`` px, expected noise.
        weight: float64 ``(S,)``, probability of being a straight line.
    """

    image: NDArray[np.int64]
    bend: Array
    slopes: Array
    sigma: Array
    weight: Array

    def __len__(self) -> int:
        return len(self.image)


def line_bends(images: Sequence[ImageLines], lens: CameraLens, grid: SplineGrid) -> LineBends:
    """Return the bends of all segments from 40 px of chord on.

    Args:
        images: Of one camera.
        lens: Its lens.
        grid: Knots of the displacement field.
    """
    chosen = [_usable(image) for image in images]
    number = [len(index) for index, _ in chosen]
    image = np.repeat(np.arange(len(images)), number)
    weight = np.concatenate([np.zeros(0), *(odds for _, odds in chosen)])
    polylines = [
        points for each, (index, _) in zip(images, chosen, strict=True) for points in each.segments.select(index)
    ]
    segments = Segments.from_list(polylines)
    if len(segments) > MOST_SEGMENTS:
        longest = np.sort(np.argsort(-weight * segments.extents(), kind="stable")[:MOST_SEGMENTS])
        segments, image, weight = segments.select(longest), image[longest], weight[longest]
    if not len(segments):
        none = np.zeros((0, DEGREES - 2))
        return LineBends(image.astype(np.int64), none, np.zeros((0, DEGREES - 2, 2 * grid.size)), none, weight)
    return _bends(segments, image.astype(np.int64), weight, lens, grid)


def _usable(image: ImageLines) -> tuple[NDArray[np.int64], Array]:
    segments = image.segments
    odds = np.ones(len(segments)) if image.probability is None else np.asarray(image.probability, np.float64)
    if not len(segments):
        return np.zeros(0, np.int64), np.zeros(0)
    index = np.flatnonzero((segments.extents() >= SHORTEST) & (segments.counts >= BINS) & (odds > 0.5))
    return index, odds[index]


def _bends(
    segments: Segments, image: NDArray[np.int64], weight: Array, lens: CameraLens, grid: SplineGrid
) -> LineBends:
    number = len(segments)
    means = mean_points(segments)
    middle, share = means.points, means.share
    flat = middle.reshape(-1, 2)
    corrected = lens.undistort(flat).reshape(number, BINS, 2)
    jacobian = lens.jacobian(flat).reshape(number, BINS, 2, 2)
    everything = np.concatenate([corrected.reshape(number, -1), jacobian.reshape(number, -1)], axis=1)
    whole: NDArray[np.bool_] = np.asarray(np.isfinite(everything).all(axis=1), np.bool_)
    corrected = np.where(whole[:, None, None], corrected, 0.0)
    jacobian = np.where(whole[:, None, None, None], jacobian, np.eye(2))
    away = corrected - (share[:, :, None] * corrected).sum(1, keepdims=True)
    x, y = away[..., 0], away[..., 1]
    angle = 0.5 * np.arctan2(2 * (share * x * y).sum(1), (share * (x * x - y * y)).sum(1))
    normal = np.stack([-np.sin(angle), np.cos(angle)], -1)
    uphill = np.einsum("sbij,si->sbj", jacobian, normal)
    stretch = np.maximum(np.linalg.norm(uphill, axis=-1), 1e-6)
    residual = np.einsum("sbi,si->sb", away, normal) / stretch
    position = np.einsum("sbi,si->sb", away, np.stack([normal[:, 1], -normal[:, 0]], -1)) / lens.scale
    basis = _polynomials(means.along, share, 1 / stretch, position / stretch)
    weighted = basis[:, :, 2:] * share[:, :, None]
    bend = np.einsum("sba,sb->sa", weighted, residual)
    # on the line, not at the noisy points: a field that shrinks the image would seem to explain their noise
    on_line = middle - (residual / stretch)[:, :, None] * uphill
    values = grid.basis(on_line.reshape(-1, 2)).reshape(number, BINS, grid.size) / stretch[:, :, None]
    along_normal = np.matmul(weighted.transpose(0, 2, 1), values)
    slopes = np.concatenate([normal[:, 0, None, None] * along_normal, normal[:, 1, None, None] * along_normal], axis=2)
    noise = np.sqrt(CORRELATED * means.noise**2 / means.count + FLOOR**2)
    enough = whole & ((share > 0).sum(1) >= DEGREES + 2)
    kept = np.flatnonzero(enough)
    sigma = np.repeat(noise[:, None], DEGREES - 2, axis=1)
    return LineBends(image[kept], bend[kept], slopes[kept], sigma[kept], weight[kept])


def _polynomials(along: Array, share: Array, shift: Array, turn: Array) -> Array:
    """Return what a shift and a turn of the line do to residuals, then polynomials of degree 2 to 6.

    All are orthonormal under the shares, float64 ``(S, 24, 7)``; so the latter hold nothing that a refit of the line
    would take up.
    """
    low, high = np.where(share > 0, along, np.inf).min(1), np.where(share > 0, along, -np.inf).max(1)
    t = 2 * (along - low[:, None]) / np.maximum(high - low, 1e-9)[:, None] - 1
    columns = np.polynomial.legendre.legvander(np.clip(t, -1, 1), DEGREES - 1)
    columns[:, :, 0], columns[:, :, 1] = shift, turn
    root = np.sqrt(share)
    orthonormal, _ = np.linalg.qr(root[:, :, None] * columns)
    return np.asarray(orthonormal / np.where(root > 0, root, 1.0)[:, :, None], np.float64) * (share > 0)[:, :, None]
