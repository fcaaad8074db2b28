"""From an image to scored candidates."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.errors import InvalidImage
from app.vision.intensity import to_eight_bit
from app.vision.parameters import DetectionParameters
from app.vision.scoring import LEAST_SCORE, measure_features, score
from app.vision.segments import Segments
from app.vision.selection import Selection
from app.vision.stages import Stages, run_stages
from app.vision.watch import Watch

LARGEST_IMAGE = 40_000_000
"""Pixels; an index of an edge point must fit in 32 bit."""
LARGEST_SIDE = 65_535
"""px; the rows kept at a time must stay a small part of an image, however low and wide it is."""
SMALLEST_SIDE = 3
"""px; a gradient needs a neighbour on either side."""

_LEAST_POINTS_PER_PX = 0.35


@dataclass(frozen=True, eq=False)
class Chosen:
    """Which of the segments found are returned, the best first.

    Attributes:
        index: int64 ``(S,)``, rows of the findings.
        features: What the score is made of, by name, float64 ``(S,)`` each.
        scores: float64 ``(S,)`` in [0, 1], falling.
    """

    index: NDArray[np.int64]
    features: dict[str, NDArray[np.float64]]
    scores: NDArray[np.float64]


def detect(
    gray: NDArray[Any],
    parameters: DetectionParameters | None = None,
    *,
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Segments:
    """Find straight or slightly bent edge-segments.

    Equalisation, directional Canny, sub-pixel position, chaining, splitting into arcs, merging, extension,
    de-duplication, scoring: each has its module and names its source there. Nothing is shared between calls, and most
    of the time is spent outside Python's lock, so several threads may detect at once. The memory taken meanwhile is
    18 to 20 bytes per pixel of a photo.

    Args:
        gray: ``(H, W)``, uint8, uint16 or floating point, up to 40 million pixels and 65,535 a side; see `to_eight_bit`
            for the range.
        parameters: What to keep; the defaults where left out.
        progress: Told the share of the work that is done: rising, from 0 to 1. What it raises ends the detection.
        cancelled: Asked now and then; True ends the detection. What it raises does so too.

    Returns:
        Segments of measured sub-pixel points in order, gaps left without points, each at least ``min_length`` from
        end to end, with scores in [0, 1]; the best come first.

    Raises:
        InvalidImage: On another rank or dtype, no or too many pixels, or values that aren't finite.
        Cancelled: If `cancelled` says so.
        BrokenInstallation: If the compiled kernels are missing.
    """
    watch = Watch(progress, cancelled)
    eight_bit = check_image(gray)
    if min(eight_bit.shape) < SMALLEST_SIDE:
        watch.tell(1)
        return Segments.empty()
    parameters = parameters or DetectionParameters()
    stages = run_stages(eight_bit, parameters, watch)
    return segments_of(stages, choose(stages.selection, parameters))


def check_image(gray: NDArray[Any]) -> NDArray[np.uint8]:
    """Return a grey image as contiguous uint8 ``(H, W)``.

    Raises:
        InvalidImage: On another rank or dtype, no or too many pixels, or values that aren't finite.
    """
    if not isinstance(gray, np.ndarray) or gray.ndim != 2:
        shape = getattr(gray, "shape", type(gray).__name__)
        raise InvalidImage(f"a grey image has two dimensions, not {shape}", expected="(H, W)")
    if gray.size > LARGEST_IMAGE:
        raise InvalidImage(
            f"{gray.shape[1]} x {gray.shape[0]} pixels are too many",
            expected=f"at most {LARGEST_IMAGE // 10**6} million",
        )
    if max(gray.shape) > LARGEST_SIDE:
        raise InvalidImage(
            f"a side of {max(gray.shape)} pixels is too long", expected=f"at most {LARGEST_SIDE} px wide and high"
        )
    return np.ascontiguousarray(to_eight_bit(gray))


def choose(selection: Selection, parameters: DetectionParameters) -> Chosen:
    """Choose the segments that are long, supported and likely enough, and order them by score."""
    findings, points = selection.findings, selection.points
    span = points[findings["last"] - 1].astype(np.float64) - points[findings["first"]]
    chord = np.hypot(span[:, 0], span[:, 1])
    long = np.flatnonzero((chord >= parameters.min_length) & (findings["hits"] >= _LEAST_POINTS_PER_PX * chord))
    features = measure_features(findings[long])
    scores = score(features)
    order = np.argsort(-scores, kind="stable")
    order = order[scores[order] >= LEAST_SCORE[parameters.operating_point]]
    return Chosen(long[order], {name: values[order] for name, values in features.items()}, scores[order])


def segments_of(stages: Stages, chosen: Chosen) -> Segments:
    """Return the chosen segments with their points and scores."""
    first, last = (stages.selection.findings[name][chosen.index] for name in ("first", "last"))
    counts = last - first
    offsets = np.zeros(len(counts) + 1, np.int64)
    np.cumsum(counts, out=offsets[1:])
    rows = np.arange(offsets[-1]) + np.repeat(first - offsets[:-1], counts)
    # a point as one number of 8 bytes: numpy moves these six times as fast as pairs
    points = np.take(stages.selection.points.view(np.complex64)[:, 0], rows).view(np.float32).reshape(-1, 2)
    return Segments(points, offsets, chosen.scores.astype(np.float32))
