"""Tracing an edge between clicked points: the live-wire's path, refined to the points that the pipeline measures.

The path is good to a pixel. A smooth curve is laid through it, and then through the measured edge points along it, with
those that lie off it weighted down (Huber, Annals of Mathematical Statistics 35(1), 1964); what is returned are these
points themselves.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import ArrayLike, NDArray

from app.errors import NoEdge
from app.vision.corridor import Corridor, corridor_between
from app.vision.division import Division
from app.vision.edges import EdgeMap
from app.vision.live_wire import Path, cheapest_path
from app.vision.measured_points import MeasuredPoints, measured_along
from app.vision.sampson import Lens, sampson_residuals
from app.vision.segments import Segments

Array = NDArray[np.float64]

DEFAULT_REACH = 8.0
"""px beside a clicked point that its edge may lie."""
LEAST_SUPPORT = 0.5
"""Share of the way that must have a measured point."""
FEWEST_POINTS = 8

# px from the curve within which points count: for the next fit, and at last, as for a candidate's points
_TOLERANCES, _OWN = (1.5, 1.5), 0.7
_HUBER, _HUBER_PATH = 0.2, 1.0
_ROUNDS = 4
_MOST_DEGREE = 6
# columns at an end, and how many of them must have a point, for the line to reach that far
_END_WINDOW, _END_HITS = 10, 6


@dataclass(frozen=True, eq=False)
class Trace:
    """An edge as traced.

    Attributes:
        points: float32 ``(n, 2)`` px, measured points in the order of the clicked ones.
        length: Arc length, px.
        residual: RMS distance in px of the points from a straight line of the scene.
    """

    points: NDArray[np.float32]
    length: float
    residual: float


def trace_edge(edges: EdgeMap, clicks: ArrayLike, *, lens: Lens | None = None, reach: float = DEFAULT_REACH) -> Trace:
    """Trace the edge between clicked points; the result is the same from either end.

    Args:
        edges: Of the image; see `app.vision.measured_points.edges_of_image`.
        clicks: float ``(k, 2)`` px, 2 to 20 points that follow each other along the edge and lie near it.
        lens: Under which the edge is straight; ``None`` where that isn't known.
        reach: px beside a clicked point that the edge may lie.

    Raises:
        InvalidInput: On points that make no line, or lie outside the image.
        NoEdge: When no edge runs between the points.
    """
    height, width = edges.gray.shape
    given = np.asarray(clicks, np.float64)
    # always worked on from the same end, so that no rounding tells one from the other
    turned = given.ndim == 2 and len(given) > 1 and tuple(given[-1]) < tuple(given[0])
    corridor = corridor_between(given[::-1] if turned else given, (width, height), reach=reach, lens=lens)
    measured = _refined(edges, corridor, cheapest_path(edges, corridor))
    hits = measured.hits(_OWN)
    chosen = _between_ends(hits)
    support = len(chosen) / max(len(hits), 1)
    if support < LEAST_SUPPORT or len(chosen) < FEWEST_POINTS:
        raise _no_edge(corridor, support)
    points = measured.points[chosen].astype(np.float32)
    return measured_trace(np.ascontiguousarray(points[::-1]) if turned else points, (width, height), lens)


def straight_line(clicks: ArrayLike, size: tuple[int, int], *, lens: Lens | None = None) -> Trace:
    """Return the line through clicked points as drawn, bent as the lens bends a straight line; a point for each px.

    Args:
        clicks: float ``(k, 2)`` px, 2 to 20 points that follow each other.
        size: Width and height of the image, px.
        lens: Of the image; ``None`` where it isn't known.

    Raises:
        InvalidInput: On points that make no line, or lie outside the image.
    """
    corridor = corridor_between(np.asarray(clicks, np.float64), size, reach=DEFAULT_REACH, lens=lens)
    even = np.linspace(0, corridor.length, int(np.ceil(corridor.length)) + 1)
    along = np.union1d(even, corridor.clicks[:, 0])
    points = corridor.places(along, corridor.middle(along))
    # a bend must not lead out of the image
    inside = np.clip(points, -0.5, np.array(size) - 0.5)
    return measured_trace(inside.astype(np.float32), size, lens)


def measured_trace(points: NDArray[np.float32], size: tuple[int, int], lens: Lens | None) -> Trace:
    """Return points ``(n, 2)`` px with their length, and their residual under the lens, or under none."""
    segments = Segments.from_list([points])
    residuals = sampson_residuals(segments, lens or Division(*size))
    return Trace(segments.points, float(segments.lengths()[0]), float(np.sqrt(np.mean(residuals**2))))


def _refined(edges: EdgeMap, corridor: Corridor, path: Path) -> MeasuredPoints:
    """Return what is measured along the curve that fits the measured points near the path best."""
    degree = min(len(corridor.clicks) + 1, _MOST_DEGREE)
    # a place without a gradient says nothing of where the edge is
    curve = _fitted(path.along, path.across, path.certainty**2 + 1e-3, degree, corridor.length, _HUBER_PATH)
    measured = _along_curve(edges, corridor, path, curve)
    for tolerance in _TOLERANCES:
        near = measured.hits(tolerance)
        if near.sum() < FEWEST_POINTS:
            break
        along, across = corridor.coordinates(measured.points[near]).T
        curve = _fitted(along, across, np.ones(len(along)), degree, corridor.length, _HUBER)
        measured = _along_curve(edges, corridor, path, curve)
    return measured


def _along_curve(edges: EdgeMap, corridor: Corridor, path: Path, curve: Array) -> MeasuredPoints:
    across = legendre.legvander(2 * path.along / corridor.length - 1, len(curve) - 1) @ curve
    measured = measured_along(edges, corridor.places(path.along, across))
    # a curve fitted to a part of the way may leave the corridor beyond it, and find another edge there
    places = corridor.coordinates(measured.points)
    along = np.clip(places[:, 0], 0, corridor.length)
    outside = np.abs(places[:, 1] - corridor.middle(along)) > corridor.half_width(along)
    return replace(measured, distance=np.where(outside, np.inf, measured.distance))


def _fitted(along: Array, across: Array, weights: Array, degree: int, length: float, scale: float) -> Array:
    """Return the Legendre coefficients of a polynomial, by least squares with Huber's weights beyond `scale` px."""
    design = legendre.legvander(2 * along / length - 1, degree)
    robust = weights
    coefficients = np.zeros(degree + 1)
    for _ in range(_ROUNDS):
        root = np.sqrt(robust)
        coefficients = np.linalg.lstsq(design * root[:, None], across * root, rcond=None)[0]
        off = np.abs(across - design @ coefficients)
        robust = weights * np.minimum(1, scale / np.maximum(off, 1e-9))
    return np.asarray(coefficients, np.float64)


def _between_ends(hits: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Return the hits from the first dense place to the last: a stray point beyond an end is none of the edge's."""
    if len(hits) < _END_WINDOW:
        return np.flatnonzero(hits)
    dense = np.flatnonzero(np.convolve(hits, np.ones(_END_WINDOW), "valid") >= _END_HITS)
    if not dense.size:
        return np.zeros(0, np.int64)
    chosen = np.flatnonzero(hits)
    return chosen[(chosen >= dense[0]) & (chosen < dense[-1] + _END_WINDOW)]


def _no_edge(corridor: Corridor, support: float) -> NoEdge:
    ends = corridor.places(corridor.clicks[[0, -1], 0], corridor.clicks[[0, -1], 1])
    (x0, y0), (x1, y1) = ends.round().astype(int).tolist()
    return NoEdge(
        "no edge runs between these points",
        where=f"from ({x0}, {y0}) to ({x1}, {y1})",
        expected=f"edge points on {LEAST_SUPPORT:.0%} of the way; there are some on {support:.0%}",
        hint="click closer to the edge, add a point in between, or keep the straight line as drawn",
        details={"support": round(support, 3)},
    )
