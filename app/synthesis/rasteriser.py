"""From surfaces to an ideal pinhole picture: painter's order, exact edges, and which surface each pixel shows.

Edges are antialiased by area, not by samples: a pixel's share of a half plane is its signed distance to the edge, in
units of the pixel's own width across that edge, plus one half and clipped to 0..1. So an edge lies where geometry
puts it, whatever the resolution; along rows, columns and diagonals, where all pixels share one error, it has none.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from app.synthesis.geometry import Drawing, Texture
from app.synthesis.projection import FlatPolygon, View, project

_TILE_ROWS = 64
_FLAT_AREA = 120  # px; a smaller surface shows no texture


@dataclass(frozen=True, eq=False)
class Picture:
    """What the rasteriser made.

    Attributes:
        colours: float32 ``(H, W, 3)``, red, green, blue in 0..255.
        surface: int32 ``(H, W)``: the surface that a pixel shows, 0 for the background.
        planes: float64 ``(n, 3)``: per surface the inverse depth ``a x + b y + c`` (1/m) at picture position x, y;
            row 0 (background) is 0.
    """

    colours: NDArray[np.float32]
    surface: NDArray[np.int32]
    planes: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Haze:
    """What air does to far colours: `colour` float32 ``(3,)`` takes over with 1 - exp(-depth / distance), in m."""

    colour: NDArray[np.float32]
    distance: float


def rasterise(drawing: Drawing, view: View, background: NDArray[np.float32], haze: Haze) -> Picture:
    """Paint a drawing over a background ``(H, W, 3)``; the background is left as it is."""
    # one plane per colour: numpy's inner loops then run along rows, not over three numbers
    colours = np.ascontiguousarray(np.moveaxis(background, 2, 0))
    surface = np.zeros((view.height, view.width), np.int32)
    planes = [np.zeros(3)]
    for batch, polygons in zip(drawing.batches, project(drawing.batches, view), strict=True):
        if batch.mode == "shadow":
            _darken(colours, polygons)
            continue
        for polygon in polygons:
            planes.append(polygon.plane)
            _paint(colours, surface, polygon, len(planes) - 1, view, haze)
    return Picture(np.ascontiguousarray(np.moveaxis(colours, 0, 2)), surface, np.array(planes))


def _coverage(polygon: FlatPolygon, x0: int, y0: int, x1: int, y1: int) -> NDArray[np.float32]:
    """Each pixel's share inside the polygon, float32 ``(y1 - y0, x1 - x0)``."""
    columns = np.arange(x0, x1, dtype=polygon.edges.dtype)
    rows = np.arange(y0, y1, dtype=polygon.edges.dtype)
    along = polygon.edges[:, :1] * columns
    down = polygon.edges[:, 1:2] * rows + (polygon.edges[:, 2:] + 0.5)
    # an edge that the whole box lies inside of costs nothing
    needed = np.flatnonzero(along.min(axis=1) + down.min(axis=1) < 1.0)
    if not needed.size:
        return np.ones((y1 - y0, x1 - x0), np.float32)
    cover = np.add.outer(down[needed[0]], along[needed[0]])
    for edge in needed[1:]:
        np.minimum(cover, np.add.outer(down[edge], along[edge]), out=cover)
    return np.clip(cover, 0.0, 1.0, out=cover).astype(np.float32, copy=False)


def _tiles(box: tuple[int, int, int, int]) -> list[tuple[int, int, int, int]]:
    x0, y0, x1, y1 = box
    return [(x0, top, x1, min(top + _TILE_ROWS, y1)) for top in range(y0, y1, _TILE_ROWS)]


def _paint(
    colours: NDArray[np.float32],
    surface: NDArray[np.int32],
    polygon: FlatPolygon,
    index: int,
    view: View,
    haze: Haze,
) -> None:
    textured = polygon.texture is not None
    if polygon.texture is not None and _area(polygon.box) < _FLAT_AREA:
        polygon, textured = _flattened(polygon, polygon.texture), False
    lookup = _texture_lookup(polygon.texture, view) if textured and polygon.texture is not None else None
    for x0, y0, x1, y1 in _tiles(polygon.box):
        cover = _coverage(polygon, x0, y0, x1, y1)
        inside = cover.max(axis=0)
        filled = np.flatnonzero(inside > 0)
        if not filled.size:
            continue
        if filled.size < 0.7 * len(inside):  # a slanted surface fills little of its box
            left, right = int(filled[0]), int(filled[-1]) + 1
            x0, x1, cover = x0 + left, x0 + right, cover[:, left:right]
        target = colours[:, y0:y1, x0:x1]
        paint: NDArray[np.float32] = polygon.colour[:, None, None]
        if polygon.texture is not None and lookup is not None:
            sampled = _sample_texture(polygon.texture.pixels, lookup, x0, y0, x1, y1)
            if sampled.ndim == 2:
                paint = paint * sampled
            else:
                planes = np.ascontiguousarray(np.moveaxis(sampled, 2, 0))
                paint = planes[:3]
                cover = cover * planes[3]
        if polygon.opacity < 1:
            cover = cover * np.float32(polygon.opacity)
        share = _share_of_haze(polygon, haze, x0, y0, x1, y1)
        change = paint + share * (haze.colour[:, None, None] - paint) - target
        change *= cover
        target += change
        np.copyto(surface[y0:y1, x0:x1], index, where=cover >= 0.5)


