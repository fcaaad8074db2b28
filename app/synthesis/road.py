"""The ground: carriageway, pavements with kerbs, lane markings, tram rails and what the sun leaves dark."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from app.synthesis.bend import STRAIGHT, Bend
from app.synthesis.geometry import Drawing, Points, Texture, clip_convex
from app.synthesis.light import Colour, Light, rgb
from app.synthesis.textures import Materials, Pixels

KERB = 0.12  # m; height of the pavement above the road
_FAR, _BACK = 240.0, -6.0
END = 14.0  # m; from the street's end to the houses across it
_CORNER = 3.0  # radius of a kerb at a side street, m
_SHORT = 3.5  # m; a marking of this length is straight on a bend too
CURVED = {"lane marking": "curved lane marking", "parking bay": "curved lane marking", "rail": "curved rail"}
"""What straight markings become on a bend."""


@dataclass(frozen=True, eq=False)
class Road:
    """The plan of the ground, in m.

    Attributes:
        half_width: From the middle of the road to the kerbs.
        wall: From the middle to the houses.
        length: Where the street ends.
        gaps: Side streets: side (-1 left, 1 right), z0 and z1 between the houses' ends.
        marking: What is painted: "dashed", "double" or "tram".
        zebra: Where a zebra crossing begins (z), or nothing.
        parking: Sides with marked parking bays.
        turning: Side towards which a curved line leads at a gap, 0 for none.
        bend: The way that the plan's axis takes over the ground.
    """

    half_width: float
    wall: float
    length: float
    gaps: tuple[tuple[int, float, float], ...]
    marking: str
    zebra: float | None
    parking: tuple[int, ...]
    turning: int
    bend: Bend = STRAIGHT


def strip(x0: float, x1: float, z0: float, z1: float, height: float = 0.0, bend: Bend = STRAIGHT) -> Points:
    """A rectangle of the plan on the ground, ``(4, 3)``."""
    return bend.place([x0, x0, x1, x1], [z0, z1, z1, z0], height)


def draw_road(drawing: Drawing, road: Road, light: Light, materials: Materials) -> None:
    """Draw carriageway and markings; pavements follow after the road's shadows."""
    tarmac = light.shade(rgb(104, 105, 110), (0, -1, 0), sunlit=True)
    drawing.paint(strip(-160, 160, _BACK, _FAR), tarmac, textures=[_flat_texture(materials.road, 0.03)])
    paint = light.shade(rgb(232, 232, 226), (0, -1, 0))
    worn = [_flat_texture(materials.road, 0.02)]

    def mark(shapes: list[tuple[float, float, float, float]], kind: str, colour: Colour = paint) -> None:
        for x0, x1, z0, z1 in shapes:
            for begin, end, straight in road.bend.pieces(z0, z1):
                if straight or end - begin < _SHORT:
                    shape = strip(x0, x1, begin, end, bend=road.bend)
                    drawing.paint(shape, colour, kind=kind, textures=worn, opacity=0.9)
                else:
                    _draw_curved_strip(drawing, road.bend, (x0, x1, begin, end), colour, CURVED[kind])

    end = road.length
    if road.marking == "double":
        mark([(x, x + 0.12, _BACK, end) for x in (-0.2, 0.08)], "lane marking")
    else:
        starts = np.arange(_BACK + 1.3, end, 9.0 if road.marking == "dashed" else 6.0)
        if road.zebra is not None:
            starts = starts[np.abs(starts - road.zebra - 1.0) > 4.5]
        mark([(-0.07, 0.07, float(z), float(z) + 3.2) for z in starts], "lane marking")
    for side in (-1, 1):
        inner = road.half_width - (2.15 if side in road.parking else 0.3)
        crossings = sorted((g[1] - 2.5, g[2] + 2.5) for g in road.gaps if g[0] == side)
        for z0, z1 in _between(crossings, _BACK, end):
            mark([(side * inner - 0.06, side * inner + 0.06, z0, z1)], "lane marking")
            if side in road.parking:
                bays = np.arange(z0 + 1.5, z1, 6.0)
                if road.zebra is not None:
                    bays = bays[np.abs(bays - road.zebra - 1) > 3.5]
                edges = sorted((side * inner, side * (road.half_width - 0.02)))
                mark([(edges[0], edges[1], float(z), float(z) + 0.1) for z in bays], "parking bay")
    if road.zebra is not None:
        bars = np.arange(-road.half_width + 0.35, road.half_width - 0.5, 1.0)
        mark([(float(x), float(x) + 0.5, road.zebra, road.zebra + 3.2) for x in bars], "zebra crossing")
        mark([(0.15, road.half_width - 0.3, road.zebra - 1.6, road.zebra - 1.25)], "stop line")
    if road.marking == "tram":
        steel = light.shade(rgb(66, 68, 74), (0, -1, 0))
        for middle in (-1.75, 1.75):
            mark([(middle + s * 0.72 - 0.05, middle + s * 0.72 + 0.05, _BACK, end) for s in (-1, 1)], "rail", steel)
    for side, z0, z1 in road.gaps:
        if side == road.turning:
            _draw_turning_line(drawing, road, side, (z0 + z1) / 2, paint)


