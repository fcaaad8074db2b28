"""Labels and distractors of a photo: the visible runs of straight edges, and of curves that are none."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from app.synthesis.geometry import Drawing
from app.synthesis.projection import View
from app.synthesis.rasteriser import Picture
from app.synthesis.sampling import Samples, across, sample_edges
from app.synthesis.sensor import LensMap
from app.synthesis.visibility import CLEAR_STEP, FAINT_STEP, REACH, contrast, unhidden
from app.vision.segments import Segments

SHORTEST = 20.0  # px
_BRIDGE = 3  # samples; a shorter gap in an edge is no gap
_TWIN = 1.2  # px; of two edges this close one is a label
_PARALLEL = 0.12  # rad
_CLEAR_SHARE = 0.5


@dataclass(frozen=True, eq=False)
class EdgeLabels:
    """Visible edges of a photo.

    Attributes:
        segments: One polyline per visible fragment, a point about every px.
        line_ids: Which edge of the drawing each fragment belongs to, int64 ``(S,)``; fragments of one share it.
        kinds: What that edge is; one per fragment.
        clear: bool ``(S,)``: whether at least half of a fragment has a clear step of grey, else it is faint.
    """

    segments: Segments
    line_ids: NDArray[np.int64]
    kinds: tuple[str, ...]
    clear: NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class _Sight:
    """Samples of edges, their normals, and for each whether it can be seen at all and clearly, bool ``(n,)``."""

    samples: Samples
    normals: NDArray[np.float64]
    seen: NDArray[np.bool_]
    clear: NDArray[np.bool_]


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
    sight = _look(samples, picture, photo)
    runs = _visible_runs(sight.seen, samples.owners)
    return _collect(_without_twins(runs, sight, photo.shape), sight, kinds)


def label_curves(
    drawing: Drawing,
    view: View,
    lens_map: LensMap,
    picture: Picture,
    photo: NDArray[np.float32],
    labels: EdgeLabels | None = None,
) -> EdgeLabels:
    """Label what is visible of the curves of a drawing: edges that look like labels in part and are none.

    Where a curve lies on a label (a shadow along the wall that casts it), it is left out.
    """
    curves = [curve.points for curve in drawing.curves]
    kinds = [curve.kind for curve in drawing.curves]
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
    step_x, step_y = np.diff(pieces.points.T, prepend=np.inf)
    fresh = (step_x * step_x + step_y * step_y > 0.3**2) | (np.diff(owners, prepend=-1) != 0)
    samples = Samples(pieces.points[fresh], pieces.places[fresh], pieces.inverse_depths[fresh], owners[fresh])
    sight = _look(samples, picture, photo)
    seen = sight.seen
    if labels is not None:
        seen = seen & ~_on_labels(sight, labels.segments, photo.shape)
    return _collect(_visible_runs(seen, samples.owners), sight, kinds)


def _collect(runs: list[tuple[int, int]], sight: _Sight, kinds: list[str]) -> EdgeLabels:
    line_ids = np.array([sight.samples.owners[first] for first, _ in runs], np.int64)
    polylines = [sight.samples.points[first:last] for first, last in runs]
    clear = np.array([sight.clear[first:last].mean() >= _CLEAR_SHARE for first, last in runs], np.bool_)
    return EdgeLabels(Segments.from_list(polylines), line_ids, tuple(kinds[int(line)] for line in line_ids), clear)


def _look(samples: Samples, picture: Picture, photo: NDArray[np.float32]) -> _Sight:
    height, width = photo.shape[:2]
    grey = np.asarray(cv2.cvtColor(photo, cv2.COLOR_RGB2GRAY), np.float32)
    normals = across(samples.points, samples.owners)
    seen = unhidden(picture, samples.places, across(samples.places, samples.owners), samples.inverse_depths)
    x, y = samples.points.T
    seen &= (x >= 0) & (x <= width - 1) & (y >= 0) & (y <= height - 1)
    step = np.zeros(len(seen), np.float32)
    # neighbours along an edge count, so what is looked at reaches a little beyond what is seen
    near = np.flatnonzero(np.convolve(seen, np.ones(2 * REACH + 1), "same") > 0) if len(seen) else np.zeros(0, np.int64)
    step[near] = contrast(grey, samples.points[near], normals[near], samples.owners[near])
    return _Sight(samples, normals, seen & (step >= FAINT_STEP), seen & (step >= CLEAR_STEP))


def _visible_runs(seen: NDArray[np.bool_], owners: NDArray[np.int64]) -> list[tuple[int, int]]:
    """Stretches ``[first, last)`` of one edge that can be seen, at least `SHORTEST` px long.

    Gaps of a few samples are bridged.
    """
    hits = np.flatnonzero(seen)
    if not len(hits):
        return []
    whose = owners[hits]
    cuts = np.flatnonzero((np.diff(hits) > _BRIDGE + 1) | (np.diff(whose) != 0))
    firsts, lasts = hits[np.append(0, cuts + 1)], hits[np.append(cuts, len(hits) - 1)]
    enough = np.bincount(whose)[owners[firsts]] > SHORTEST / 2
    kept = enough & (lasts - firsts >= SHORTEST)
    return list(zip(firsts[kept].tolist(), (lasts[kept] + 1).tolist(), strict=True))


def _on_labels(sight: _Sight, labels: Segments, shape: tuple[int, ...]) -> NDArray[np.bool_]:
    """Which samples lie on a label and run along it."""
    at = np.full((shape[0] + 2, shape[1] + 2), -1, np.int64)
    places = labels.points.astype(np.float64)
    normals = across(places, labels.segment_of_point)
    cells = np.rint(places).astype(np.int64) + 1
    for x in (-1, 0, 1):
        for y in (-1, 0, 1):
            at[(cells[:, 1] + y).clip(0, shape[0] + 1), (cells[:, 0] + x).clip(0, shape[1] + 1)] = np.arange(len(cells))
    here = (np.rint(sight.samples.points).astype(np.int64) + 1).clip(0, [shape[1] + 1, shape[0] + 1])
    other = at[here[:, 1], here[:, 0]]
    if not len(normals):
        return np.zeros(len(other), np.bool_)
    turn = sight.normals[:, 0] * normals[other, 1] - sight.normals[:, 1] * normals[other, 0]
    return (other >= 0) & (np.abs(turn) < _PARALLEL)


def _without_twins(runs: list[tuple[int, int]], sight: _Sight, shape: tuple[int, ...]) -> list[tuple[int, int]]:
    """Where edges coincide (a wall's foot and a pavement's end) keep the longest; the others lose what is covered."""
    pad = 2
    wide = shape[1] + 2 * pad
    taken = np.full((shape[0] + 2 * pad) * wide, -1, np.int64)
    around = (np.array([[-1], [0], [1]]) * wide + np.array([-1, 0, 1])).reshape(-1, 1)
    points, normals = sight.samples.points, sight.normals
    columns, rows = np.rint(points).astype(np.int64).T + pad
    cells = rows * wide + columns
    kept: list[tuple[int, int]] = []
    for first, last in sorted(runs, key=lambda run: run[0] - run[1]):
        cell = cells[first:last]
        other = taken[cell]
        stretches = [(first, last)]
        if other.max() >= 0:
            normal = normals[first:last]
            # unit normals of either sign: the cross product is the sine of the angle between the edges
            turn = np.abs(normal[:, 0] * normals[other, 1] - normal[:, 1] * normals[other, 0])
            way = points[other] - points[first:last]
            apart = np.abs(way[:, 0] * normal[:, 0] + way[:, 1] * normal[:, 1])
            free = ~((other >= 0) & (turn < _PARALLEL) & (apart < _TWIN))
            whole = np.zeros(last - first, np.int64)
            stretches = [(first + begin, first + end) for begin, end in _visible_runs(free, whole)]
        for begin, end in stretches:
            kept.append((begin, end))
            taken[cells[begin:end] + around] = np.arange(begin, end)
    return sorted(kept)
