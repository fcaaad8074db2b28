"""Which samples of polylines run along which other polylines: near enough, and in the same direction.

A sample of a is *covered* by polyline b when the pieces of b next to its nearest sample of b pass within ``tau`` px
(edge included) and the tangents there differ by 15 degrees at most. Lines have no direction. Everything that protocol
clearlines-v2 measures is made of these pairs. Related: buffer matching of Heipke et al., "Evaluation of automatic road
extraction" (1997); sampled lines of Almazan et al., "MCMLSD" (CVPR 2017).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.evaluation.nearest_samples import Nearest, nearest_samples
from app.evaluation.resampling import Samples

TAU = 3.0
"""Greatest distance of lines that still count as one, px."""

MAXIMUM_TURN = float(np.radians(15.0))
"""Greatest angle between their tangents, rad."""

SLACK = 1e-9
"""A value that equals a limit but for rounding keeps to it."""


@dataclass(frozen=True, eq=False)
class Cover:
    """N times a sample of one set of polylines and a polyline of another set that covers it.

    Attributes:
        sample: int64 ``(N,)``, rows of the one set's samples.
        nearest: int64 ``(N,)``, rows of the other set's samples: the nearest one of the covering polyline.
        distance: float64 ``(N,)``, from the sample to the covering polyline, px.
    """

    sample: NDArray[np.int64]
    nearest: NDArray[np.int64]
    distance: NDArray[np.float64]

    def select(self, chosen: NDArray[np.bool_]) -> Cover:
        """Return the entries that a mask ``(N,)`` chooses."""
        return Cover(self.sample[chosen], self.nearest[chosen], self.distance[chosen])

    def within(self, tau: float) -> NDArray[np.bool_]:
        """Whether each entry is no further than ``tau`` px, bool ``(N,)``."""
        return self.distance <= tau + SLACK


def mutual_cover(a: Samples, b: Samples, tau: float = TAU, turn: float = MAXIMUM_TURN) -> tuple[Cover, Cover]:
    """Find which samples of a the polylines of b cover, and which samples of b the polylines of a cover.

    Only samples that lie near each other are looked at, so cost grows with their number, not with A times B.

    Args:
        a: A polylines.
        b: B polylines.
        tau: Greatest distance, px.
        turn: Greatest angle between tangents, rad.

    Returns:
        The cover of a's samples by b, and of b's samples by a.
    """
    covers_a, covers_b = [], []
    # no sample is further than half a step from the point of its polyline that is nearest
    reach = tau + max(a.largest_step, b.largest_step) / 2
    for of_a, of_b in nearest_samples(a, b, reach):
        covers_a.append(_cover(a, b, of_a, tau, turn))
        covers_b.append(_cover(b, a, of_b, tau, turn))
    return _joined(covers_a), _joined(covers_b)


def dot(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the scalar products of vectors ``(N, 2)``, float64 ``(N,)``."""
    return a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1]


def distance_to_pieces(points: NDArray[np.float64], b: Samples, nearest: NDArray[np.int64]) -> NDArray[np.float64]:
    """Return the distance of points ``(N, 2)`` to the pieces on both sides of their nearest sample ``(N,)``, px."""
    polyline = b.polyline[nearest]
    before = np.maximum(nearest - 1, b.offsets[polyline])
    after = np.minimum(nearest + 1, b.offsets[polyline + 1] - 1)
    corner = b.points[nearest]
    to_point = points - corner
    return np.sqrt(
        np.minimum(
            _squared_distance(to_point, b.points[before] - corner),
            _squared_distance(to_point, b.points[after] - corner),
        )
    )


def _cover(a: Samples, b: Samples, near: Nearest, tau: float, turn: float) -> Cover:
    """Return what covers the samples of a, given the nearest samples of every polyline of b around them."""
    sample, nearest = near.sample, near.nearest
    cosine = np.abs(dot(a.tangents[sample], b.tangents[nearest]))
    aligned = cosine >= np.cos(turn) - 1e-12
    sample, nearest = sample[aligned], nearest[aligned]
    distance = distance_to_pieces(a.points[sample], b, nearest)
    close = distance <= tau + SLACK
    return Cover(sample[close], nearest[close], distance[close])


def _squared_distance(to_point: NDArray[np.float64], piece: NDArray[np.float64]) -> NDArray[np.float64]:
    """Squared distance of points ``(N, 2)`` to pieces ``(N, 2)``, both relative to where the pieces begin, px^2."""
    square = dot(piece, piece)
    along = np.divide(dot(to_point, piece), square, out=np.zeros_like(square), where=square > 0)
    offset = to_point - np.clip(along, 0.0, 1.0)[:, None] * piece
    return dot(offset, offset)


def _joined(covers: list[Cover]) -> Cover:
    if not covers:
        return Cover(np.zeros(0, np.int64), np.zeros(0, np.int64), np.zeros(0))
    return Cover(
        np.concatenate([cover.sample for cover in covers]),
        np.concatenate([cover.nearest for cover in covers]),
        np.concatenate([cover.distance for cover in covers]),
    )
