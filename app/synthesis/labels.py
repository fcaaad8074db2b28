"""Labels and distractors of a photo: the visible runs of straight edges, and of curves that are none."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import cv2
import numpy as np
from numpy.typing import NDArray

from app.synthesis.geometry import Drawing
from app.synthesis.projection import View
from app.synthesis.rasteriser import Picture
from app.synthesis.sampling import Samples, across, sample_edges
from app.synthesis.sensor import LensMap
from app.synthesis.visibility import contrasting, unhidden
from app.vision.segments import Segments

SHORTEST = 20.0  # px
_BRIDGE = 3  # samples; a shorter gap in an edge is no gap
_TWIN = 1.2  # px; of two edges this close one is a label
_PARALLEL = 0.12  # rad


@dataclass(frozen=True, eq=False)
class EdgeLabels:
    """Visible edges of a photo.

    Attributes:
        segments: One polyline per visible fragment, a point about every px.
        line_ids: Which edge of the street each fragment belongs to, int64 ``(S,)``.
        kinds: What that edge is, or why it isn't straight; one per fragment.
    """

    segments: Segments
    line_ids: NDArray[np.int64]
    kinds: tuple[str, ...]


def label_edges(
    drawing: Drawing, view: View, lens_map: LensMap, picture: Picture, photo: NDArray[np.float32]
) -> EdgeLabels:
    """Label the straight edges of a drawing that are visible in its photo (before noise), ``(H, W, 3)``."""
    starts = [chain.corners[:, :-1].reshape(-1, 3) for chain in drawing.chains]
    ends = [chain.corners[:, 1:].reshape(-1, 3) for chain in drawing.chains]
    kinds = [chain.kind for chain, start in zip(drawing.chains, starts, strict=True) for _ in range(len(start))]
    nothing = np.zeros((0, 3))
    samples = sample_edges(
        np.concatenate([nothing, *starts]), np.concatenate([nothing, *ends]), view, lens_map, SHORTEST
    )
    grey = np.asarray(cv2.cvtColor(photo, cv2.COLOR_RGB2GRAY), np.float32)
    runs = _visible_runs(samples, picture, grey)
    return _collect(_without_twins(runs, samples, grey.shape), samples, kinds)


def label_curves(
    drawing: Drawing, view: View, lens_map: LensMap, picture: Picture, photo: NDArray[np.float32]
) -> EdgeLabels:
    """Label what is visible of the curves of a drawing: edges that look like labels in part and are none."""
    curves = [curve.points for curve in drawing.curves]
    reasons = [curve.reason for curve in drawing.curves]
    nothing = np.zeros((0, 3))
    pieces = sample_edges(
        np.concatenate([nothing, *(points[:-1] for points in curves)]),
        np.concatenate([nothing, *(points[1:] for points in curves)]),
        view,
        lens_map,
        0.0,
    )
    curve_of_piece = np.repeat(np.arange(len(curves)), [len(points) - 1 for points in curves]).astype(np.int64)
    owners = curve_of_piece[pieces.owners]
    # where two pieces of a curve meet, both have a sample
    step = np.linalg.norm(np.diff(pieces.points, axis=0, prepend=np.inf), axis=1)
    fresh = (step > 0.3) | (np.diff(owners, prepend=-1) != 0)
    samples = Samples(pieces.points[fresh], pieces.places[fresh], pieces.inverse_depths[fresh], owners[fresh])
    grey = np.asarray(cv2.cvtColor(photo, cv2.COLOR_RGB2GRAY), np.float32)
    return _collect(_visible_runs(samples, picture, grey), samples, reasons)


def _collect(runs: list[tuple[int, int]], samples: Samples, kinds: list[str]) -> EdgeLabels:
    line_ids = np.array([samples.owners[first] for first, _ in runs], np.int64)
    polylines = [samples.points[first:last] for first, last in runs]
    return EdgeLabels(Segments.from_list(polylines), line_ids, tuple(kinds[int(line)] for line in line_ids))


def _visible_runs(samples: Samples, picture: Picture, grey: NDArray[np.float32]) -> list[tuple[int, int]]:
    """Stretches ``[first, last)`` of one edge that can be seen, at least `SHORTEST` px long."""
    height, width = grey.shape
    normals = across(samples.points, samples.owners)
    seen = unhidden(picture, samples.places, across(samples.places, samples.owners), samples.inverse_depths)
    seen &= contrasting(grey, samples.points, normals, samples.owners)
    seen &= ((samples.points >= 0) & (samples.points <= [width - 1, height - 1])).all(axis=1)
    breaks = np.flatnonzero(np.diff(samples.owners)) + 1
    borders = np.concatenate([[0], breaks, [len(seen)]])
    return [run for first, last in pairwise(borders) for run in _stretches(seen, first, last)]


def _stretches(seen: NDArray[np.bool_], first: int, last: int) -> Iterator[tuple[int, int]]:
    """Stretches of true values within ``[first, last)``, after bridging gaps of a few samples."""
    hits = np.flatnonzero(seen[first:last])
    if len(hits) <= SHORTEST / 2:
        return
    cuts = np.flatnonzero(np.diff(hits) > _BRIDGE + 1)
    begins, finishes = hits[np.append(0, cuts + 1)], hits[np.append(cuts, len(hits) - 1)]
    for begin, finish in zip(begins, finishes, strict=True):
        if finish - begin >= SHORTEST:
            yield int(first + begin), int(first + finish + 1)


def _without_twins(runs: list[tuple[int, int]], samples: Samples, shape: tuple[int, ...]) -> list[tuple[int, int]]:
    """Where edges coincide (a wall's foot and a pavement's end) keep the longest; the others lose what is covered."""
    pad = 2
    taken = np.full((shape[0] + 2 * pad, shape[1] + 2 * pad), -1, np.int64)
    around = np.stack(np.meshgrid([-1, 0, 1], [-1, 0, 1]), axis=-1).reshape(-1, 1, 2)
    normals = across(samples.points, samples.owners)
    cells = np.rint(samples.points).astype(np.int64) + pad
    kept: list[tuple[int, int]] = []
    for first, last in sorted(runs, key=lambda run: run[0] - run[1]):
        cell, normal = cells[first:last], normals[first:last]
        other = taken[cell[:, 1], cell[:, 0]]
        # unit normals of either sign: the cross product is the sine of the angle between the edges
        turn = np.abs(normal[:, 0] * normals[other, 1] - normal[:, 1] * normals[other, 0]) < _PARALLEL
        apart = np.abs(np.sum((samples.points[other] - samples.points[first:last]) * normal, axis=1)) < _TWIN
        for begin, finish in _stretches(~((other >= 0) & turn & apart), 0, last - first):
            kept.append((first + begin, first + finish))
            painted = cell[None, begin:finish] + around
            taken[painted[..., 1], painted[..., 0]] = np.arange(first + begin, first + finish)
    return sorted(kept)
