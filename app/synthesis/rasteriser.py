"""From surfaces to an ideal pinhole picture: painter's order, exact edges, and which surface each pixel shows.

Edges are antialiased by area, not by samples: a pixel's share of a half plane is its signed distance to the edge, in
units of the pixel's own width across that edge, plus one half and clipped to 0..1. So an edge lies where geometry
puts it, whatever the resolution; along rows, columns and diagonals, where all pixels share one error, it has none.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from app.synthesis.fragments import Fragments, cover_small
from app.synthesis.geometry import Drawing, Texture
from app.synthesis.projection import FlatPolygons, View, project

_TILE_ROWS = 128
_FLAT_AREA = 200  # px; a smaller surface shows no texture
_SMALL_AREA = 900  # px; a smaller surface has one depth in the haze
_LARGE_AREA = 3000  # px; from here on surfaces are painted row by row, whatever their depth
_ONE_DEPTH = 1.15  # greatest by smallest inverse depth of a surface that has one depth in the haze
_MOST = 0.5  # share of a pixel from which on it shows a surface


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
    polygons = project(drawing.batches, view)
    shadow = np.array([batch.mode == "shadow" for batch in drawing.batches], np.bool_)[polygons.batch]
    haze_shares = _haze_shares(polygons, haze)
    small = _small_surfaces(polygons, shadow, haze_shares, view.width, haze)
    lookups = _texture_lookups(polygons.textures, view)
    flat_colours, flat_surface = colours.reshape(3, -1), surface.reshape(-1)
    darkened = -1
    for index, (is_shadow, at) in enumerate(zip(shadow.tolist(), small.places.tolist(), strict=True)):
        if is_shadow:
            if polygons.batch[index] != darkened:
                darkened = int(polygons.batch[index])
                _darken(colours, [_one(polygons, i) for i in np.flatnonzero(polygons.batch == darkened).tolist()])
        elif at < 0:
            _paint(colours, surface, _one(polygons, index), index + 1, lookups[index], haze_shares[index], haze)
        else:
            first, last = small.fragments.offsets[at], small.fragments.offsets[at + 1]
            pixels, cover = small.fragments.pixels[first:last], small.fragments.cover[first:last]
            target = flat_colours[:, pixels]
            target += (small.colours[at] - target) * cover
            flat_colours[:, pixels] = target
            flat_surface[pixels[cover >= _MOST]] = index + 1
    planes = np.concatenate([np.zeros((1, 3)), polygons.planes])
    return Picture(np.ascontiguousarray(np.moveaxis(colours, 0, 2)), surface, planes)


@dataclass(frozen=True, eq=False)
class _SmallSurfaces:
    """Those of the P polygons that are small: places ``(P,)`` among them or -1, fragments and colours ``(S, 3, 1)``."""

    places: NDArray[np.int64]
    fragments: Fragments
    colours: NDArray[np.float32]


def _small_surfaces(
    polygons: FlatPolygons, shadow: NDArray[np.bool_], haze_shares: NDArray[np.float32], width: int, haze: Haze
) -> _SmallSurfaces:
    areas = np.prod(polygons.boxes[:, 2:] - polygons.boxes[:, :2], axis=1)
    textured = np.array([texture is not None for texture in polygons.textures], np.bool_)
    largest = np.where(textured, _FLAT_AREA, np.where(np.isnan(haze_shares), _SMALL_AREA, _LARGE_AREA))
    chosen = np.flatnonzero(~shadow & (areas < largest))
    places = np.full(len(areas), -1, np.int64)
    places[chosen] = np.arange(len(chosen))
    colours, opacities = polygons.colours[chosen], polygons.opacities[chosen]
    for row, index in enumerate(chosen):
        texture = polygons.textures[index]
        if texture is not None:
            colours[row], opacities[row] = _flattened(colours[row], float(opacities[row]), texture)
    boxes = polygons.boxes[chosen]
    colours += haze_shares[chosen, None] * (haze.colour - colours)
    edges = [polygons.edges[index] for index in chosen]
    return _SmallSurfaces(places, cover_small(boxes, edges, opacities, width), colours[..., None])


@dataclass(frozen=True, eq=False)
class _Surface:
    """One surface in the picture: box, edge functions ``(c, 3)``, inverse depth and how it is painted."""

    box: tuple[int, int, int, int]
    edges: NDArray[np.float32]
    plane: NDArray[np.float64]
    colour: NDArray[np.float32]
    texture: Texture | None
    opacity: float


def _one(polygons: FlatPolygons, index: int) -> _Surface:
    left, top, right, bottom = polygons.boxes[index].tolist()
    return _Surface(
        (left, top, right, bottom),
        polygons.edges[index],
        polygons.planes[index],
        polygons.colours[index],
        polygons.textures[index],
        float(polygons.opacities[index]),
    )


def _coverage(polygon: _Surface, x0: int, y0: int, x1: int, y1: int) -> NDArray[np.float32] | None:
    """Each pixel's share inside the polygon, float32 ``(y1 - y0, x1 - x0)``; nothing if all lie wholly inside."""
    columns = np.arange(x0, x1, dtype=polygon.edges.dtype)
    rows = np.arange(y0, y1, dtype=polygon.edges.dtype)
    along = polygon.edges[:, :1] * columns
    down = polygon.edges[:, 1:2] * rows + (polygon.edges[:, 2:] + 0.5)
    # an edge that the whole box lies inside of costs nothing
    needed = np.flatnonzero(along.min(axis=1) + down.min(axis=1) < 1.0)
    if not needed.size:
        return None
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
    polygon: _Surface,
    index: int,
    lookup: NDArray[np.float64],
    haze_share: np.float32,
    haze: Haze,
) -> None:
    one_depth, air = bool(np.isfinite(haze_share)), haze.colour[:, None, None]
    tone = polygon.colour[:, None, None].copy()
    if one_depth:
        tone += haze_share * (air - tone)
    for x0, y0, x1, y1 in _tiles(polygon.box):
        cover = _coverage(polygon, x0, y0, x1, y1)
        if cover is not None:
            filled = np.flatnonzero(cover.max(axis=0) > 0)
            if not filled.size:
                continue
            if filled.size < 0.7 * (x1 - x0):  # a slanted surface fills little of its box
                left, right = int(filled[0]), int(filled[-1]) + 1
                x0, x1, cover = x0 + left, x0 + right, cover[:, left:right]
        paint: NDArray[np.float32] = tone
        if polygon.texture is not None:
            sampled = _sample_texture(polygon.texture.pixels, lookup, x0, y0, x1, y1)
            if sampled.ndim == 3:
                planes = np.ascontiguousarray(np.moveaxis(sampled, 2, 0))
                paint, opacity = planes[:3], planes[3]
                cover = opacity if cover is None else cover * opacity
                if one_depth:
                    paint += haze_share * (air - paint)
            elif one_depth:
                paint = np.multiply(tone - haze_share * air, sampled, dtype=np.float32)
                paint += haze_share * air
            else:
                paint = tone * sampled
        if not one_depth:
            paint = np.multiply(paint - air, _clearness(polygon, haze, x0, y0, x1, y1), dtype=np.float32)
            paint += air
        if polygon.opacity < 1:
            cover = np.float32(polygon.opacity) * (np.ones((1, 1), np.float32) if cover is None else cover)
        _lay(colours[:, y0:y1, x0:x1], surface[y0:y1, x0:x1], paint, cover, index)


