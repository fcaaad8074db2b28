"""From surfaces to an ideal pinhole picture: painter's order, exact edges, and which surface each pixel shows.

Edges are antialiased by area, not by samples: a pixel's share of a half plane is its signed distance to the edge, in
units of the pixel's own width across that edge, plus one half and clipped to 0..1. So an edge lies where geometry
puts it, whatever the resolution; along rows, columns and diagonals, where all pixels share one error, it has none.
The painting itself is done by a kernel (``painting.c``), row by row; here it is worked out what is painted how.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from app.synthesis.geometry import Drawing, Texture
from app.synthesis.projection import FlatPolygons, View, project
from app.vision.native.library import OUT_OF_MEMORY, kernels
from app.vision.native.records import SURFACE, TEXTURE, address

_FLAT_AREA = 200  # px; a smaller surface shows no texture
_SMALL_AREA = 900  # px; a smaller surface has one depth in the haze
_ONE_DEPTH = 1.15  # greatest by smallest inverse depth of a surface that has one depth in the haze
_OF_ITS_DEPTH = -1.0  # in place of a clearness


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
    """Paint a drawing over a background ``(3, H, W)``: red, green, blue; it is left as it is.

    Raises:
        ValueError: If the background isn't of the view's size, or a texture isn't one.
    """
    # one plane per colour: inner loops then run along rows, not over three numbers
    colours = np.array(background, np.float32, order="C")
    if colours.shape != (3, view.height, view.width):
        raise ValueError(f"a background of {background.shape} for a picture of {view.height} x {view.width} px")
    surface = np.zeros((view.height, view.width), np.int32)
    polygons = project(drawing.batches, view)
    shadow = np.array([batch.mode == "shadow" for batch in drawing.batches], np.bool_)[polygons.batch]
    surfaces, pictures = _surfaces(polygons, shadow, view, haze)
    textures = _textures(pictures)
    air = haze.colour.astype(np.float32)
    done = kernels().cl_paint(
        address(colours),
        address(surface),
        view.width,
        view.height,
        address(surfaces),
        len(surfaces),
        address(polygons.edges),
        address(textures),
        address(air),
    )
    if done == OUT_OF_MEMORY:
        raise MemoryError
    planes = np.concatenate([np.zeros((1, 3)), polygons.planes])
    return Picture(np.asarray(cv2.merge(list(colours)), np.float32), surface, planes)


def _surfaces(
    polygons: FlatPolygons, shadow: NDArray[np.bool_], view: View, haze: Haze
) -> tuple[NDArray[Any], list[NDArray[np.float32]]]:
    """The records of P polygons, and the pictures that these number."""
    made = np.zeros(len(polygons.batch), SURFACE)
    for column, side in enumerate(("left", "top", "right", "bottom")):
        made[side] = polygons.boxes[:, column]
    made["first_edge"], made["edges"] = polygons.first_edges, polygons.edge_counts
    made["colour"], made["opacity"] = polygons.colours, polygons.opacities
    made["nearness"] = polygons.planes * haze.distance
    made["clearness"] = _clearness(polygons, haze)
    made["shadow"] = np.where(shadow, polygons.batch, -1)
    made["texture"] = -1

    areas = np.prod(polygons.boxes[:, 2:] - polygons.boxes[:, :2], axis=1)
    pictures: list[NDArray[np.float32]] = []
    numbers: dict[int, int] = {}
    shown: list[tuple[int, Texture]] = []
    for index, texture in enumerate(polygons.textures):
        if texture is None:
            continue
        if areas[index] < _FLAT_AREA:
            colour, opacity = made["colour"][index], made["opacity"][index]
            made["colour"][index], made["opacity"][index] = _flattened(colour, opacity, texture)
            continue
        number = numbers.setdefault(id(texture.pixels), len(pictures))
        if number == len(pictures):
            pictures.append(texture.pixels)
        made["texture"][index] = number
        shown.append((index, texture))
    if shown:
        made["lookup"][[index for index, _ in shown]] = _lookups([texture for _, texture in shown], view)
    return made, pictures


def _flattened(
    colour: NDArray[np.float32], opacity: np.float32, texture: Texture
) -> tuple[NDArray[np.float32], np.float32]:
    """Colour and opacity of a surface too small for its picture to be seen: those of the picture's middle."""
    middle = texture.pixels[texture.pixels.shape[0] // 2, texture.pixels.shape[1] // 2]
    if texture.pixels.ndim == 2:
        return colour * middle, opacity
    return middle[:3], opacity * middle[3]


def _textures(pictures: list[NDArray[np.float32]]) -> NDArray[Any]:
    """The records of pictures; whoever holds them holds the pictures too.

    Raises:
        ValueError: If one isn't float32, contiguous, of 1 or 4 channels.
    """
    made = np.zeros(len(pictures), TEXTURE)
    for record, pixels in zip(made, pictures, strict=True):
        if pixels.dtype != np.float32 or not pixels.size or pixels.shape[2:] not in ((), (4,)):
            raise ValueError(f"no texture: {pixels.dtype} {pixels.shape}")
        height, width = pixels.shape[:2]
        record["texels"], record["width"], record["height"] = address(pixels), width, height
        record["channels"] = 1 if pixels.ndim == 2 else 4
    return made


def _lookups(textures: list[Texture], view: View) -> NDArray[np.float64]:
    """The homographies from picture positions to texture positions, float64 ``(n, 9)``."""
    rotation = view.matrix @ view.pose.rotation
    axes = np.array([(each.across, each.down, each.origin) for each in textures])
    axes[:, 2] -= view.pose.position
    return np.asarray(np.linalg.inv(np.swapaxes(axes @ rotation.T, 1, 2)), np.float64).reshape(-1, 9)


def _clearness(polygons: FlatPolygons, haze: Haze) -> NDArray[np.float64]:
    """What haze leaves of the colour of each surface that has one depth or is small, ``(P,)``; the others' depends.

    Haze takes over exponentially with the depth (Koschmieder 1924).
    """
    x, y = polygons.boxes[:, [0, 2, 0, 2]], polygons.boxes[:, [1, 1, 3, 3]]
    a, b, c = polygons.planes.T[..., None]
    inverse = a * x + b * y + c
    sizes = (polygons.boxes[:, 2] - polygons.boxes[:, 0]) * (polygons.boxes[:, 3] - polygons.boxes[:, 1])
    clearness = np.exp(-1 / (np.maximum(inverse.mean(axis=1), 1e-4) * haze.distance))
    one_depth = (sizes < _SMALL_AREA) | (inverse.max(axis=1) < _ONE_DEPTH * inverse.min(axis=1))
    return np.where(one_depth, clearness, _OF_ITS_DEPTH)
