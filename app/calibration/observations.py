"""Reviewed lines as the joint fit sees them: bins along the chord, and how a line's points err about a smooth curve.

A line of any length becomes at most 16 mean points. A lens moves them by a smooth curve, so all that a line tells of
one lies in its amplitudes: residuals projected on orthonormal polynomials of the degrees 2 to 6 along the chord (the
degrees 0 and 1 are where the line lies, which nobody knows). What a curve of degree 6 leaves of the points is the
line's roughness, known before any lens is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import NamedTuple, Protocol

import numpy as np
from numpy.polynomial.legendre import legvander
from numpy.typing import ArrayLike, NDArray

from app.calibration.left_out import copies, outside_frame
from app.vision.frame import center_of, half_diagonal
from app.vision.segments import Segments

Array = NDArray[np.float64]

BINS = 16
FEWEST_FILLED = 4
"""Bins, and points: with three a line tells no more than one number, which nothing could check."""
DEGREES = np.arange(2, 7)
KEPT = 0.97
"""Probability of being straight of a line that a person kept."""
SHORTEST = 8.0
"""px of chord; shorter lines tell nothing."""
BANDS = 4
STRUCTURES = 2 * BANDS


class LabelledImage(Protocol):
    """An image's segments and, where nobody decided, their probabilities."""

    @property
    def segments(self) -> Segments:
        """In px."""
        ...

    @property
    def probability(self) -> Array | None:
        """Of being straight, ``(S,)`` in [0, 1]; ``None`` where a person kept all."""
        ...


@dataclass(frozen=True, eq=False)
class Observed:
    """A `LabelledImage` without a name."""

    segments: Segments
    probability: Array | None = None


@dataclass(frozen=True, eq=False)
class LineObservations:
    """Lines of one camera, in bins; coordinates in half diagonals from the image centre.

    Attributes:
        image: int64 ``(S,)``, index of the image a line comes from.
        index: int64 ``(S,)``, index of the line within that image's segments.
        x: float64 ``(S, 16)``, mean of each bin's points; the line's middle where the bin is empty.
        y: Likewise.
        weight: float64 ``(S, 16)``, share of the line's points in the bin.
        basis: float64 ``(S, 5, 16)``, weight times the orthonormal polynomial of degree 2 to 6 along the chord.
        known: bool ``(S, 5)``, whether there are bins enough for the degree.
        probability: float64 ``(S,)`` of being straight, before any lens is fitted.
        roughness: float64 ``(S,)`` px, standard deviation of points about a curve of degree 6; NaN with too few points.
        points: float64 ``(S,)``, number of points.
        spacing: float64 ``(S,)`` px, chord per point.
        length: float64 ``(S,)`` px, chord.
        middle: float64 ``(S, 2)``, of the chord, as a share of the frame's width and height.
        direction: float64 ``(S,)`` rad in [0, pi), of the chord.
        scale: Half diagonal in px.
    """

    image: NDArray[np.int64]
    index: NDArray[np.int64]
    x: Array
    y: Array
    weight: Array
    basis: Array
    known: NDArray[np.bool_]
    probability: Array
    roughness: Array
    points: Array
    spacing: Array
    length: Array
    middle: Array
    direction: Array
    scale: float

    def __len__(self) -> int:
        return len(self.image)

    def select(self, chosen: ArrayLike) -> LineObservations:
        """Return the chosen lines: a boolean mask ``(S,)`` or indices."""
        rows = np.asarray(chosen)
        columns = {field.name: getattr(self, field.name)[rows] for field in fields(self) if field.name != "scale"}
        return LineObservations(**columns, scale=self.scale)

    def with_roughness(self, roughness: float) -> LineObservations:
        """Return the lines as if their points had erred by so many px."""
        return replace(self, roughness=np.full(len(self), roughness))


