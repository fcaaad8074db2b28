"""From an image to scored candidates."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.errors import InvalidImage
from app.vision.arcs import Arcs, concatenate, fit_arcs
from app.vision.chaining import chain
from app.vision.circle import moment_sums
from app.vision.duplicates import uncovered
from app.vision.edges import Gradient, edge_pixels, gradient
from app.vision.equalisation import equalise
from app.vision.extension import extend
from app.vision.filtering import LEAST_QUALITY, PAINT_WIDTH, qualities, scores
from app.vision.intensity import to_eight_bit
from app.vision.merging import FLIPPING, FOLLOWING, merge
from app.vision.parameters import DetectionParameters
from app.vision.segments import Segments
from app.vision.splitting import split
from app.vision.subpixel import EdgePoints, refine
from app.vision.tracing import Trace, trace

_LARGEST_IMAGE = 40_000_000
_POSITION_SIGMA = 1.0
# weaker edges than this neither support nor extend a segment
_WEAKEST_NORM = 25.0
_SIDE_DISTANCE = 3.0
_LEAST_POINTS_PER_PX = 0.35


def detect(gray: NDArray[Any], parameters: DetectionParameters | None = None) -> Segments:
    """Find straight or slightly bent edge-segments.

    Equalisation, directional Canny, sub-pixel position, chaining, splitting into arcs, merging, extension,
    de-duplication, filtering: each has its module and names its source there.

    Args:
        gray: ``(H, W)``, uint8, uint16 or floating point, up to 40 million pixels; see `to_eight_bit` for the range.
        parameters: What to keep; the defaults where left out.

    Returns:
        Segments of measured sub-pixel points in order, gaps left without points, each at least ``min_length`` from
        end to end, with scores in [0, 1]; the best come first.

    Raises:
        InvalidImage: On another rank or dtype, no or too many pixels, or values that aren't finite.
    """
    parameters = parameters or DetectionParameters()
    gray = _checked(gray)
    if min(gray.shape) < 3:
        return Segments.empty()
    equalised, along_x, along_y = _edge_points(gray, parameters)
    pieces = [_pieces(points, gray, parameters) for points in (along_x, along_y)]
    arcs = concatenate(pieces)
    arcs = merge(merge(arcs, equalised, FOLLOWING), equalised, FLIPPING)
    arcs = extend(arcs, (along_x, along_y))
    return _measure(arcs, (along_x, along_y), parameters, gray.shape)


def _checked(gray: NDArray[Any]) -> NDArray[np.uint8]:
    if not isinstance(gray, np.ndarray) or gray.ndim != 2:
        shape = getattr(gray, "shape", type(gray).__name__)
        raise InvalidImage(f"a grey image has two dimensions, not {shape}", expected="(H, W)")
    if gray.size > _LARGEST_IMAGE:
        raise InvalidImage(
            f"{gray.shape[1]} x {gray.shape[0]} pixels are too many",
            expected=f"at most {_LARGEST_IMAGE // 10**6} million",
        )
    return np.ascontiguousarray(to_eight_bit(gray))


def _edge_points(gray: NDArray[np.uint8], parameters: DetectionParameters) -> tuple[Gradient, EdgePoints, EdgePoints]:
    """Gradient of the equalised image, and the sub-pixel points of both passes, weak ones included."""
    equalised = gradient(equalise(gray, parameters.clahe_clip, parameters.clahe_tile), parameters.sigma)
    plain = gradient(gray, _POSITION_SIGMA)
    weakest = min(_WEAKEST_NORM, parameters.low_threshold)
    along_x, along_y = (refine(edge_pixels(equalised, weakest, axis), equalised, plain) for axis in (0, 1))
    return equalised, along_x, along_y


def _pieces(points: EdgePoints, gray: NDArray[np.uint8], parameters: DetectionParameters) -> Arcs:
    """Chains of one pass as arcs; those of a few px are kept, they are the glue of merging."""
    chains = chain(points, parameters.low_threshold, parameters.high_threshold)
    first, last = split(points.along[chains.rows].astype(np.float64), points.across[chains.rows], chains.offsets)
    counts = last - first
    offsets = np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)
    rows = chains.rows[np.arange(offsets[-1]) + np.repeat(first - offsets[:-1], counts)]
    positions = points.points(rows)
    origin, sums = moment_sums(positions, offsets)
    traits = _side_sums(points, rows, positions, offsets, gray)
    start, end = positions[offsets[:-1]], positions[offsets[1:] - 1]
    # directed so that the bright side is that of the normal
    forward = ((points.sign[rows[offsets[:-1]]] > 0) == (points.axis == 0))[:, None]
    return fit_arcs(origin, sums, traits, np.where(forward, start, end), np.where(forward, end, start))


def _side_sums(
    points: EdgePoints,
    rows: NDArray[np.int64],
    positions: NDArray[np.float64],
    offsets: NDArray[np.int64],
    gray: NDArray[np.uint8],
) -> NDArray[np.float64]:
    """Sums of the grey levels beside the points of each piece and of the gradient norm."""
    if len(offsets) < 2:
        return np.zeros((0, 3))
    height, width = gray.shape
    slope, sign = points.slope[rows], points.sign[rows]
    scale = _SIDE_DISTANCE * sign / np.sqrt(1 + slope * slope)
    step = np.stack([-slope * scale, scale] if points.axis == 0 else [scale, -slope * scale], axis=1)
    columns = []
    for side in (-1, 1):
        place = np.rint(positions + side * step).astype(np.int64)
        columns.append(gray[np.clip(place[:, 1], 0, height - 1), np.clip(place[:, 0], 0, width - 1)].astype(np.float64))
    columns.append(points.norm[rows].astype(np.float64))
    return np.add.reduceat(np.stack(columns, axis=1), offsets[:-1], axis=0)


def _measure(
    arcs: Arcs, passes: tuple[EdgePoints, EdgePoints], parameters: DetectionParameters, shape: tuple[int, int]
) -> Segments:
    """De-duplicate, filter and score arcs, and give them back as the points measured along them."""
    arcs = arcs.take(np.flatnonzero(arcs.lengths >= 0.5 * parameters.min_length))
    samples = trace(arcs, np.arange(len(arcs)), arcs.low, arcs.high, passes)
    bounds = samples.bounds(len(arcs))
    hits = np.bincount(samples.walk, weights=samples.hit, minlength=len(arcs))
    support = hits / np.maximum(np.diff(bounds), 1)
    width = PAINT_WIDTH[parameters.operating_point]
    samples = samples.take(uncovered(arcs, samples, arcs.lengths * support, width, shape))
    samples = _between_hits(samples, len(arcs))
    if not len(samples.u):
        return Segments.empty()

    first = np.flatnonzero(np.diff(samples.walk, prepend=-1))
    bounds = np.append(first, len(samples.u)).astype(np.int64)
    ends = samples.points[bounds[1:] - 1] - samples.points[bounds[:-1]]
    chords = np.hypot(ends[:, 0], ends[:, 1])
    hits = np.add.reduceat(samples.hit.astype(np.int64), bounds[:-1])
    quality = qualities(samples, bounds, np.maximum(chords, 1.0))
    kept = chords >= parameters.min_length
    kept &= quality >= LEAST_QUALITY[parameters.operating_point]
    kept &= hits >= _LEAST_POINTS_PER_PX * chords
    best = np.flatnonzero(kept)
    best = best[np.argsort(-quality[best], kind="stable")]
    polylines = [samples.points[bounds[i] : bounds[i + 1]][samples.hit[bounds[i] : bounds[i + 1]]] for i in best]
    return Segments.from_list(polylines, scores(quality[best]))


def _between_hits(samples: Trace, walks: int) -> Trace:
    """Cut samples before the first and after the last measured point of each walk."""
    first, last = np.full(walks, np.inf), np.full(walks, -np.inf)
    hit = samples.take(samples.hit)
    np.minimum.at(first, hit.walk, hit.u)
    np.maximum.at(last, hit.walk, hit.u)
    return samples.take((samples.u >= first[samples.walk]) & (samples.u <= last[samples.walk]))