def _area(box: tuple[int, int, int, int]) -> int:
    return (box[2] - box[0]) * (box[3] - box[1])


def _flattened(polygon: FlatPolygon, texture: Texture) -> FlatPolygon:
    """A polygon too small for its picture to be seen, in the picture's middle colour."""
    middle = texture.pixels[texture.pixels.shape[0] // 2, texture.pixels.shape[1] // 2]
    if texture.pixels.ndim == 2:
        return replace(polygon, colour=polygon.colour * middle, texture=None)
    return replace(polygon, colour=middle[:3], opacity=polygon.opacity * float(middle[3]), texture=None)


def _sample_texture(
    pixels: NDArray[np.float32], lookup: NDArray[np.float64], x0: int, y0: int, x1: int, y1: int
) -> NDArray[np.float32]:
    shift = np.array([[1.0, 0, x0], [0, 1, y0], [0, 0, 1]])
    flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    size = (x1 - x0, y1 - y0)
    warped = cv2.warpPerspective(pixels, lookup @ shift, size, flags=flags, borderMode=cv2.BORDER_REFLECT)
    return np.asarray(warped, np.float32)


def _share_of_haze(polygon: FlatPolygon, haze: Haze, x0: int, y0: int, x1: int, y1: int) -> NDArray[np.float32]:
    """Share of the haze's colour in each pixel ``(h, w)``, or in all of them ``(1, 1)`` (Koschmieder 1924)."""
    a, b, c = polygon.plane
    corners = np.array([a * x + b * y + c for x in (x0, x1 - 1) for y in (y0, y1 - 1)])
    if (x1 - x0) * (y1 - y0) < 900 or corners.max() < 1.15 * corners.min():
        depth = 1 / max(float(corners.mean()), 1e-4)
        return np.array([[1 - np.exp(-depth / haze.distance)]], np.float32)
    columns = np.arange(x0, x1, dtype=np.float32) * np.float32(a * haze.distance)
    rows = np.arange(y0, y1, dtype=np.float32) * np.float32(b * haze.distance) + np.float32(c * haze.distance)
    inverse = np.maximum(np.add.outer(rows, columns), np.float32(1e-3))
    return 1 - np.exp(-1 / inverse)


def _texture_lookup(texture: Texture, view: View) -> NDArray[np.float64]:
    """The homography from picture positions to texture positions, float64 ``(3, 3)``."""
    rotation = view.pose.rotation
    axes = np.stack([rotation @ texture.across, rotation @ texture.down, view.pose.to_camera(texture.origin)], axis=1)
    return np.asarray(np.linalg.inv(view.matrix @ axes), np.float64)


def _darken(colours: NDArray[np.float32], polygons: list[FlatPolygon]) -> None:
    """Multiply the union of the polygons by their colour, so that where shadows overlap it isn't darker."""
    if not polygons:
        return
    boxes = np.array([polygon.box for polygon in polygons])
    left, top = boxes[:, :2].min(axis=0)
    right, bottom = boxes[:, 2:].max(axis=0)
    mask = np.zeros((bottom - top, right - left), np.float32)
    for polygon in polygons:
        for x0, y0, x1, y1 in _tiles(polygon.box):
            # shares are added, so that shadows which meet leave no seam
            mask[y0 - top : y1 - top, x0 - left : x1 - left] += _coverage(polygon, x0, y0, x1, y1)
    rows = np.flatnonzero(mask.any(axis=1))
    if rows.size:
        first, last = int(rows[0]), int(rows[-1]) + 1
        covered = np.minimum(mask[first:last], 1)
        for channel, factor in zip(colours, polygons[0].colour, strict=True):
            channel[top + first : top + last, left:right] *= 1 - covered * (1 - factor)
