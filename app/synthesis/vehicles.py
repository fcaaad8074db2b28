"""Cars: bodies curved in every direction, which hide straight edges and have none of their own."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from scipy.interpolate import CubicSpline

from app.synthesis.geometry import Drawing, Points, turned_right
from app.synthesis.light import Colour, Light, rgb
from app.synthesis.vegetation import dark_spot

# a body's outline seen from the side: distance from the rear bumper and height in m, from below the rear bumper
# over the roof to below the front bumper; "g" starts glass, "b" body
PROFILES: dict[str, tuple[tuple[float, float, str], ...]] = {
    "saloon": (
        (0.10, 0.30, "b"), (0.02, 0.55, "b"), (0.06, 0.82, "b"), (0.22, 0.97, "b"), (0.70, 1.01, "g"),
        (1.30, 1.36, "b"), (1.90, 1.46, "b"), (2.55, 1.40, "g"), (3.25, 0.99, "b"), (3.90, 0.88, "b"),
        (4.36, 0.68, "b"), (4.44, 0.48, "b"), (4.36, 0.28, "b"),
    ),
    "hatchback": (
        (0.10, 0.30, "b"), (0.02, 0.58, "b"), (0.06, 0.92, "g"), (0.42, 1.36, "b"), (1.10, 1.50, "b"),
        (2.00, 1.48, "g"), (2.85, 1.02, "b"), (3.45, 0.90, "b"), (3.86, 0.68, "b"), (3.94, 0.48, "b"),
        (3.86, 0.28, "b"),
    ),
    "estate": (
        (0.10, 0.34, "b"), (0.02, 0.62, "b"), (0.05, 1.02, "g"), (0.30, 1.58, "b"), (1.20, 1.70, "b"),
        (2.40, 1.66, "g"), (3.20, 1.14, "b"), (3.90, 1.02, "b"), (4.36, 0.78, "b"), (4.46, 0.54, "b"),
        (4.38, 0.32, "b"),
    ),
}  # fmt: skip
PAINTS: tuple[tuple[int, int, int], ...] = (
    (196, 200, 204), (44, 48, 54), (232, 232, 230), (150, 28, 32), (34, 66, 122), (118, 124, 130), (72, 96, 84),
    (196, 142, 48), (94, 132, 158),
)  # fmt: skip
_ACROSS = 13
_SMOOTH_WITHIN = 22.0  # m; farther cars are made of fewer pieces


@dataclass(frozen=True, eq=False)
class Car:
    """A car: its middle on the ground (x, z in m), whether it drives away from the camera, body and paint.

    It is turned by `heading` rad to the right.
    """

    x: float
    z: float
    away: bool
    body: str
    paint: Colour
    heading: float = 0.0


def draw_car(drawing: Drawing, car: Car, *, eye: Points, light: Light) -> None:
    """Draw a car as seen from `eye`."""
    middle = np.array([car.x, 0.0, car.z])
    back = turned_right(-car.heading)
    straight = Drawing()
    turned_light = replace(light, to_sun=back @ light.to_sun)
    _draw_straight(straight, car, back @ (eye - middle) + middle, turned_light)
    drawing.extend(straight, car.heading, middle)


def _draw_straight(drawing: Drawing, car: Car, eye: Points, light: Light) -> None:
    near = float(np.linalg.norm(eye[[0, 2]] - [car.x, car.z])) < _SMOOTH_WITHIN
    fineness = 6 if near else 2
    along, heights, glass = _outline(car.body, fineness)
    length = max(point[0] for point in PROFILES[car.body])
    corners, picture = dark_spot(np.array([car.x, -0.005, car.z]), (1.12, length / 2 + 0.25), 0.8)
    drawing.paint(corners, (0, 0, 0), textures=[picture])
    mesh = _body(along, heights, length)
    side = 1.0 if eye[0] > car.x else -1.0
    flip = np.array([1.0, 1.0, 1.0 if car.away else -1.0])
    place = np.array([car.x, 0.0, car.z])
    _draw_flank(drawing, car, mesh, side, flip, place, length, light, near)
    world = mesh * flip + place
    quads = np.stack([world[:-1, :-1], world[:-1, 1:], world[1:, 1:], world[1:, :-1]], axis=2).reshape(-1, 4, 3)
    pillars = np.abs(np.linspace(-1, 1, _ACROSS)[:-1] + 1 / (_ACROSS - 1)) > 0.84
    pieces = (glass[:-1, None] & ~pillars).ravel()
    if not car.away:
        quads = quads[:, ::-1]
    normals = np.cross(quads[:, 1] - quads[:, 0], quads[:, 3] - quads[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-9)
    towards = np.einsum("ij,ij->i", normals, quads.mean(axis=1) - eye)
    # what faces away is hidden by the body itself; of the rest the farther comes first
    normals = np.where((towards < 0)[:, None], normals, -normals)
    outward = np.einsum("ij,ij->i", normals, quads.mean(axis=1) - (place + np.array([0, -0.6, 0]))) > 0
    order = np.argsort(-np.linalg.norm(quads.mean(axis=1) - eye, axis=1))
    order = order[outward[order]]
    drawing.paint(quads[order], _tones(normals, pieces, car.paint, light)[order], margin=0.5)
    _draw_lights(drawing, car, world, heights, eye, light)
    for rim in (0, -1):
        drawing.curve(world[:, rim], "car body")
    for row in np.flatnonzero(np.diff(glass.astype(int))) + 1:
        drawing.curve(world[row], "car body")


def _outline(body: str, fineness: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A smooth side outline in `fineness` pieces from point to point: distance, height, is glass; ``(n,)`` each."""
    points = PROFILES[body]
    knots = np.array([[p[0], p[1]] for p in points])
    chord = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(knots, axis=0), axis=1))])
    fine = np.concatenate([np.linspace(a, b, fineness + 1)[:-1] for a, b in pairwise(chord)] + [chord[-1:]])
    smooth = CubicSpline(chord, knots)(fine)
    kinds = np.repeat([p[2] == "g" for p in points], fineness)[: len(fine)]
    return smooth[:, 0], smooth[:, 1], kinds


