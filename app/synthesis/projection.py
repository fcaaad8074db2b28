"""From polygons in the street to polygons in an ideal pinhole picture, with their inverse depth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.synthesis.camera import Pose
from app.synthesis.geometry import Batch, Points, Texture, clip_convex

NEAR = 0.35  # m; nothing closer is drawn
_LEAST_AREA = 0.15  # px


@dataclass(frozen=True, eq=False)
class View:
    """An ideal pinhole picture, wide enough for all that the lens sees.

    Attributes:
        pose: Where the camera stands.
        matrix: Pinhole matrix of the picture, float64 ``(3, 3)``, pixel centres at integers.
        width: Picture width in px.
        height: Picture height in px.
    """

    pose: Pose
    matrix: NDArray[np.float64]
    width: int
    height: int


@dataclass(frozen=True, eq=False)
class FlatPolygons:
    """P surfaces in the picture, in painting order.

    Attributes:
        batch: The batch each is of, int64 ``(P,)``, rising.
        boxes: int64 ``(P, 4)``: left, top, right, bottom; right and bottom are the first px beyond.
        edges: float64 ``(E, 3)``: edge functions, in px across the edge, positive inside; a polygon's own together.
        first_edges: Where those of each begin, int64 ``(P,)``.
        edge_counts: How many each has, int64 ``(P,)``.
        planes: float64 ``(P, 3)``: inverse depth ``a x + b y + c`` (1/m).
        colours: float32 ``(P, 3)``.
        opacities: float32 ``(P,)``.
        textures: P pictures, or nothing.
    """

    batch: NDArray[np.int64]
    boxes: NDArray[np.int64]
    edges: NDArray[np.float64]
    first_edges: NDArray[np.int64]
    edge_counts: NDArray[np.int64]
    planes: NDArray[np.float64]
    colours: NDArray[np.float32]
    opacities: NDArray[np.float32]
    textures: list[Texture | None]


@dataclass(frozen=True, eq=False)
class _Outlines:
    """Polygons of equally many corners: which of a batch they are, boxes, edge functions and planes."""

    batch: NDArray[np.int64]
    place: NDArray[np.int64]
    boxes: NDArray[np.int64]
    edges: NDArray[np.float64]
    planes: NDArray[np.float64]


def project(batches: list[Batch], view: View) -> FlatPolygons:
    """Project all polygons, those of equally many corners at once; what isn't in the picture is left out."""
    groups: list[_Outlines] = []
    cut: dict[int, list[tuple[Points, int, int]]] = {}
    sizes, counts = np.array([batch.corners.shape[:2] for batch in batches], np.int64).reshape(-1, 2).T
    for count in np.unique(counts):
        chosen = np.flatnonzero(counts == count)
        cameras = view.pose.to_camera(np.concatenate([batches[index].corners for index in chosen.tolist()]))
        size = sizes[chosen]
        owners = np.repeat(chosen, size)
        places = np.arange(len(owners)) - np.repeat(np.cumsum(size) - size, size)
        depths = cameras[..., 2]
        whole = (depths >= NEAR).all(axis=1)
        groups.append(_outlines(cameras[whole], owners[whole], places[whole], view))
        for row in np.flatnonzero(~whole & (depths > NEAR).any(axis=1)):
            clipped = clip_convex(cameras[row], np.array([0.0, 0.0, 1.0]), NEAR)
            if len(clipped) >= 3:
                cut.setdefault(len(clipped), []).append((clipped, owners[row], places[row]))
    for several in cut.values():
        corners, owners, places = zip(*several, strict=True)
        groups.append(_outlines(np.stack(corners), np.array(owners), np.array(places), view))
    return _in_order(batches, groups)


def _in_order(batches: list[Batch], groups: list[_Outlines]) -> FlatPolygons:
    batch = np.concatenate([np.zeros(0, np.int64), *(group.batch for group in groups)])
    place = np.concatenate([np.zeros(0, np.int64), *(group.place for group in groups)])
    order = np.lexsort([place, batch])
    margins = np.array([each.margin for each in batches], np.float64)
    for group in groups:
        group.edges[..., 2] += margins[group.batch][:, None]
    edges = np.concatenate([np.zeros((0, 3)), *(group.edges.reshape(-1, 3) for group in groups)])
    counts = np.concatenate([np.zeros(0, np.int64), *(np.full(len(g.batch), g.edges.shape[1]) for g in groups)])
    boxes = np.concatenate([np.zeros((0, 4), np.int64), *(group.boxes for group in groups)])
    planes = np.concatenate([np.zeros((0, 3)), *(group.planes for group in groups)])
    batch, place = batch[order], place[order]
    starts = np.cumsum([0, *(len(each.colours) for each in batches)])
    colours = np.concatenate([np.zeros((0, 3), np.float32), *(each.colours for each in batches)])
    opacities = np.array([each.opacity for each in batches], np.float32)
    pictures = [each.textures for each in batches]
    textures = [
        None if several is None else several[at]
        for several, at in zip((pictures[index] for index in batch.tolist()), place.tolist(), strict=True)
    ]
    return FlatPolygons(
        batch=batch,
        boxes=boxes[order],
        edges=edges,
        first_edges=(np.cumsum(counts) - counts)[order],
        edge_counts=counts[order],
        planes=planes[order],
        colours=colours[starts[batch] + place],
        opacities=opacities[batch],
        textures=textures,
    )


def _outlines(cameras: Points, batch: NDArray[np.int64], place: NDArray[np.int64], view: View) -> _Outlines:
    """Boxes, edge functions and inverse-depth planes of the polygons ``(n, c, 3)`` before the camera that are seen."""
    homogeneous = cameras @ view.matrix.T
    pixels = homogeneous[..., :2] / homogeneous[..., 2:]
    low = np.floor(pixels.min(axis=1) - 1.0).clip(-1, [view.width, view.height])
    high = np.ceil(pixels.max(axis=1) + 2.0).clip(0, [view.width, view.height])
    boxes = np.concatenate([low.clip(0), high], axis=1).astype(np.int64)
    following = np.roll(pixels, -1, axis=1)
    areas = np.sum(pixels[..., 0] * following[..., 1] - pixels[..., 1] * following[..., 0], axis=1) / 2
    # Newell's normal: right for any planar polygon, whatever its first corners
    ahead = np.roll(cameras, -1, axis=1)
    normals = np.cross(cameras, ahead).sum(axis=1)
    distances = np.sum(normals * cameras.mean(axis=1), axis=1)
    seen = (boxes[:, 2] > boxes[:, 0]) & (boxes[:, 3] > boxes[:, 1]) & (np.abs(areas) > _LEAST_AREA)
    seen &= np.abs(distances) > 1e-9

    pixels, steps, areas = pixels[seen], (following - pixels)[seen], areas[seen]
    # in units of the width that a pixel has across the edge: 1 along rows and columns, 1.41 along diagonals
    lengths = np.abs(steps).sum(axis=-1)
    turn = np.where(areas < 0, -1.0, 1.0)[:, None] / np.maximum(lengths, 1e-12)
    across = np.stack([-steps[..., 1] * turn, steps[..., 0] * turn], axis=-1)
    offsets = -np.sum(across * pixels, axis=-1)
    edges = np.concatenate([across, offsets[..., None]], axis=-1)
    edges[lengths < 1e-9] = [0.0, 0.0, 1e4]  # a corner given twice bounds nothing
    planes = normals[seen] @ np.linalg.inv(view.matrix) / distances[seen, None]
    return _Outlines(batch[seen], place[seen], boxes[seen], edges, planes)