def observe(images: Sequence[LabelledImage], width: int, height: int) -> LineObservations:
    """Bin the lines of one camera's images.

    Left out are lines of fewer than 4 points or filled bins, shorter ones than 8 px, those that are held impossible
    (probability 0), and those that leave the frame.

    Args:
        images: Of the camera.
        width: Image width in px.
        height: Image height in px.
    """
    counts = np.concatenate([np.zeros(0, np.int64), *(image.segments.counts for image in images)])
    number = len(counts)
    scale = half_diagonal(width, height)
    points = np.concatenate([np.zeros((0, 2)), *(image.segments.points for image in images)])
    outside = outside_frame(images, width, height)
    # what leaves the frame may be any number of px away, too far to be squared
    points = np.where(np.repeat(outside, counts)[:, None], 0.0, points - center_of(width, height))
    of_point, ends = np.repeat(np.arange(number), counts), np.cumsum(counts)

    first = points[ends - counts]
    chord = points[ends - 1] - first
    length = np.hypot(*chord.T)
    along_chord = chord / np.where(length > 0, length, 1.0)[:, None]
    away = points - first[of_point]
    t = (away * along_chord[of_point]).sum(1) / np.where(length > 0, length, 1.0)[of_point]
    across = away[:, 1] * along_chord[of_point, 0] - away[:, 0] * along_chord[of_point, 1]

    cell = of_point * BINS + np.clip((t * BINS).astype(np.int64), 0, BINS - 1)
    filled = np.bincount(cell, minlength=number * BINS).reshape(-1, BINS).astype(np.float64)
    mean_t, mean_across = (
        np.bincount(cell, values, number * BINS).reshape(-1, BINS) / np.maximum(filled, 1) for values in (t, across)
    )
    weight = filled / np.maximum(counts, 1)[:, None]
    filled_bins = (filled > 0).sum(1)
    known = filled_bins[:, None] > DEGREES
    curves = _Curves.fitted(mean_t, mean_across, weight, filled_bins)
    # points of a bent bin lie to one side of the curve at their mean
    smooth = curves.at(t, of_point)
    mean_smooth = np.bincount(cell, smooth, number * BINS).reshape(-1, BINS) / np.maximum(filled, 1)
    rows = np.repeat(np.arange(number), BINS)
    mean_across -= np.where(filled > 0, mean_smooth - curves.at(mean_t.ravel(), rows).reshape(-1, BINS), 0.0)
    freedom = counts - np.minimum(filled_bins, 1 + DEGREES[-1])
    with np.errstate(invalid="ignore", divide="ignore"):
        roughness = np.sqrt(
            np.bincount(of_point, (across - smooth) ** 2, number) / np.where(freedom > 0, freedom, np.nan)
        )

    placed = first[:, None, :] + mean_t[..., None] * chord[:, None, :]
    placed += mean_across[..., None] * np.stack([-along_chord[:, 1], along_chord[:, 0]], -1)[:, None, :]
    middle = first + chord / 2
    placed = np.where((filled > 0)[..., None], placed, middle[:, None, :]) / scale
    observations = LineObservations(
        image=np.repeat(np.arange(len(images)), [len(image.segments) for image in images]).astype(np.int64),
        index=np.concatenate([np.zeros(0, np.int64), *(np.arange(len(image.segments)) for image in images)]),
        x=placed[..., 0],
        y=placed[..., 1],
        weight=weight,
        basis=curves.basis * known[:, :, None],
        known=known,
        probability=np.concatenate([np.zeros(0), *(_probability(image) for image in images)]),
        roughness=roughness,
        points=counts.astype(np.float64),
        spacing=length / np.maximum(counts - 1, 1),
        length=length,
        middle=0.5 + middle / (width, height),
        direction=np.arctan2(chord[:, 1], chord[:, 0]) % np.pi,
        scale=scale,
    )
    usable = (counts >= FEWEST_FILLED) & (filled_bins >= FEWEST_FILLED)
    return observations.select(usable & ~outside & (length >= SHORTEST) & (observations.probability > 0))


def observe_distinct(images: Sequence[LabelledImage], width: int, height: int) -> LineObservations:
    """Bin the lines of one camera's images as `observe` does, without copies of others."""
    observed = observe(images, width, height)
    first = np.cumsum([0, *(len(image.segments) for image in images)])
    return observed.select(~copies(images)[first[observed.image] + observed.index])


def structures_of(lines: LineObservations) -> NDArray[np.int64]:
    """Return the structure of the scene that each line is counted to, int64 ``(S,)`` from 0 to 7.

    Lying lines in four bands from top to bottom, upright ones in four from left to right: what lies side by side is
    often of one building, and bends alike if it does.
    """
    upright = np.abs(lines.direction - np.pi / 2) < np.pi / 4
    across = np.where(upright, lines.middle[:, 0], lines.middle[:, 1])
    return np.clip((across * BANDS).astype(np.int64), 0, BANDS - 1) + BANDS * upright


def _probability(image: LabelledImage) -> Array:
    if image.probability is None:
        return np.full(len(image.segments), KEPT)
    return np.clip(np.asarray(image.probability, np.float64), 0.0, KEPT)


class _Curves(NamedTuple):
    """A polynomial of degree 6, or of as many as bins allow, along each chord.

    Attributes:
        basis: float64 ``(S, 5, B)``, weight times the orthonormal polynomials of degree 2 to 6.
        center: float64 ``(S,)``, mean place along the chord.
        coefficients: float64 ``(S, 7)`` of Legendre polynomials of twice the way from there.
    """

    basis: Array
    center: Array
    coefficients: Array

    @classmethod
    def fitted(cls, t: Array, across: Array, weight: Array, filled: NDArray[np.int64]) -> _Curves:
        """Fit bins: an orthonormal basis under the weights is what a QR decomposition makes of weighted powers."""
        root = np.sqrt(weight)
        center = (weight * t).sum(1)
        powers = legvander(2 * (t - center[:, None]), int(DEGREES[-1])) * root[..., None]
        q, r = np.linalg.qr(powers)
        allowed = np.arange(powers.shape[2]) < filled[:, None]
        amplitudes = np.einsum("sbd,sb->sd", q, root * across) * allowed
        r = np.where(allowed[:, :, None] & allowed[:, None, :], r, np.eye(powers.shape[2]))
        coefficients = np.linalg.solve(r, amplitudes[..., None])[..., 0]
        basis = np.moveaxis(q[:, :, DEGREES], 2, 1) * root[:, None, :]
        return cls(basis, center, coefficients)

    def at(self, t: Array, row: NDArray[np.int64]) -> Array:
        """Return each point's height over its chord, for places ``(N,)`` on the chords of rows ``(N,)``."""
        powers = legvander(2 * (t - self.center[row]), int(DEGREES[-1]))
        return np.einsum("nd,nd->n", powers, self.coefficients[row])