def _half_width(heights: np.ndarray) -> np.ndarray:
    """Half the body's width at heights in m: bulging at the waist, narrower at the roof and the sill."""
    return (
        0.90
        - 0.30 * np.clip((heights - 0.85) / 0.75, 0, None) ** 1.15
        - 0.05 * (heights / 0.6 - 1) ** 2 * (heights < 0.6)
    )


def _body(along: np.ndarray, heights: np.ndarray, length: float) -> Points:
    """The skin from left to right, crowned across, ``(n, across, 3)`` around the car's middle."""
    across = np.linspace(-1, 1, _ACROSS)
    half = _half_width(heights)[:, None]
    x = half * np.sin(across * np.pi / 2 * 0.94) / np.sin(np.pi / 2 * 0.94)
    bow = across**4
    z = (along[:, None] - length / 2) * (1 - 0.07 * bow)
    crown = 0.11 * (heights - 0.55)[:, None] * across**2
    return np.stack([x, -(heights[:, None] - crown), z], axis=-1)


def _tones(normals: Points, glass: np.ndarray, paint: Colour, light: Light) -> np.ndarray:
    """Matt paint with the sky mirrored in what looks up; glass that mirrors more."""
    upward = np.clip(-normals[:, 1:2], 0, 1)
    sky = light.zenith * 0.4 + light.horizon * 0.6
    body = light.shade(paint, normals) + 0.16 * upward**2 * sky
    half = normals + light.to_sun + np.array([0, 0, -0.6])
    half /= np.linalg.norm(half, axis=1, keepdims=True)
    body = body + 255 * light.sun * np.clip(np.einsum("ij,ij->i", normals, half), 0, 1)[:, None] ** 24 * 0.28
    pane = rgb(22, 27, 34) + (0.05 + 0.40 * upward) * sky
    return np.where(glass[:, None], pane, body).clip(0, 255)