def _draw_curved_strip(
    drawing: Drawing, bend: Bend, shape: tuple[float, float, float, float], colour: Colour, kind: str
) -> None:
    x0, x1, z0, z1 = shape
    along = bend.steps(z0, z1)
    left, right = bend.place(x0, along), bend.place(x1, along)
    drawing.paint(np.stack([left[:-1], left[1:], right[1:], right[:-1]], axis=1), colour, margin=0.3, opacity=0.9)
    drawing.curve(left, kind)
    drawing.curve(right, kind)


def _draw_turning_line(drawing: Drawing, road: Road, side: int, z: float, paint: np.ndarray) -> None:
    """A guide line that curves into a side street: painted like the others, but not straight."""
    radius = road.half_width + 2.5
    turn = np.linspace(0, np.pi / 2, 19)
    bend = [
        road.bend.place(side * radius * (1 - np.cos(turn)) * 1.2 + side * 0.4, z - radius + r * np.sin(turn))
        for r in (radius - 0.07, radius + 0.07)
    ]
    pieces = [np.stack([bend[0][i], bend[0][i + 1], bend[1][i + 1], bend[1][i]]) for i in range(len(turn) - 1)]
    drawing.paint(np.array(pieces), paint, margin=0.3)
    for line in bend:
        drawing.curve(line, "curved lane marking")


def draw_pavements(drawing: Drawing, road: Road, light: Light, materials: Materials) -> None:
    """Draw the blocks of raised pavement between side streets, far ones first, with kerbs rounded at corners."""
    stone = rgb(176, 172, 166)
    ground = light.shade(rgb(160, 155, 148), (0, -1, 0))
    slabs = _flat_texture(materials.pavement, 0.035, KERB)
    across = strip(-90, 90, road.length + END - 3, road.length + END + 20, KERB, road.bend)
    kerb = np.stack([across[0], across[3], across[3] + [0, KERB, 0], across[0] + [0, KERB, 0]])
    drawing.paint(kerb, light.shade(stone * 0.82, (0, 0, -1)), kind="kerb")
    drawing.paint(across, ground)
    far = 90.0 if road.bend.curvature == 0 else road.wall + 15.0
    for side in (-1, 1):
        crossings = sorted((g[1] + 2.5, g[2] - 2.5) for g in road.gaps if g[0] == side)
        blocks = _between(crossings, _BACK, road.length + 2)
        for z0, z1 in reversed(blocks):
            x, z = _block_rim(side, road, z0, z1, (z0 > _BACK, True), far)
            rim = road.bend.place(x, z, KERB)
            foot = rim + np.array([0, KERB, 0])
            faces = np.stack([rim[:-1], rim[1:], foot[1:], foot[:-1]], axis=1)
            steps = rim[1:] - rim[:-1]
            facing = np.stack([-steps[:, 2] * side, np.zeros(len(steps)), steps[:, 0] * side], axis=1)
            facing /= np.maximum(np.linalg.norm(facing, axis=1, keepdims=True), 1e-9)
            drawing.paint(faces, light.shade(stone * 0.82, facing), margin=0.3)
            if road.bend.is_straight(z0, z1):
                top = np.concatenate([rim, road.bend.place([side * far, side * far], [z1, z0], KERB)])
                drawing.paint(top, ground, textures=[slabs])
            else:
                back = road.bend.place(side * far, z, KERB)
                tops = np.stack([rim[:-1], rim[1:], back[1:], back[:-1]], axis=1)
                drawing.paint(tops, ground, textures=[slabs] * len(tops), margin=0.5)
            inner = road.bend.place(x + side * 0.16, z, KERB)
            caps = np.stack([rim[:-1], rim[1:], inner[1:], inner[:-1]], axis=1)
            long = np.linalg.norm(steps, axis=1) > 2.0
            drawing.paint(caps[long], light.shade(stone * 1.08, (0, -1, 0)))
            for line in (rim, foot):
                drawing.lines(np.stack([line[:-1][long], line[1:][long]], axis=1), "kerb")
                for bend in np.split(np.arange(len(line)), np.flatnonzero(long) + 1):
                    if len(bend) > 3:
                        drawing.curve(line[bend], "curved kerb")
            drawing.lines(np.stack([inner[:-1][long], inner[1:][long]], axis=1), "kerb")


