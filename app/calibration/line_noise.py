"""How far the lines of a camera bend by their own: the law of amplitudes under the true lens.

Points of one line share the blur of the image and so err together; n of them are worth fewer. How many fewer isn't
assumed but read off: roughness is measured point by point, amplitudes of low degree are what the errors add up to, and
the ratio of both is the inflation. Beyond that, edges of real scenes bend a little, by a part that grows with their
length and that no number of points averages out, falling with the degree as of a slowly bending beam. Both are found by
maximum likelihood for each fit.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from app.calibration.line_loss import straight_loss
from app.calibration.observations import DEGREES, LineObservations

Array = NDArray[np.float64]

INFLATIONS = 0.3, 40.0
OWN_BENDS = 0.002, 0.6
"""px on a line of 100 px; the lower end stands for none."""
FREEDOMS = 2.5, 5.0, 12.0, 50.0
FIRST_GRID, FINER = 6, 4
"""Values of each that are tried, and how often a finer grid around the best follows."""
BEND_FALLS = (2 / DEGREES) ** 4.0
FLOOR = 0.01
"""px of roughness; less isn't believed, as of points that were computed rather than measured."""
UNKNOWN = 0.15
"""px of roughness where no line has points enough to tell it."""
OWN_WEIGHT = 12.0
"""Points that the camera's typical roughness counts for against a line's own."""
MOST_LINES = 500
"""Lines, evenly chosen, that the law is found from: three numbers need no more."""
REACH = 3.0
"""px; points nearer than this err together."""


class LineNoise(NamedTuple):
    """Law of a camera's amplitudes.

    Attributes:
        inflation: Variance of what adds up over a line, per variance expected of independent points.
        own_bend: px, standard deviation of degree 2 on a line of 100 px.
        freedom: Degrees of freedom of Student's law; few if lines differ much in how exact they are.
    """

    inflation: float
    own_bend: float
    freedom: float


def believed_roughness(lines: LineObservations) -> Array:
    """Return each line's roughness, drawn towards the camera's typical one the fewer points tell it, ``(S,)`` px."""
    told = np.isfinite(lines.roughness)
    if not told.any():
        return np.full(len(lines), UNKNOWN)
    typical = max(float(np.median(lines.roughness[told])), FLOOR)
    freedom = np.where(told, np.maximum(lines.points - 1 - DEGREES[-1], 0), 0.0)
    freedom = freedom * np.minimum(1.0, lines.spacing / REACH)
    own = np.where(told, lines.roughness, 0.0)
    return np.maximum(np.sqrt((OWN_WEIGHT * typical**2 + freedom * own**2) / (OWN_WEIGHT + freedom)), FLOOR)


def point_variance(lines: LineObservations) -> Array:
    """Return the variance of an amplitude were the points independent, ``(S,)`` px squared."""
    return believed_roughness(lines) ** 2 / lines.points


def variances(lines: LineObservations, noise: LineNoise) -> Array:
    """Return the variance of each amplitude, float64 ``(S, 5)`` px squared."""
    own = (noise.own_bend**2 * lines.length / 100)[:, None] * BEND_FALLS
    return noise.inflation * point_variance(lines)[:, None] + own


def estimate_noise(lines: LineObservations, bends: Array, straight: Array, leverage: Array) -> LineNoise:
    """Return the law that explains amplitudes best.

    Args:
        lines: The lines.
        bends: Amplitudes, float64 ``(S, 5)`` px.
        straight: float64 ``(S,)``, probability of being straight.
        leverage: float64 ``(S, 5)``, share of each amplitude that the fit took away.
    """
    if len(lines) > MOST_LINES:
        some = np.linspace(0, len(lines) - 1, MOST_LINES).astype(np.int64)
        lines, bends, straight, leverage = lines.select(some), bends[some], straight[some], leverage[some]
    squared = np.where(lines.known, bends**2 / np.maximum(1 - leverage, 0.1), 0.0)
    base = point_variance(lines)[:, None]
    bend = (lines.length / 100)[:, None] * BEND_FALLS

    def losses(inflation: float, own: float, freedoms: Sequence[float]) -> list[float]:
        variance = inflation * base + (own**2 if own > OWN_BENDS[0] * 1.0001 else 0.0) * bend
        ratio = (squared / variance).sum(1)
        return [float(straight @ straight_loss(lines.known, ratio, variance, freedom)) for freedom in freedoms]

    ranges = tuple((math.log(low), math.log(high)) for low, high in (INFLATIONS, OWN_BENDS))
    grids = [np.linspace(low, high, FIRST_GRID) for low, high in ranges]
    freedoms: Sequence[float] = FREEDOMS
    found = 0.0, 0.0, FREEDOMS[-1]
    for _ in range(1 + FINER):
        tried = [
            (loss, a, b, freedom)
            for a in grids[0]
            for b in grids[1]
            for loss, freedom in zip(losses(np.exp(a), np.exp(b), freedoms), freedoms, strict=True)
        ]
        found = min(tried)[1:]
        freedoms = found[2:]
        steps = [(grid[-1] - grid[0]) / (len(grid) - 1) for grid in grids]
        grids = [
            np.clip(at + step / 2 * np.array([-1, 0, 1]), *ends)
            for at, step, ends in zip(found, steps, ranges, strict=False)
        ]
    own = float(np.exp(found[1]))
    return LineNoise(float(np.exp(found[0])), own if own > OWN_BENDS[0] * 1.0001 else 0.0, found[2])