def _lay(
    target: NDArray[np.float32],
    surface: NDArray[np.int32],
    paint: NDArray[np.float32],
    cover: NDArray[np.float32] | None,
    index: int,
) -> None:
    """Mix paint ``(3, h, w)`` over a part of the picture by its share ``(h, w)`` of each pixel; all of it if none."""
    if cover is None:
        target[...] = paint
        surface[...] = index
        return
    change = paint - target
    change *= cover
    target += change
    np.copyto(surface, index, where=cover >= _MOST)


def _flattened(colour: NDArray[np.float32], opacity: float, texture: Texture) -> tuple[NDArray[np.float32], float]:
    """Colour and opacity of a surface too small for its picture to be seen: those of the picture's middle."""
    middle = texture.pixels[texture.pixels.shape[0] // 2, texture.pixels.shape[1] // 2]
    if texture.pixels.ndim == 2:
        return colour * middle, opacity
    return middle[:3], opacity * float(middle[3])


def _sample_texture(
    pixels: NDArray[np.float32], lookup: NDArray[np.float64], x0: int, y0: int, x1: int, y1: int
) -> NDArray[np.float32]:
    shift = np.array([[1.0, 0, x0], [0, 1, y0], [0, 0, 1]])
    flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    size = (x1 - x0, y1 - y0)
    warped = cv2.warpPerspective(pixels, lookup @ shift, size, flags=flags, borderMode=cv2.BORDER_REFLECT)
    return np.asarray(warped, np.float32)


def _haze_shares(polygons: FlatPolygons, haze: Haze) -> NDArray[np.float32]:
    """Share of the haze's colour in each of P surfaces that has one depth or is small, else NaN, ``(P,)``.

    Haze takes over exponentially with the depth (Koschmieder 1924).
    """
    x, y = polygons.boxes[:, [0, 2, 0, 2]], polygons.boxes[:, [1, 1, 3, 3]]
    a, b, c = polygons.planes.T[..., None]
    inverse = a * x + b * y + c
    sizes = (polygons.boxes[:, 2] - polygons.boxes[:, 0]) * (polygons.boxes[:, 3] - polygons.boxes[:, 1])
    share = 1 - np.exp(-1 / (np.maximum(inverse.mean(axis=1), 1e-4) * haze.distance))
    one_depth = (sizes < _SMALL_AREA) | (inverse.max(axis=1) < _ONE_DEPTH * inverse.min(axis=1))
    return np.where(one_depth, share, np.nan).astype(np.float32)


def _clearness(polygon: _Surface, haze: Haze, x0: int, y0: int, x1: int, y1: int) -> NDArray[np.float32]:
    """What haze leaves of the colour in each pixel ``(h, w)`` of a surface that reaches into the distance."""
    a, b, c = polygon.plane
    columns = np.arange(x0, x1, dtype=np.float32) * np.float32(a * haze.distance)
    rows = np.arange(y0, y1, dtype=np.float32) * np.float32(b * haze.distance) + np.float32(c * haze.distance)
    inverse = np.add.outer(rows, columns)
    np.maximum(inverse, np.float32(1e-3), out=inverse)
    np.divide(np.float32(-1), inverse, out=inverse)
    return np.exp(inverse, out=inverse)


def _texture_lookups(textures: list[Texture | None], view: View) -> NDArray[np.float64]:
    """The homographies from picture positions to texture positions, float64 ``(P, 3, 3)``; NaN without a texture."""
    lookups = np.full((len(textures), 3, 3), np.nan)
    there = [(index, texture) for index, texture in enumerate(textures) if texture is not None]
    if there:
        rotation = view.matrix @ view.pose.rotation
        axes = np.array([(each.across, each.down, each.origin - view.pose.position) for _, each in there])
        lookups[[index for index, _ in there]] = np.linalg.inv(np.swapaxes(axes @ rotation.T, 1, 2))
    return lookups


def _darken(colours: NDArray[np.float32], polygons: list[_Surface]) -> None:
    """Multiply the union of the polygons by their colour, so that where shadows overlap it isn't darker."""
    if not polygons:
        return
    boxes = np.array([polygon.box for polygon in polygons])
    left, top = boxes[:, :2].min(axis=0)
    right, bottom = boxes[:, 2:].max(axis=0)
    mask = np.zeros((bottom - top, right - left), np.float32)
    for polygon in polygons:
        for x0, y0, x1, y1 in _tiles(polygon.box):
            cover = _coverage(polygon, x0, y0, x1, y1)
            # shares are added, so that shadows which meet leave no seam
            mask[y0 - top : y1 - top, x0 - left : x1 - left] += 1.0 if cover is None else cover
    rows = np.flatnonzero(mask.any(axis=1))
    if rows.size:
        first, last = int(rows[0]), int(rows[-1]) + 1
        covered = np.minimum(mask[first:last], 1)
        for channel, factor in zip(colours, polygons[0].colour, strict=True):
            channel[top + first : top + last, left:right] *= 1 - covered * (1 - factor)