def _block_rim(
    side: int, road: Road, z0: float, z1: float, rounded: tuple[bool, bool], far: float
) -> tuple[Points, Points]:
    """The kerb line of a block from its far outer end along the road, as x ``(n,)`` and z ``(n,)`` of the plan."""
    turn = np.linspace(0, np.pi / 2, 13)
    x, middle = road.half_width, road.half_width + _CORNER
    first, last = z0 + _CORNER * rounded[0], z1 - _CORNER * rounded[1]
    along = road.bend.steps(first, last)
    parts_x, parts_z = [np.full(len(along), side * x)], [along]
    if rounded[0]:
        parts_x.insert(0, side * np.concatenate([[far], middle - _CORNER * np.sin(turn[:-1])]))
        parts_z.insert(0, np.concatenate([[z0], z0 + _CORNER * (1 - np.cos(turn[:-1]))]))
    if rounded[1]:
        parts_x.append(side * np.concatenate([middle - _CORNER * np.cos(turn[1:]), [far]]))
        parts_z.append(np.concatenate([z1 - _CORNER * (1 - np.sin(turn[1:])), [z1]]))
    return np.concatenate(parts_x), np.concatenate(parts_z)


def draw_shadows(drawing: Drawing, casters: list[Points], light: Light, height: float, road: Road) -> None:
    """Darken where upright polygons ``(c, 3)`` keep the sun from the ground at a height (0: road, KERB: pavement).

    Their edges are straight where those of the things are, and distractors all the same: they move with the sun. The
    sun counts as a point: there is no half-shadow.
    """
    if light.shadow is None:
        return
    cast = [shadow_of(caster, light, height) for caster in casters]
    if height == 0.0:
        drawing.shadow(cast, light.shadow)
        return
    for side in (-1, 1):
        if road.bend.curvature == 0:
            beside = np.array([float(side), 0.0, 0.0])
            drawing.shadow([clip_convex(p, beside, road.half_width) for p in cast], light.shadow, outlined=False)
            continue
        for cell in _pavement_cells(side, road):
            low, high = cell.min(axis=0), cell.max(axis=0)
            near = [p for p in cast if (p.max(axis=0) > low)[[0, 2]].all() and (p.min(axis=0) < high)[[0, 2]].all()]
            drawing.shadow([_clip_to(shape, cell) for shape in near], light.shadow, outlined=False)
    drawing.shadow_outlines(cast)


def _pavement_cells(side: int, road: Road) -> list[Points]:
    """Convex pieces of the ground beside the road that make up one pavement, ``(4, 3)`` each."""
    outer = road.wall + 15.0
    along = road.bend.steps(_BACK, road.length + 40.0, 5.0)
    return [strip(side * road.half_width, side * outer, z0, z1, KERB, road.bend) for z0, z1 in pairwise(along.tolist())]


def _clip_to(shape: Points, cell: Points) -> Points:
    """The part of a level convex polygon over a convex cell of the ground."""
    middle = cell.mean(axis=0)
    for start, end in zip(cell, np.roll(cell, -1, axis=0), strict=True):
        normal = np.array([end[2] - start[2], 0.0, start[0] - end[0]])
        normal *= np.sign(normal @ (middle - start))
        shape = clip_convex(shape, normal, float(normal @ start))
    return shape


def shadow_of(polygon: Points, light: Light, height: float = 0.0) -> Points:
    """A polygon's shadow on the level ground at a height, ``(c, 3)``."""
    above = -height - polygon[:, 1]
    shadow = polygon - above[:, None] / light.to_sun[1] * -light.to_sun
    shadow[:, 1] = -height
    return shadow


def _flat_texture(pixels: Pixels, step: float, height: float = 0.0) -> Texture:
    """A picture that lies on the ground, mirrored over and over; `step` m per texel."""
    return Texture(pixels, np.array([-8.0, -height, 0.0]), np.array([step, 0, 0]), np.array([0, 0, step]))


def _between(crossings: list[tuple[float, float]], start: float, end: float) -> list[tuple[float, float]]:
    """What crossings (z0, z1), in order, leave of the way from start to end."""
    pieces: list[tuple[float, float]] = []
    for z0, z1 in crossings:
        if z0 > start:
            pieces.append((start, min(z0, end)))
        start = max(start, z1)
    if start < end:
        pieces.append((start, end))
    return [piece for piece in pieces if piece[1] - piece[0] > 1.0]
