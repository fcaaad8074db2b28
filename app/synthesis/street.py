"""A street: houses on both sides, what stands and drives between them, and its drawing from one spot."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from itertools import pairwise

import numpy as np

from app.synthesis.clutter import Spot, draw_clutter
from app.synthesis.facades import House, draw_house
from app.synthesis.furniture import (
    draw_bollard,
    draw_box,
    draw_lamp,
    draw_sign,
    draw_traffic_light,
    draw_wire,
    post,
)
from app.synthesis.geometry import Drawing, Points
from app.synthesis.guard_rails import GuardRail, draw_rail_piece, outline_rail, rail_places
from app.synthesis.light import Light, rgb
from app.synthesis.people import draw_person
from app.synthesis.road import KERB, Road, draw_pavements, draw_road, draw_shadows
from app.synthesis.sky import Sky
from app.synthesis.textures import Materials
from app.synthesis.vegetation import draw_bush, draw_tree, draw_tree_shadow
from app.synthesis.vehicles import Car, draw_car

_NOWHERE = 1.2  # m; things this close before the camera are left out


@dataclass(frozen=True, eq=False)
class Thing:
    """Something free-standing: its distance along the street and what it is.

    Attributes:
        z: Where it stands, m.
        x: Likewise, to the right.
        kind: "lamp", "sign", "signal", "bollard", "cabinet", "tree", "bush", "person" or "wire".
        size: Height or length in m, by kind.
        seed: Seed of what varies about it.
        along: Where it stands along the street's axis, m.
        side: Of the road: -1 left, 1 right, 0 above it.
    """

    z: float
    x: float
    kind: str
    size: float
    seed: int
    along: float
    side: int


@dataclass(frozen=True, eq=False)
class Street:
    """All that a street is; drawn from anywhere along it, it is the same street."""

    light: Light
    materials: Materials
    sky: Sky
    road: Road
    houses: tuple[House, ...]
    cars: tuple[Car, ...]
    things: tuple[Thing, ...]
    rails: tuple[GuardRail, ...]
    clutter: tuple[Spot, ...]
    lane: float


def draw_street(street: Street, eye: Points) -> Drawing:
    """Draw a street as seen from `eye` ``(3,)``, from the far to the near."""
    drawing, light, road = Drawing(), street.light, street.road
    casters = [house.panel.rectangles([0, 0, house.width, house.height])[0] for house in street.houses]
    casters += [
        post(thing.x, thing.z, 0.0, 6.2 if thing.kind == "lamp" else 2.4, 0.13)
        for thing in street.things
        if thing.kind in ("lamp", "sign", "signal")
    ]
    trees = [thing for thing in street.things if thing.kind == "tree"]
    draw_road(drawing, road, light, street.materials)
    draw_clutter(drawing, street.clutter, road, light)
    draw_shadows(drawing, casters, light, 0.0, road)
    draw_pavements(drawing, road, light, street.materials)
    draw_shadows(drawing, casters, light, KERB, road)
    for tree in trees:
        draw_tree_shadow(drawing, tree.x, tree.z, tree.size, light, street.materials)
    for house in sorted(street.houses, key=lambda house: -_nearest(house, eye)):
        if house.panel.locate(eye)[2] > 0 and house.panel.point(house.width, 0)[2] > eye[2] - 2:
            draw_house(drawing, house, eye=eye, light=light, materials=street.materials)

    things: list[tuple[float, Callable[[Drawing], None]]] = [
        (_away(car.x, car.z, eye), partial(draw_car, car=car, eye=eye, light=light))
        for car in street.cars
        if _before(car, eye)
    ]
    things += [
        (_away(thing.x, thing.z, eye), partial(_draw_thing, thing=thing, street=street, eye=eye))
        for thing in street.things
        if thing.z > eye[2] + _NOWHERE
    ]
    for rail in street.rails:
        outline_rail(drawing, rail, road.bend)
        for z0, z1 in pairwise(rail_places(rail, road.bend).tolist()):
            if z0 > eye[2] + _NOWHERE:
                piece = partial(draw_rail_piece, rail=rail, bend=road.bend, z0=z0, z1=z1, light=light)
                x, _, z = road.bend.place(rail.x, (z0 + z1) / 2).tolist()
                things.append((_away(x, z, eye), piece))
    for _, draw in sorted(things, key=lambda item: -item[0]):
        draw(drawing)
    return drawing


def _before(car: Car, eye: Points) -> bool:
    """Whether a car is far enough ahead to be seen whole, or nearly so."""
    return car.z - eye[2] > max(8.0 - 0.7 * abs(car.x - eye[0]), 4.0)


def _away(x: float, z: float, eye: Points) -> float:
    """How far away something stands, m: the nearer is painted over the farther."""
    return float(np.hypot(x - eye[0], z - eye[2]))


def _nearest(house: House, eye: Points) -> float:
    """Sorting key of houses: how far their fronts' middles are."""
    return float(np.linalg.norm(house.panel.point(house.width / 2, 0) - eye))


def _draw_thing(drawing: Drawing, thing: Thing, street: Street, eye: Points) -> None:
    light = street.light
    rng = np.random.default_rng(thing.seed)
    if thing.kind == "lamp":
        draw_lamp(drawing, thing.x, thing.z, -thing.side, light)
    elif thing.kind == "sign":
        draw_sign(drawing, thing.x, thing.z, light, rng)
    elif thing.kind == "signal":
        draw_traffic_light(drawing, thing.x, thing.z, light, rng)
    elif thing.kind == "bollard":
        draw_bollard(drawing, thing.x, thing.z, light)
    elif thing.kind == "cabinet":
        tone = rgb(*[(124, 138, 122), (150, 146, 138), (104, 112, 122)][int(rng.integers(3))])
        size = (float(rng.uniform(0.5, 0.8)), thing.size, float(rng.uniform(0.8, 1.4)))
        draw_box(drawing, thing.x, thing.z, size, tone, eye, light)
    elif thing.kind == "tree":
        draw_tree(drawing, thing.x, thing.z, thing.size, light, street.materials, thing.seed)
    elif thing.kind == "bush":
        draw_bush(drawing, thing.x, thing.z, thing.size, street.materials, thing.seed)
    elif thing.kind == "person":
        on_pavement = abs(thing.side) and not _on_crossing(thing, street.road)
        draw_person(drawing, thing.x, thing.z, thing.size, KERB if on_pavement else 0.0, light, rng)
    else:
        bend, wall = street.road.bend, street.road.wall
        left = bend.place(-wall, thing.along, thing.size)
        right = bend.place(wall, thing.along + rng.uniform(-6, 6), thing.size + rng.uniform(-0.6, 0.6))
        draw_wire(drawing, left, right, float(rng.uniform(0.25, 0.8)), light)


def _on_crossing(thing: Thing, road: Road) -> bool:
    return bool(np.linalg.norm(road.bend.place(0.0, thing.along)[[0, 2]] - [thing.x, thing.z]) < road.half_width)