def _draw_flank(
    drawing: Drawing,
    car: Car,
    mesh: Points,
    side: float,
    flip: Points,
    place: Points,
    length: float,
    light: Light,
    near: bool,
) -> None:
    """The side towards the camera, in upright strips: body below the waist, glass above, then wheels."""
    rim = mesh[:, 0 if side < 0 else -1]
    order = np.argsort(rim[:, 2])
    z = np.linspace(rim[:, 2].min() + 0.02, rim[:, 2].max() - 0.02, 60 if near else 24)
    upper = np.flatnonzero(-rim[:, 1] > 0.5)
    tops = np.interp(z, rim[upper, 2][np.argsort(rim[upper, 2])], -rim[upper, 1][np.argsort(rim[upper, 2])])
    middle = (z - rim[order[0], 2]) / length
    waist = np.minimum(tops, 0.93 + 0.05 * np.sin(np.pi * middle))
    sill = 0.27 + 0.10 * (2 * middle - 1) ** 2

    def strips(low: np.ndarray, high: np.ndarray) -> Points:
        x_low, x_high = side * _half_width(low) * 1.0, side * _half_width(high)
        lower = np.stack([x_low, -low, z], axis=1) * flip + place
        higher = np.stack([x_high, -high, z], axis=1) * flip + place
        return np.stack([higher[:-1], higher[1:], lower[1:], lower[:-1]], axis=1)

    normal = np.array([side, 0.0, 0.0])
    levels = [sill, 0.35 * waist + 0.65 * sill, 0.75 * waist + 0.25 * sill, waist]
    for index, tilt in enumerate((0.35, 0.0, -0.3)):
        facing = (normal + np.array([0, tilt, 0])) / np.hypot(1, tilt)
        tone = _tones(facing[None], np.array([False]), car.paint, light)
        drawing.paint(strips(levels[index], levels[index + 1]), tone[0], margin=0.5)
    cabin = tops - waist
    roof = tops - np.minimum(0.075, cabin)
    body_tone = _tones((normal + np.array([0, -0.5, 0]))[None] / 1.118, np.array([False]), car.paint, light)[0]
    drawing.paint(strips(waist, tops), body_tone, margin=0.5)
    pane_tone = _tones(np.array([[side, -0.25, 0.0]]), np.array([True]), car.paint, light)[0]
    deep = np.minimum(cabin[:-1], cabin[1:]) > 0.16
    pillar = np.abs(z[:-1] + 0.12) < 0.05
    drawing.paint(strips(waist + 0.02, roof)[deep & ~pillar], pane_tone, margin=0.4)
    _draw_wheels(drawing, side, flip, place, length, light, near)


def _draw_wheels(
    drawing: Drawing, side: float, flip: Points, place: Points, length: float, light: Light, near: bool
) -> None:
    turn = np.linspace(0, 2 * np.pi, 28, endpoint=False)
    hub = light.shade(rgb(158, 160, 164), (side, 0, 0), sunlit=False)
    for z in (-length / 2 + 0.82, length / 2 - 0.84):
        for radius, out, tone in ((0.37, 0.89, rgb(16, 17, 19)), (0.315, 0.90, rgb(32, 33, 36)), (0.205, 0.905, hub)):
            disc = np.stack(
                [np.full(28, side * out), -0.315 + radius * np.sin(turn), z + radius * np.cos(turn)], axis=1
            )
            drawing.paint(disc * flip + place, tone)
            drawing.curve(np.concatenate([disc, disc[:1]]) * flip + place, "wheel")
        for spoke in np.arange(5 * near) * 2 * np.pi / 5:
            hole = np.stack([np.cos(turn), np.sin(turn)], axis=1) * 0.04 + 0.12 * np.array(
                [np.cos(spoke), np.sin(spoke)]
            )
            disc = np.stack([np.full(28, side * 0.908), -0.315 + hole[:, 1], z + hole[:, 0]], axis=1)
            drawing.paint(disc * flip + place, hub * 0.4)


def _draw_lights(drawing: Drawing, car: Car, world: Points, heights: np.ndarray, eye: Points, light: Light) -> None:
    """Round lamps at the end that faces the camera, and a plate with round corners."""
    turn = np.linspace(0, 2 * np.pi, 20, endpoint=False)
    rear = car.away == (car.z > eye[2])
    rows = np.flatnonzero((heights > 0.5) & (heights < 0.9))
    row = rows[0] + 1 if rear else rows[-1] - 1
    skin = world[row]
    out = np.array([0.0, 0.0, -0.03])
    tone = rgb(190, 26, 28) if rear else rgb(238, 238, 226)
    tone = tone if light.lamps else light.shade(tone, (0, 0, -1), sunlit=False) * 1.1
    for at in (2, _ACROSS - 3):
        middle = skin[at] + out + np.array([0, -0.07, 0])
        lamp = middle + np.stack([0.13 * np.cos(turn), 0.08 * np.sin(turn), np.zeros(20)], axis=1)
        drawing.paint(lamp, tone)
    middle = skin[_ACROSS // 2] + out * 1.5 + np.array([0, 0.02, 0])
    corner = np.abs(np.cos(turn)) ** 0.5 * np.sign(np.cos(turn)), np.abs(np.sin(turn)) ** 0.5 * np.sign(np.sin(turn))
    plate = middle + np.stack([0.24 * corner[0], 0.055 * corner[1], np.zeros(20)], axis=1)
    drawing.paint(plate, light.shade(rgb(230, 230, 220), (0, 0, -1), sunlit=False))
