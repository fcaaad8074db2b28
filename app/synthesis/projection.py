"""From polygons in the street to polygons in an ideal pinhole picture, with their inverse depth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.synthesis.camera import Pose
from app.synthesis.geometry import Batch, Points, Texture, clip_convex

NEAR = 0.35  # m; nothing closer is drawn


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
class FlatPolygon:
    """One surface in the picture: box, edge functions ``(c, 3)``, inverse depth and how it is painted."""

    box: tuple[int, int, int, int]
    edges: NDArray[np.float32]
    plane: NDArray[np.float64]
    colour: NDArray[np.float32]
    texture: Texture | None
    opacity: float


def project(batches: list[Batch], view: View) -> list[list[FlatPolygon]]:
    """Project all polygons, those of equally many corners at once."""
    projected: list[list[FlatPolygon]] = [[] for _ in batches]
    for count in sorted({batch.corners.shape[1] for batch in batches}):
        chosen = [index for index, batch in enumerate(batches) if batch.corners.shape[1] == count]
        cameras = view.pose.to_camera(np.concatenate([batches[index].corners for index in chosen]))
        owners = np.repeat(chosen, [len(batches[index].corners) for index in chosen])
        places = np.concatenate([np.arange(len(batches[index].corners)) for index in chosen])
        depths = cameras[..., 2]
        whole = (depths >= NEAR).all(axis=1)
        partly = np.flatnonzero(~whole & (depths > NEAR).any(axis=1))
        found: list[tuple[int, tuple[NDArray, ...], int]] = []
        outlines = _outlines(cameras[whole], view)
        rows = np.flatnonzero(outlines[3])
        found += [(int(row), outlines, int(at)) for row, at in zip(np.flatnonzero(whole)[rows], rows, strict=True)]
        for row in partly:
            clipped = clip_convex(cameras[row], np.array([0.0, 0.0, 1.0]), NEAR)
            outline = _outlines(clipped[None], view) if len(clipped) >= 3 else None
            if outline is not None and outline[3][0]:
                found.append((int(row), outline, 0))
        for row, (boxes, edges, planes, _), at in sorted(found, key=lambda item: item[0]):
            batch, place = batches[owners[row]], places[row]
            lines = edges[at].copy()
            lines[:, 2] += batch.margin
            left, top, right, bottom = boxes[at].tolist()
            texture = batch.textures[place] if batch.textures is not None else None
            projected[owners[row]].append(
                FlatPolygon((left, top, right, bottom), lines, planes[at], batch.colours[place], texture, batch.opacity)
            )
    return projected


def _outlines(cameras: Points, view: View) -> tuple[NDArray[np.int64], NDArray[np.float32], Points, NDArray[np.bool_]]:
    """Boxes, edge functions, inverse-depth planes and visibility of polygons ``(n, c, 3)`` before the camera."""
    homogeneous = cameras @ view.matrix.T
    pixels = homogeneous[..., :2] / homogeneous[..., 2:]
    low = np.floor(pixels.min(axis=1) - 1.0).clip(-1, [view.width, view.height])
    high = np.ceil(pixels.max(axis=1) + 2.0).clip(0, [view.width, view.height])
    boxes = np.concatenate([low.clip(0), high], axis=1).astype(np.int64)

    following = np.roll(pixels, -1, axis=1)
    steps = following - pixels
    areas = np.sum(pixels[..., 0] * following[..., 1] - pixels[..., 1] * following[..., 0], axis=1) / 2
    # in units of the width that a pixel has across the edge: 1 along rows and columns, 1.41 along diagonals
    lengths = np.abs(steps).sum(axis=-1)
    turn = np.where(areas < 0, -1.0, 1.0)[:, None] / np.maximum(lengths, 1e-12)
    across = np.stack([-steps[..., 1] * turn, steps[..., 0] * turn], axis=-1)
    offsets = -np.sum(across * pixels, axis=-1)
    edges = np.concatenate([across, offsets[..., None]], axis=-1)
    edges[lengths < 1e-9] = [0.0, 0.0, 1e4]  # a corner given twice bounds nothing

    # Newell's normal: right for any planar polygon, whatever its first corners
    normals = np.cross(cameras, np.roll(cameras, -1, axis=1)).sum(axis=1)
    distances = np.sum(normals * cameras.mean(axis=1), axis=1)
    seen = (boxes[:, 2] > boxes[:, 0]) & (boxes[:, 3] > boxes[:, 1]) & (np.abs(areas) > 0.15)
    seen &= np.abs(distances) > 1e-9
    planes = normals @ np.linalg.inv(view.matrix) / np.where(seen, distances, 1.0)[:, None]
    return boxes, edges.astype(np.float32), planes, seen
