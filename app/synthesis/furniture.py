"""What stands on the pavement and hangs above the street: lamps, signs, bollards, boxes and wires."""

from __future__ import annotations

import numpy as np

from app.synthesis.geometry import Drawing, Panel, Points, texture_on
from app.synthesis.light import Colour, Light, rgb
from app.synthesis.road import KERB
from app.synthesis.textures import glow, round_shading
from app.synthesis.windows import draw_ledges

_ACROSS = np.array([1.0, 0.0, 0.0])
_TOWARDS = np.array([0.0, 0.0, -1.0])


def post(x: float, z: float, foot: float, top: float, width: float) -> Points:
    """The outline of an upright post, ``(4, 3)``: top left, top right, bottom right, bottom left."""
    half = width / 2
    return np.array([[x - half, -top, z], [x + half, -top, z], [x + half, -foot, z], [x - half, -foot, z]])


def draw_post(drawing: Drawing, corners: Points, colour: Colour, light: Light, kind: str = "pole") -> None:
    """Draw a round post; its two sides are straight."""
    side = float(np.clip(light.to_sun[0], -0.6, 0.6)) if light.shadow is not None else -0.2
    shade = texture_on(corners, round_shading(light_from=side))
    drawing.paint(corners, light.shade(colour, _TOWARDS, sunlit=False) * 1.1, textures=[shade])
    drawing.lines(np.stack([[corners[0], corners[3]], [corners[1], corners[2]]]), kind)


def draw_lamp(drawing: Drawing, x: float, z: float, towards: int, light: Light) -> None:
    """A street lamp: mast, a curved arm towards the road (-1: to the left, 1: to the right), and its head."""
    iron = rgb(74, 80, 82)
    for corners in (post(x, z, KERB, KERB + 1.1, 0.2), post(x, z, KERB + 1.1, 6.2, 0.13)):
        draw_post(drawing, corners, iron, light)
    turn = np.linspace(0, np.pi / 2, 12)
    arm = [
        np.stack([x + towards * r * (1 - np.cos(turn)), -6.2 - r * np.sin(turn), np.full(12, z)], axis=1)
        for r in (1.16, 1.29)
    ]
    arm[1] = arm[1] + np.array([towards * -0.065, 0.0, 0.0])
    arm[0] = arm[0] + np.array([towards * 0.065, 0.0, 0.0])
    pieces = [np.stack([arm[0][i], arm[0][i + 1], arm[1][i + 1], arm[1][i]]) for i in range(11)]
    drawing.paint(np.array(pieces), light.shade(iron, _TOWARDS, sunlit=False), margin=0.4)
    drawing.curve(arm[1], "lamp arm")
    tip = np.array([x + towards * 1.5, -7.4, z])
    turn = np.linspace(0, 2 * np.pi, 20, endpoint=False)
    head = tip + np.stack([0.42 * np.cos(turn), 0.13 * np.sin(turn), np.zeros(20)], axis=1)
    drawing.paint(head, rgb(255, 226, 160) if light.lamps else light.shade(iron * 1.3, _TOWARDS))
    if light.lamps:
        halo = Panel(tip, _ACROSS, _TOWARDS).rectangles([-1.6, -1.6, 1.6, 1.6])
        drawing.paint(halo, (0, 0, 0), textures=[texture_on(halo[0], glow(rgb(255, 206, 130), 0.55))])


