"""Circular arcs with a direction, the working form of a segment between chaining and output."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.vision.circle import fit_circles

# an image of a straight edge bends no more than this under a usable lens; 1 / px
LARGEST_CURVATURE = 1e-3
# fewer points say nothing about the curvature: a line is fitted
_POINTS_FOR_CURVATURE = 24


@dataclass(frozen=True, eq=False)
class Arcs:
    """Arcs fitted to edge points, directed so that the image is brighter on the side of `normal`.

    Attributes:
        origin: float64 ``(n, 2)`` px, what `sums` are about.
        sums: float64 ``(n, 9)``, moment sums of the points (see `app.vision.circle`).
        traits: float64 ``(n, 3)``, sums over the points: grey level on the dark side, on the bright side, norm of
            the equalised gradient.
        foot: float64 ``(n, 2)`` px, point of the arc nearest the centroid.
        tangent: float64 ``(n, 2)``, unit direction there.
        bend: float64 ``(n,)`` per px, half the curvature, positive where the arc's centre lies against `normal`.
        low: float64 ``(n,)`` px, start of the arc, measured along the tangent from the foot.
        high: float64 ``(n,)`` px, its end.
        rms: float64 ``(n,)`` px, root mean square distance of the points.
    """

    origin: NDArray[np.float64]
    sums: NDArray[np.float64]
    traits: NDArray[np.float64]
    foot: NDArray[np.float64]
    tangent: NDArray[np.float64]
    bend: NDArray[np.float64]
    low: NDArray[np.float64]
    high: NDArray[np.float64]
    rms: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.bend)

    @property
    def lengths(self) -> NDArray[np.float64]:
        """Length along the tangent in px, ``(n,)``."""
        return self.high - self.low

    @property
    def normal(self) -> NDArray[np.float64]:
        """Unit normal at the foot, ``(n, 2)``: the tangent turned by 90 degrees from x towards y."""
        return turn(self.tangent)

    def take(self, index: NDArray[Any]) -> Arcs:
        """Return the arcs chosen by a mask or by indices."""
        return Arcs(*(getattr(self, field.name)[index] for field in fields(self)))

    def positions(self, index: NDArray[Any] | slice, u: NDArray[np.float64]) -> NDArray[np.float64]:
        """Points of arcs ``index`` at tangent coordinates ``u``, ``(m, 2)`` px."""
        bend = self.bend[index]
        sagitta = -2 * bend * u * u / (1 + np.sqrt(np.maximum(1 - (2 * bend * u) ** 2, 0)))
        return self.foot[index] + u[:, None] * self.tangent[index] + sagitta[:, None] * self.normal[index]

    def directions(self, index: NDArray[Any] | slice, u: NDArray[np.float64]) -> NDArray[np.float64]:
        """Unit directions of arcs ``index`` at tangent coordinates ``u``, ``(m, 2)``."""
        sine = np.clip(-2 * self.bend[index] * u, -1, 1)
        return np.sqrt(1 - sine * sine)[:, None] * self.tangent[index] + sine[:, None] * self.normal[index]

    def project(
        self, index: NDArray[Any] | slice, points: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Tangent coordinates and signed distances in px of points ``(m, 2)`` on arcs ``index``."""
        return _project(self.foot[index], self.tangent[index], self.bend[index], points)


def fit_arcs(
    origin: NDArray[np.float64],
    sums: NDArray[np.float64],
    traits: NDArray[np.float64],
    start: NDArray[np.float64],
    end: NDArray[np.float64],
) -> Arcs:
    """Fit arcs to moments.

    Args:
        origin: float64 ``(n, 2)`` px.
        sums: float64 ``(n, 9)``.
        traits: float64 ``(n, 3)``.
        start: float64 ``(n, 2)`` px, where each arc begins; give the direction too.
        end: float64 ``(n, 2)`` px, where it ends.
    """
    limit = np.where(sums[:, 0] >= _POINTS_FOR_CURVATURE, LARGEST_CURVATURE, 0.0)
    circles = fit_circles(origin, sums, limit)
    A, B, C, D = circles.coefficients.T
    normal = np.stack([B, C], axis=1) / np.hypot(B, C)[:, None]
    foot = circles.centre - (2 * D / (1 + np.sqrt(np.maximum(1 + 4 * A * D, 0))))[:, None] * normal
    tangent = -turn(normal)
    side = np.where(((end - start) * tangent).sum(axis=1) < 0, -1.0, 1.0)
    tangent, bend = tangent * side[:, None], A * side
    low, _ = _project(foot, tangent, bend, start)
    high, _ = _project(foot, tangent, bend, end)
    return Arcs(origin, sums, traits, foot, tangent, bend, low, high, circles.rms)


def concatenate(parts: Iterable[Arcs]) -> Arcs:
    """Join sets of arcs in the order given; at least one set."""
    columns = zip(*([getattr(part, field.name) for field in fields(Arcs)] for part in parts), strict=True)
    return Arcs(*(np.concatenate(column) for column in columns))


def turn(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Turn vectors ``(n, 2)`` by 90 degrees from x towards y."""
    return np.stack([-vectors[:, 1], vectors[:, 0]], axis=1)


def _project(
    foot: NDArray[np.float64], tangent: NDArray[np.float64], bend: NDArray[np.float64], points: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    relative = points - foot
    along = (relative * tangent).sum(axis=1)
    across = (relative * turn(tangent)).sum(axis=1)
    F = bend * (along**2 + across**2) + across
    steepness = np.sqrt(np.maximum(1 + 4 * bend * F, 1e-12))
    return along / steepness, 2 * F / (1 + steepness)
