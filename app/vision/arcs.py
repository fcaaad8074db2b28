"""Circular arcs with a direction, the working form of a segment between chaining and output.

An arc is a record `ARC` of moment sums and of the circle fitted to them (Taubin, IEEE TPAMI 13(11), 1991), so that two
arcs are merged by adding nine numbers. Fields, in px:

* ``origin``, ``sums``: sums of 1, x, y, xx, xy, yy, xz, yz, zz over the points, about the origin, with z = xx + yy;
* ``traits``: sums of the grey level on the dark side, on the bright side, and of the gradient's norm;
* ``foot``, ``tangent``, ``bend``: point nearest the centroid, unit direction there, half the curvature, positive where
  the centre lies against the normal (the tangent turned from x towards y), on whose side the image is brighter;
* ``low``, ``high``: start and end, measured along the tangent from the foot; ``rms`` of the points' distances;
* ``first_piece``, ``last_piece``, ``first_join``, ``last_join``: what it was merged from, see `app.vision.merging`.

The circle is ``A z + B x + C y + D = 0`` about the points' centroid, with ``B^2 + C^2 - 4 A D = 1``; ``bend`` is A. Its
coefficients are the smallest eigenpair of ``T M T``, where M holds the moments of (z, x, y) divided by the points'
spread s, less 1 for zz, T is diag(1/2, 1, 1), and ``D = -A s^2``. No radius occurs, so a line is a case like any other;
a point's distance is ``2 F / (1 + sqrt(1 + 4 A F))``, F being the left side. Fewer than 24 points say nothing of a
curvature and get a line. Where the curvature would exceed 1 / 1000 px, more than an image of a straight edge has under
a usable lens, a parabola of just that curvature is fitted.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.vision.chaining import Runs
from app.vision.edges import EdgeMap
from app.vision.native.library import kernels
from app.vision.native.records import ARC, address, aligned


def fit_pieces(edges: EdgeMap, runs: tuple[Runs, Runs]) -> NDArray[Any]:
    """Fit an arc to each run of points of both passes.

    Args:
        edges: Of the image.
        runs: Of the pass along x and of that along y.

    Returns:
        `ARC` ``(2 n + 1,)``: the n pieces in front, numbered from 0 on, and room for merging them.
    """
    height, width = edges.gray.shape
    arcs = aligned(2 * sum(len(each) for each in runs) + 1, ARC)
    number = 0
    for axis, (own, points) in enumerate(zip(runs, edges.points, strict=True)):
        kernels().cl_pieces(
            *(address(points), axis, address(own.rows), address(own.bounds), len(own)),
            *(address(edges.gray), width, height),
            *(number, address(arcs[number:])),
        )
        number += len(own)
    return arcs


def positions(arcs: NDArray[Any], along: NDArray[np.float64]) -> NDArray[np.float64]:
    """Points of arcs at tangent coordinates.

    Args:
        arcs: `ARC` ``(n,)``.
        along: float64 ``(n,)`` px from the foot.

    Returns:
        float64 ``(n, 2)`` px.
    """
    sine = 2 * arcs["bend"] * along
    sagitta = -sine * along / (1 + np.sqrt(np.maximum(1 - sine * sine, 0)))
    tangent = arcs["tangent"]
    normal = np.stack([-tangent[:, 1], tangent[:, 0]], axis=1)
    return arcs["foot"] + along[:, None] * tangent + sagitta[:, None] * normal


def ends(arcs: NDArray[Any]) -> NDArray[np.float64]:
    """Start and end of arcs `ARC` ``(n,)``, float64 ``(n, 2, 2)`` px."""
    return np.stack([positions(arcs, arcs["low"]), positions(arcs, arcs["high"])], axis=1)


def project(arcs: NDArray[Any], points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Tangent coordinates in px, float64 ``(n,)``, at which arcs `ARC` ``(n,)`` are nearest to points ``(n, 2)``."""
    relative = points - arcs["foot"]
    tangent, bend = arcs["tangent"], arcs["bend"]
    u = (relative * tangent).sum(axis=1)
    v = tangent[:, 0] * relative[:, 1] - tangent[:, 1] * relative[:, 0]
    return u / np.sqrt(np.maximum(1 + 4 * bend * (bend * (u * u + v * v) + v), 1e-12))