def draw_sign(drawing: Drawing, x: float, z: float, light: Light, rng: np.random.Generator) -> None:
    """A traffic sign: a round one, a triangle, a rectangle or a square on its corner."""
    draw_post(drawing, post(x, z, KERB, 2.95, 0.075), rgb(150, 152, 154), light)
    middle, shape = np.array([x, -2.6, z - 0.05]), str(rng.choice(["disc", "triangle", "rectangle", "priority"]))
    face = light.shade(rgb(244, 244, 240), _TOWARDS)
    red, blue, yellow = (light.shade(rgb(*c), _TOWARDS) for c in ((196, 34, 40), (28, 84, 168), (244, 194, 44)))
    if shape == "disc":
        turn = np.linspace(0, 2 * np.pi, 36, endpoint=False)
        ring = np.stack([np.cos(turn), np.sin(turn), np.zeros(36)], axis=1)
        for radius, tone in ((0.34, red), (0.26, face)):
            drawing.paint(middle + radius * ring, tone)
        drawing.curve(middle + 0.34 * np.concatenate([ring, ring[:1]]), "round sign")
        return
    if shape == "triangle":
        corners = np.array([[0, -0.42, 0], [0.4, 0.28, 0], [-0.4, 0.28, 0]])
        layers = [(1.0, red), (0.68, face)]
    elif shape == "priority":
        corners = np.array([[0, -0.42, 0], [0.42, 0, 0], [0, 0.42, 0], [-0.42, 0, 0]])
        layers = [(1.0, face), (0.76, yellow)]
    else:
        corners = np.array([[-0.32, -0.42, 0], [0.32, -0.42, 0], [0.32, 0.42, 0], [-0.32, 0.42, 0]])
        layers = [(1.0, face), (0.88, blue)]
    for size, tone in layers:
        drawing.paint(middle + size * corners, tone, kind="sign")


def draw_traffic_light(drawing: Drawing, x: float, z: float, light: Light, rng: np.random.Generator) -> None:
    """A signal on a post: a straight box with round lamps."""
    draw_post(drawing, post(x, z, KERB, 3.5, 0.12), rgb(96, 100, 100), light)
    box = Panel(np.array([x, 0.0, z - 0.1]), _ACROSS, _TOWARDS)
    drawing.paint(box.rectangles([-0.19, 2.5, 0.19, 3.5]), light.shade(rgb(44, 48, 48), _TOWARDS), kind="signal")
    turn = np.linspace(0, 2 * np.pi, 20, endpoint=False)
    on = int(rng.choice([0, 2]))
    for index, lit in enumerate((rgb(240, 62, 48), rgb(244, 190, 60), rgb(70, 226, 130))):
        tone = lit if index == on else light.shade(lit * 0.22 + 12, _TOWARDS)
        drawing.paint(box.point(0.11 * np.cos(turn), 3.34 - 0.33 * index + 0.11 * np.sin(turn)), tone)


def draw_bollard(drawing: Drawing, x: float, z: float, light: Light) -> None:
    """A bollard with a pale collar."""
    draw_post(drawing, post(x, z, KERB, KERB + 0.95, 0.12), rgb(60, 64, 70), light, "bollard")
    collar = post(x, z - 0.01, KERB + 0.74, KERB + 0.84, 0.125)
    drawing.paint(collar, light.shade(rgb(232, 232, 226), _TOWARDS))


def draw_box(
    drawing: Drawing, x: float, z: float, size: tuple[float, float, float], colour: Colour, eye: Points, light: Light
) -> None:
    """A box on the pavement (a switch cabinet, a planter): size is width, height and depth in m."""
    width, height, depth = size
    front = Panel(np.array([x - width / 2, -KERB, z + depth / 2]), _ACROSS, _TOWARDS)
    draw_ledges(drawing, front, [0, 0, width, height], depth, colour, eye=eye, light=light, kind="box", soft_shadow=0)


def draw_wire(drawing: Drawing, start: Points, end: Points, sag: float, light: Light) -> None:
    """A wire between two points that hangs through by `sag` m: never straight, however little it sags."""
    along = np.linspace(0, 1, 25)[:, None]
    line = start + (end - start) * along
    line[:, 1] += (4 * sag * along * (1 - along))[:, 0]
    rise = np.array([0, -0.016, 0])
    pieces = np.stack([line[:-1] + rise, line[1:] + rise, line[1:] - rise, line[:-1] - rise], axis=1)
    drawing.paint(pieces, light.shade(rgb(44, 46, 50), _TOWARDS, sunlit=False), margin=0.15)
    for rim in (line + rise, line - rise):
        drawing.curve(rim, "hanging wire")
