"""What a scene is made of before it is seen: planar surfaces, straight edges and curves in street coordinates.

Street coordinates: x right, y down, z forward, in m; the road is y = 0, so heights are negative y.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

Points = NDArray[np.float64]
Colours = NDArray[np.float32]
Mode = Literal["paint", "shadow"]
_UP = np.array([0.0, -1.0, 0.0])


@dataclass(frozen=True, eq=False)
class Texture:
    """A picture on a plane in the street.

    Attributes:
        pixels: float32 ``(h, w)``: factors on the surface's colour; or ``(h, w, 4)``: red, green, blue (0..255) and
            opacity (0..1) in place of it.
        origin: Where the middle of the first texel lies, ``(3,)``.
        across: Step in the street from one texel to the next in a row, ``(3,)``.
        down: Step from one row to the next, ``(3,)``.
    """

    pixels: NDArray[np.float32]
    origin: Points
    across: Points
    down: Points


def texture_on(corners: Points, pixels: NDArray[np.float32]) -> Texture:
    """Stretch a picture over a parallelogram: corners ``(4, 3)`` top left, top right, bottom right, bottom left."""
    height, width = pixels.shape[:2]
    across, down = (corners[1] - corners[0]) / width, (corners[3] - corners[0]) / height
    return Texture(pixels, corners[0] + (across + down) / 2, across, down)


@dataclass(frozen=True, eq=False)
class Batch:
    """Convex planar polygons of one kind, painted in the order given.

    Attributes:
        corners: float64 ``(n, c, 3)``.
        colours: float32 ``(n, 3)``, red, green, blue in 0..255.
        textures: One for each polygon, or none.
        opacity: 0..1.
        margin: By how many px the polygons are drawn larger, so that a mesh of them has no seams.
        mode: `shadow` polygons darken what lies below them, each place once.
    """

    corners: Points
    colours: Colours
    textures: Sequence[Texture | None] | None = None
    opacity: float = 1.0
    margin: float = 0.0
    mode: Mode = "paint"


@dataclass(frozen=True, eq=False)
class Chain:
    """Straight edges that share corners ``(n, c, 3)``: from each corner to the next, each a line of its own."""

    corners: Points
    kind: str


@dataclass(frozen=True, eq=False)
class Curve:
    """A visible edge that is no label, as points ``(n, 3)``, and what it is: see `app.synthesis.distractors`."""

    points: Points
    kind: str


@dataclass(eq=False)
class Drawing:
    """A growing list of surfaces, in painting order, with the edges and curves that bound them."""

    batches: list[Batch] = field(default_factory=list)
    chains: list[Chain] = field(default_factory=list)
    curves: list[Curve] = field(default_factory=list)

    def paint(
        self,
        corners: Points,
        colours: ArrayLike,
        *,
        kind: str | None = None,
        textures: Sequence[Texture | None] | None = None,
        opacity: float = 1.0,
        margin: float = 0.0,
    ) -> None:
        """Paint polygons ``(n, c, 3)`` or one ``(c, 3)``; with a kind, their outlines are straight edges."""
        corners = np.asarray(corners, np.float64)
        corners = corners[None] if corners.ndim == 2 else corners
        if not len(corners):
            return
        tones = np.empty((len(corners), 3), np.float32)
        tones[:] = colours
        self.batches.append(Batch(corners, tones, textures, opacity, margin, "paint"))
        if kind is not None:
            self.outline(corners, kind)

    def shadow(self, polygons: Sequence[Points], factor: ArrayLike, *, outlined: bool = True) -> None:
        """Darken the union of planar polygons by a colour factor ``(3,)``; their outlines are distractors."""
        whole = [np.asarray(polygon, np.float64) for polygon in polygons if len(polygon) >= 3]
        if not whole:
            return
        most = max(len(polygon) for polygon in whole)
        # repeating the last corner makes the polygons of one length and changes no shape
        padded = np.stack([np.concatenate([p, np.repeat(p[-1:], most - len(p), axis=0)]) for p in whole])
        colours = np.broadcast_to(np.asarray(factor, np.float32), (len(padded), 3))
        self.batches.append(Batch(padded, colours, mode="shadow"))
        if outlined:
            self.shadow_outlines(whole)

    def shadow_outlines(self, polygons: Sequence[Points]) -> None:
        """Add the sides of shadows as distractors: each straight, and none an edge of a thing."""
        for polygon in polygons:
            for start, end in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
                self.curve(np.stack([start, end]), "shadow")

    def outline(self, corners: Points, kind: str) -> None:
        """Add the closed outlines of polygons ``(n, c, 3)`` as straight edges."""
        self.chains.append(Chain(np.concatenate([corners, corners[:, :1]], axis=1), kind))

    def lines(self, corners: Points, kind: str) -> None:
        """Add open chains of straight edges, ``(n, c, 3)``."""
        self.chains.append(Chain(np.asarray(corners, np.float64), kind))

    def curve(self, points: Points, kind: str) -> None:
        """Add a distractor: an edge that is no label, ``(n, 3)``."""
        self.curves.append(Curve(np.asarray(points, np.float64), kind))

    def extend(self, other: Drawing, turn: float = 0.0, about: Points | None = None) -> None:
        """Paint another drawing on top, turned to the right by `turn` rad about the upright through ``(3,)``."""
        if turn and about is not None:
            other = other._turned(turn, about)
        self.batches.extend(other.batches)
        self.chains.extend(other.chains)
        self.curves.extend(other.curves)

    def _turned(self, turn: float, about: Points) -> Drawing:
        rotation = turned_right(turn)

        def move(points: Points) -> Points:
            return (points - about) @ rotation.T + about

        def lay(texture: Texture | None) -> Texture | None:
            if texture is None:
                return None
            across, down = rotation @ texture.across, rotation @ texture.down
            return Texture(texture.pixels, move(texture.origin), across, down)

        return Drawing(
            [
                replace(
                    batch,
                    corners=move(batch.corners),
                    textures=None if batch.textures is None else [lay(texture) for texture in batch.textures],
                )
                for batch in self.batches
            ],
            [Chain(move(chain.corners), chain.kind) for chain in self.chains],
            [Curve(move(curve.points), curve.kind) for curve in self.curves],
        )


def turned_right(turn: float) -> Points:
    """The rotation ``(3, 3)`` by `turn` rad to the right, as seen from above."""
    cosine, sine = np.cos(turn), np.sin(turn)
    return np.array([[cosine, 0.0, sine], [0.0, 1.0, 0.0], [-sine, 0.0, cosine]])


@dataclass(frozen=True, eq=False)
class Panel:
    """An upright plane with coordinates of its own: u along it and v up from the ground, in m.

    Attributes:
        origin: Where u = v = 0 lies, ``(3,)``.
        along: Unit vector of u, horizontal, ``(3,)``.
        normal: Unit vector towards the street, ``(3,)``.
    """

    origin: Points
    along: Points
    normal: Points

    def point(self, u: ArrayLike, v: ArrayLike, out: ArrayLike = 0.0) -> Points:
        """The street point at (u, v), pushed out of the plane by `out` m; broadcasts to ``(..., 3)``."""
        u, v, out = (np.asarray(value, np.float64)[..., None] for value in (u, v, out))
        return self.origin + u * self.along + v * _UP + out * self.normal

    def rectangles(self, boxes: ArrayLike, out: ArrayLike = 0.0) -> Points:
        """Rectangles ``(n, 4)`` as u0, v0, u1, v1 to corners ``(n, 4, 3)``: (u0, v1), (u1, v1), (u1, v0), (u0, v0)."""
        boxes = np.asarray(boxes, np.float64).reshape(-1, 4)
        return self.point(boxes[:, [0, 2, 2, 0]], boxes[:, [3, 3, 1, 1]], np.reshape(out, (-1, 1)))

    def locate(self, point: Points) -> Points:
        """The u, v and distance from the plane of a street point ``(3,)``."""
        offset = point - self.origin
        return np.array([offset @ self.along, -offset[1], offset @ self.normal])


def clip_convex(polygon: Points, normal: Points, offset: float) -> Points:
    """The part of a convex polygon ``(c, 3)`` where ``normal . p >= offset`` (Sutherland and Hodgman 1974)."""
    if not len(polygon):
        return polygon
    height = polygon @ normal - offset
    kept: list[Points] = []
    for here, there, a, b in zip(polygon, np.roll(polygon, -1, 0), height, np.roll(height, -1), strict=True):
        if a >= 0:
            kept.append(here)
        if (a >= 0) != (b >= 0):
            kept.append(here + (there - here) * (a / (a - b)))
    return np.array(kept) if len(kept) >= 3 else np.zeros((0, 3))
