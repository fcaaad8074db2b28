"""Houses: wall, plinth, bands, windows floor by floor, cornice, roof and chimneys."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from app.synthesis.geometry import Drawing, Panel, Points, texture_on
from app.synthesis.ground_floor import draw_ground_floor
from app.synthesis.light import Colour, Light, rgb
from app.synthesis.noise import Pixels
from app.synthesis.textures import Materials
from app.synthesis.walls import on_wall
from app.synthesis.windows import WindowStyle, draw_ledges, draw_windows

HouseStyle = Literal["classical", "brick", "modern"]
FLAT_BEYOND = 36.0  # m; farther houses are drawn with fewer parts

WALLS: dict[HouseStyle, tuple[tuple[int, int, int], ...]] = {
    "classical": (
        (228, 212, 178), (219, 184, 132), (206, 148, 116), (196, 204, 196), (226, 222, 212),
        (214, 168, 152), (178, 194, 206), (232, 200, 150), (186, 196, 168),
    ),
    "brick": ((158, 92, 72), (142, 82, 66), (172, 112, 86), (120, 84, 72)),
    "modern": ((216, 214, 208), (150, 154, 158), (196, 186, 172), (112, 118, 124)),
}  # fmt: skip


@dataclass(frozen=True, eq=False)
class House:
    """One house of a row. Lengths in m, colours as painted.

    Attributes:
        panel: Its front; u = 0 is its end nearer to the start of the street.
        width: Length of the front.
        floors: Floors above the ground floor.
        ground_height: Height of the ground floor.
        floor_height: Height of each other floor.
        depth: How far it reaches back from the street.
        style: Which family of parts it is made of.
        wall: Colour of its wall.
        seed: Seed of everything small about it.
    """

    panel: Panel
    width: float
    floors: int
    ground_height: float
    floor_height: float
    depth: float
    style: HouseStyle
    wall: Colour
    seed: int

    @property
    def height(self) -> float:
        """Height of the front up to the eaves."""
        return self.ground_height + self.floors * self.floor_height


def draw_house(drawing: Drawing, house: House, *, eye: Points, light: Light, materials: Materials) -> None:
    """Draw a house as seen from `eye`; the same house is drawn the same from anywhere."""
    rng = np.random.default_rng(house.seed)
    panel, width, height = house.panel, house.width, house.height
    distance = float(np.linalg.norm(panel.point(0, 1.6) - eye))
    detailed = distance < FLAT_BEYOND
    trim = _trim_of(house, rng)
    _draw_chimneys(drawing, house, eye, light, rng)
    for near_end, u in ((True, 0.0), (False, width)):
        if (panel.locate(eye)[0] < 0) == near_end:
            _draw_side(drawing, house, u, -panel.along if near_end else panel.along, light, materials, rng)

    _draw_roof(drawing, house, light, materials, rng)
    front = panel.rectangles([0, 0, width, height])
    pictures = _wall_of(house, materials)
    surface = on_wall(panel, pictures, distance, house.seed % 12)
    drawing.paint(front, light.shade(house.wall, panel.normal), kind="wall", textures=[surface])
    if house.style != "modern":
        plinth = light.shade(house.wall * 0.62, panel.normal)
        drawing.paint(panel.rectangles([0, 0, width, 0.55]), plinth, kind="plinth")

    style = _windows_of(house, trim, rng)
    draw_ground_floor(
        drawing,
        panel,
        width,
        house.ground_height,
        style,
        eye=eye,
        light=light,
        materials=materials,
        rng=rng,
        detailed=detailed,
    )
    boxes = _window_boxes(house, rng)
    draw_windows(drawing, panel, boxes, style, eye=eye, light=light, materials=materials, rng=rng, detailed=detailed)
    _draw_ledges(drawing, house, trim, eye, light, rng)
    if rng.random() < 0.5 and detailed:
        pipe = [0.1, 0.2, 0.21, height - 0.3]
        draw_ledges(drawing, panel, pipe, 0.1, rgb(112, 112, 108), eye=eye, light=light, kind="downpipe", soft_shadow=0)


def _wall_of(house: House, materials: Materials) -> tuple[Pixels, ...]:
    walls = materials.walls
    if house.style == "brick":
        return walls.brick
    return walls.stone if house.seed % 3 == 0 else walls.plaster


def _trim_of(house: House, rng: np.random.Generator) -> Colour:
    if house.style == "modern":
        return np.clip(house.wall * 0.8, 0, 255)
    light_stone = rgb(236, 230, 216) * np.float32(rng.uniform(0.9, 1.0))
    return light_stone if house.wall.mean() < 212 or house.style == "brick" else house.wall * np.float32(0.82)


def _windows_of(house: House, trim: Colour, rng: np.random.Generator) -> WindowStyle:
    frame = rgb(238, 236, 230) if rng.random() < 0.6 else rgb(70, 62, 56)
    if house.style == "modern":
        return WindowStyle(
            house.wall, trim, rgb(58, 62, 66), recess=0.14, surround=0.0, columns=int(rng.integers(1, 4)), sill=False
        )
    shutters = None
    if house.style == "classical" and rng.random() < 0.3:
        shutters = rgb(*[(74, 108, 92), (92, 112, 132), (122, 78, 60)][int(rng.integers(3))])
    return WindowStyle(
        house.wall,
        trim,
        frame,
        recess=float(rng.uniform(0.14, 0.24)),
        surround=0.14 if house.style == "classical" else 0.0,
        columns=2,
        rows=int(rng.integers(1, 3)),
        shutters=shutters,
    )


def _window_boxes(house: House, rng: np.random.Generator) -> np.ndarray:
    modern = house.style == "modern"
    pitch = float(rng.uniform(2.9, 3.8)) if modern else float(rng.uniform(2.3, 3.0))
    count = max(int((house.width - 0.8) / pitch), 1)
    pitch = (house.width - 0.8) / count
    wide = pitch * 0.68 if modern else float(rng.uniform(1.0, 1.25))
    tall = house.floor_height * (0.5 if modern else float(rng.uniform(0.5, 0.6)))
    centres = 0.4 + pitch * (np.arange(count) + 0.5)
    boxes: list[list[float]] = []
    for floor in range(house.floors):
        low = house.ground_height + floor * house.floor_height + house.floor_height * 0.26
        high = low + tall * (0.86 if floor == house.floors - 1 and not modern else 1.0)
        boxes += [[float(c - wide / 2), low, float(c + wide / 2), high] for c in centres]
    return np.array(boxes).reshape(-1, 4)


def _draw_side(
    drawing: Drawing,
    house: House,
    u: float,
    normal: Points,
    light: Light,
    materials: Materials,
    rng: np.random.Generator,
) -> None:
    """The wall at one end, seen over a lower neighbour or across a side street."""
    corner = house.panel.point(u, 0)
    back = Panel(corner, -house.panel.normal, normal)
    wall = back.rectangles([0, 0, house.depth, house.height])
    surface = on_wall(back, _wall_of(house, materials), 20.0, (house.seed + 5) % 12)
    side = house.wall * rgb(0.9, 0.88, 0.86) * np.float32(rng.uniform(0.9, 1.0))
    drawing.paint(wall, light.shade(side, normal), kind="side wall", textures=[surface])


def _draw_chimneys(drawing: Drawing, house: House, eye: Points, light: Light, rng: np.random.Generator) -> None:
    panel = Panel(house.panel.point(0, 0, -2.2), house.panel.along, house.panel.normal)
    for _ in range(int(rng.integers(0, 3))):
        u, tall = float(rng.uniform(1.0, house.width - 1.8)), house.height + float(rng.uniform(2.6, 3.6))
        box = [u, house.height - 1, u + 0.9, tall]
        brick = rgb(140, 92, 76) * np.float32(rng.uniform(0.8, 1.1))
        draw_ledges(drawing, panel, box, 0.7, brick, eye=eye, light=light, kind="chimney", soft_shadow=0)


def _draw_roof(drawing: Drawing, house: House, light: Light, materials: Materials, rng: np.random.Generator) -> None:
    panel, width, height = house.panel, house.width, house.height
    tiles = rgb(*[(136, 82, 62), (96, 92, 96), (120, 72, 58), (84, 84, 92)][int(rng.integers(4))])
    if house.style == "modern":
        return
    steep = float(rng.uniform(2.2, 2.9))
    slope = panel.point([0, width, width, 0], height + np.array([steep, steep, 0, 0]), [-1.1, -1.1, -0.1, -0.1])
    normal = panel.normal * 0.92 + np.array([0, -0.4, 0])
    texture = texture_on(slope, materials.walls.stone[1][:40])
    drawing.paint(slope, light.shade(tiles, normal), kind="roof", textures=[texture])
    gable = [panel.point(0, height, -0.1), panel.point(0, height + steep, -1.1), panel.point(0, height, -4.0)]
    drawing.paint(np.array(gable), light.shade(house.wall * 0.85, -panel.along))
    drawing.lines(np.array(gable)[None], "gable")
    drawing.outline(slope[None], "roof")


def _draw_ledges(
    drawing: Drawing, house: House, trim: Colour, eye: Points, light: Light, rng: np.random.Generator
) -> None:
    panel, width, height = house.panel, house.width, house.height
    band = house.ground_height
    if house.style == "modern":
        for floor in range(house.floors + 1):
            v = band + floor * house.floor_height
            draw_ledges(
                drawing, panel, [0, v - 0.12, width, v + 0.1], 0.06, trim, eye=eye, light=light, kind="string course"
            )
        return
    draw_ledges(
        drawing, panel, [0, band - 0.14, width, band + 0.1], 0.12, trim, eye=eye, light=light, kind="string course"
    )
    draw_ledges(
        drawing, panel, [0, height - 0.42, width, height - 0.22], 0.14, trim, eye=eye, light=light, kind="cornice"
    )
    draw_ledges(
        drawing, panel, [0, height - 0.22, width, height + 0.06], 0.38, trim, eye=eye, light=light, kind="cornice"
    )
    if house.style == "classical" and rng.random() < 0.5:
        for u in (0.0, width - 0.5):
            tone = light.shade(trim * 0.95, panel.normal)
            drawing.paint(panel.rectangles([u, band + 0.1, u + 0.5, height - 0.42]), tone, kind="pilaster")
