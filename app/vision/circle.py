"""Circle fit after Taubin, in a form that holds for straight arcs.

Taubin, IEEE TPAMI 13(11), 1991. A circle is the zero set of ``F = A (x^2 + y^2) + B x + C y + D`` with
``B^2 + C^2 - 4 A D = 1``, which makes F a distance to first order and a line the ordinary case ``A = 0``; the usual
form by centre and radius overflows there. The fit needs nothing but moments up to the fourth order, and moments are
additive: joining two arcs costs the same however many points they have.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

# columns of the moment sums: 1, x, y, xx, xy, yy, xz, yz, zz with z = xx + yy
MOMENT_COUNT = 9


@dataclass(frozen=True, eq=False)
class Circles:
    """Circles or lines, each in coordinates about its own centre.

    Attributes:
        centre: float64 ``(n, 2)``, centroid of the points in px.
        coefficients: float64 ``(n, 4)``, A, B, C, D about the centroid; the signed curvature is ``2 A`` per px.
        rms: float64 ``(n,)``, root mean square distance of the points in px.
    """

    centre: NDArray[np.float64]
    coefficients: NDArray[np.float64]
    rms: NDArray[np.float64]


def moment_sums(
    points: NDArray[np.float64], offsets: NDArray[np.int64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Sum the moments of runs of points about a point of each run.

    Args:
        points: float64 ``(N, 2)`` px.
        offsets: int64 ``(n + 1,)``; run ``i`` is ``points[offsets[i]:offsets[i + 1]]``, not empty.

    Returns:
        Origins float64 ``(n, 2)`` and sums float64 ``(n, 9)`` of 1, x, y, xx, xy, yy, xz, yz, zz about them.
    """
    if len(offsets) < 2:
        return np.zeros((0, 2)), np.zeros((0, MOMENT_COUNT))
    origin = points[(offsets[:-1] + offsets[1:]) // 2]
    x, y = (points - np.repeat(origin, np.diff(offsets), axis=0)).T
    z = x * x + y * y
    terms = np.stack([np.ones_like(x), x, y, x * x, x * y, y * y, x * z, y * z, z * z], axis=1)
    return origin, np.add.reduceat(terms, offsets[:-1], axis=0)


def shift_sums(sums: NDArray[np.float64], by: NDArray[np.float64]) -> NDArray[np.float64]:
    """Moment sums ``(n, 9)`` about origins moved by ``by`` ``(n, 2)`` px (binomial expansion)."""
    n, sx, sy, sxx, sxy, syy, sxz, syz, szz = sums.T
    a, b = -by[:, 0], -by[:, 1]
    c = a * a + b * b
    sz = sxx + syy
    dot = a * sx + b * sy
    dot_x, dot_y = a * sxx + b * sxy, a * sxy + b * syy
    dot_z = a * sxz + b * syz
    z = sz + 2 * dot + c * n
    return np.stack(
        [
            n,
            sx + a * n,
            sy + b * n,
            sxx + 2 * a * sx + a * a * n,
            sxy + a * sy + b * sx + a * b * n,
            syy + 2 * b * sy + b * b * n,
            sxz + 2 * dot_x + c * sx + a * z,
            syz + 2 * dot_y + c * sy + b * z,
            szz + 4 * (a * dot_x + b * dot_y) + c * c * n + 4 * dot_z + 2 * c * sz + 4 * c * dot,
        ],
        axis=1,
    )


def fit_circles(
    origin: NDArray[np.float64], sums: NDArray[np.float64], largest_curvature: NDArray[np.float64] | float = np.inf
) -> Circles:
    """Fit circles to moments.

    With ``M`` the central moments divided by powers of ``s = sqrt(Mxx + Myy)`` and ``T = diag(1/2, 1, 1)``, the
    smallest eigenpair ``(eta, w)`` of ``T M T`` gives ``(A s, B, C) = T w`` and ``D = -A s^2``; the rms
    is ``s sqrt(eta)``.
    Where the curvature exceeds the limit, the best arc of that curvature is taken in its place.

    Args:
        origin: float64 ``(n, 2)`` px, what the sums are about.
        sums: float64 ``(n, 9)`` as of `moment_sums`.
        largest_curvature: Limit of the curvature per px, for all or ``(n,)``; 0 fits lines.
    """
    mean = sums[:, 1:3] / sums[:, :1]
    central = shift_sums(sums, mean)
    moments = central[:, 3:] / central[:, :1]
    limit = np.broadcast_to(np.asarray(largest_curvature, dtype=np.float64), len(sums))
    coefficients, rms = _bounded(moments, limit)
    free = np.flatnonzero((limit > 0) & (moments[:, 0] + moments[:, 2] > 0))
    taubin, residual = _taubin(moments[free])
    inside = np.abs(2 * taubin[:, 0]) <= limit[free]
    coefficients[free[inside]] = taubin[inside]
    rms[free[inside]] = residual[inside]
    return Circles(origin + mean, coefficients, rms)


def distances(coefficients: NDArray[np.float64], points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Signed distances in px of points to circles, ``2 F / (1 + sqrt(1 + 4 A F))``: stable for any radius.

    Args:
        coefficients: float64 ``(..., 4)``, A, B, C, D.
        points: float64 ``(..., 2)`` about the same origin.
    """
    A, B, C, D = np.moveaxis(coefficients, -1, 0)
    x, y = np.moveaxis(points, -1, 0)
    F = A * (x * x + y * y) + B * x + C * y + D
    return 2 * F / (1 + np.sqrt(np.maximum(1 + 4 * A * F, 0)))


def _taubin(moments: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    xx, xy, yy, xz, yz, zz = moments.T
    s = np.sqrt(xx + yy)
    M = np.empty((len(moments), 3, 3))
    M[:, 0, 0] = (zz / s**4 - 1) / 4
    M[:, 0, 1] = M[:, 1, 0] = xz / s**3 / 2
    M[:, 0, 2] = M[:, 2, 0] = yz / s**3 / 2
    M[:, 1, 1] = xx / s**2
    M[:, 1, 2] = M[:, 2, 1] = xy / s**2
    M[:, 2, 2] = yy / s**2
    eta, vectors = np.linalg.eigh(M)
    w = vectors[:, :, 0]
    A = w[:, 0] / 2 / s
    return np.stack([A, w[:, 1], w[:, 2], -A * s * s], axis=1), s * np.sqrt(np.maximum(eta[:, 0], 0))


def _bounded(
    moments: NDArray[np.float64], limit: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Parabola of at most the curvature ``limit`` over the principal axis, as a circle."""
    xx, xy, yy, xz, yz, zz = moments.T
    angle = 0.5 * np.arctan2(2 * xy, xx - yy)
    cos, sin = np.cos(angle), np.sin(angle)
    uu = xx * cos * cos + 2 * xy * cos * sin + yy * sin * sin
    vv = np.maximum(xx + yy - uu, 0)
    uz, vz = cos * xz + sin * yz, cos * yz - sin * xz
    spread = np.where(uu > 0, uu, 1)
    bend = np.maximum(zz - uu * uu - uz * uz / spread, 0)
    b = np.clip(np.where(bend > 0, vz / np.where(bend > 0, bend, 1), 0), -limit / 2, limit / 2)
    rms = np.sqrt(np.maximum(vv - 2 * b * vz + b * b * bend, 0))
    # v = h + c u + b u^2, so F = v - h - c u - b u^2
    h, c = -b * uu, -b * uz / spread
    raw = np.stack([-b, -c * cos - sin, -c * sin + cos, -h], axis=1)
    scale = np.sqrt(raw[:, 1] ** 2 + raw[:, 2] ** 2 - 4 * raw[:, 0] * raw[:, 3])
    return raw / scale[:, None], rms
