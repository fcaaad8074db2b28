"""Drawing up a street from a seed: how wide, which houses, what is parked and planted where."""

from __future__ import annotations

import numpy as np

from app.synthesis.bend import Bend
from app.synthesis.clutter import plan_clutter
from app.synthesis.facades import WALLS, House, HouseStyle
from app.synthesis.geometry import Panel
from app.synthesis.guard_rails import GuardRail
from app.synthesis.light import TimeOfDay, draw_light, rgb
from app.synthesis.road import END, KERB, Road
from app.synthesis.sky import make_sky
from app.synthesis.street import Street, Thing
from app.synthesis.textures import make_materials
from app.synthesis.vehicles import PAINTS, PROFILES, Car


def plan_street(seed: int, time: TimeOfDay) -> Street:
    """Draw up a street from a seed."""
    rng = np.random.default_rng([seed, 1])
    light = draw_light(rng, time)
    half = float(rng.uniform(3.6, 5.2))
    wall = half + float(rng.uniform(2.4, 3.8))
    length = float(rng.uniform(75, 120))
    gaps: list[tuple[int, float, float]] = []
    for side in (-1, 1):
        if rng.random() < 0.7:
            start = float(rng.uniform(20, 40))
            gaps.append((side, start, start + float(rng.uniform(10, 13))))
    zebra = float(rng.uniform(11, 18)) if rng.random() < 0.5 else None
    bend = _plan_bend(rng, length, zebra)
    road = Road(
        half_width=half,
        wall=wall,
        length=length,
        gaps=tuple(gaps),
        marking=str(rng.choice(["dashed", "dashed", "double", "tram"] if half > 4 else ["dashed", "double"])),
        zebra=zebra,
        parking=tuple(side for side in (-1, 1) if half > 4.3 and rng.random() < 0.7),
        turning=gaps[0][0] if gaps and not bend.curvature and rng.random() < 0.6 else 0,
        bend=bend,
    )
    houses = _plan_houses(rng, road)
    return Street(
        light=light,
        materials=make_materials(np.random.default_rng([seed, 2]), light),
        sky=make_sky(seed),
        road=road,
        houses=tuple(houses),
        cars=tuple(_plan_cars(rng, road)),
        things=tuple(_plan_things(rng, road)),
        rails=tuple(_plan_rails(rng, road)),
        clutter=plan_clutter(rng, road),
        lane=half * 0.42,
    )


def _plan_bend(rng: np.random.Generator, length: float, zebra: float | None) -> Bend:
    """Four streets in ten bend, by up to 0.8 rad; the camera stands on the straight part."""
    if rng.random() < 0.6:
        return Bend()
    begins = float(rng.uniform(16, 32)) if zebra is None else zebra + float(rng.uniform(7, 14))
    curvature = float(rng.choice([-1, 1])) / float(rng.uniform(45, 130))
    return Bend(curvature, begins, begins + min(length - begins - 4, 0.8 / abs(curvature)))


def _seed(rng: np.random.Generator) -> int:
    return int(rng.integers(2**31))


def _plan_houses(rng: np.random.Generator, road: Road) -> list[House]:
    houses: list[House] = []
    tallness = int(rng.integers(2, 5))
    last_wall = None
    for side in (-1, 1):
        z = -14.0
        ends = [*sorted(g[1] for g in road.gaps if g[0] == side), road.length]
        starts = sorted(g[2] for g in road.gaps if g[0] == side)
        for end in ends:
            while z < end - 4:
                width = float(min(rng.uniform(8.5, 17), end - z))
                if end - z - width < 6:
                    width = end - z
                panel, front = _front(road, side, z, z + width)
                house = _plan_house(rng, panel, front, tallness, last_wall)
                last_wall = tuple(house.wall)
                houses.append(house)
                z += width
            if starts:
                z = starts.pop(0)
    across = -36.0
    while across < 36:
        width = float(rng.uniform(11, 18))
        corner, along = road.bend.place([across, across + 1.0], road.length + END, KERB)
        along = along - corner
        panel = Panel(corner, along, np.array([along[2], 0.0, -along[0]]))
        houses.append(_plan_house(rng, panel, width, tallness, last_wall))
        across += width
    return houses


def _front(road: Road, side: int, z0: float, z1: float) -> tuple[Panel, float]:
    """The upright plane over a chord of the building line, and the chord's length."""
    first, last = road.bend.place(side * road.wall, [z0, z1], KERB)
    width = float(np.linalg.norm(last - first))
    along = (last - first) / width
    return Panel(first, along, -side * np.array([along[2], 0.0, -along[0]])), width


def _plan_house(
    rng: np.random.Generator, panel: Panel, width: float, tallness: int, last_wall: tuple[float, ...] | None
) -> House:
    styles: list[HouseStyle] = ["classical", "classical", "classical", "brick", "modern"]
    style = styles[int(rng.integers(len(styles)))]
    choice = [rgb(*base) for base in WALLS[style]]
    if last_wall is not None:  # neighbours differ
        choice = [base for base in choice if float(np.abs(base - np.array(last_wall)).max()) > 28] or choice
    wall = choice[int(rng.integers(len(choice)))] * np.float32(rng.uniform(0.95, 1.05))
    return House(
        panel=panel,
        width=width,
        floors=max(int(tallness + rng.integers(-1, 2)), 1),
        ground_height=float(rng.uniform(3.6, 4.3)),
        floor_height=float(rng.uniform(2.9, 3.3)),
        depth=12.0,
        style=style,
        wall=np.clip(wall, 0, 245).astype(np.float32),
        seed=_seed(rng),
    )


def _plan_cars(rng: np.random.Generator, road: Road) -> list[Car]:
    def car(x: float, z: float, away: bool) -> Car:
        body = list(PROFILES)[int(rng.integers(len(PROFILES)))]
        paint = rgb(*PAINTS[int(rng.integers(len(PAINTS)))])
        place = road.bend.place(x, z)
        return Car(float(place[0]), float(place[2]), away, body, paint, float(road.bend.heading(z)))

    cars: list[Car] = []
    for side in (-1, 1):
        crossings = [(g[1] - 4, g[2] + 4) for g in road.gaps if g[0] == side]
        if road.zebra is not None:
            crossings.append((road.zebra - 5, road.zebra + 6))
        z = float(rng.uniform(4, 9))
        chance = 0.72 if side in road.parking else 0.22
        while z < 75:
            clear = all(not low < z < high for low, high in crossings)
            if clear and rng.random() < chance:
                cars.append(car(side * (road.half_width - 1.08), z, side > 0))
            z += 6.0 + float(rng.uniform(0, 0.8))
    if rng.random() < 0.75:
        cars.append(car(road.half_width * 0.42 - 0.2, float(rng.uniform(17, 38)), True))
    if rng.random() < 0.6:
        cars.append(car(-road.half_width * 0.36, float(rng.uniform(26, 55)), False))
    return cars


def _plan_things(rng: np.random.Generator, road: Road) -> list[Thing]:
    things: list[Thing] = []

    def stand(z: float, x: float, kind: str, size: float) -> None:
        place = road.bend.place(x, z)
        things.append(Thing(float(place[2]), float(place[0]), kind, size, _seed(rng), z, int(np.sign(x))))

    for side in (-1, 1):
        closed = [(g[1] - 3.5, g[2] + 3.5) for g in road.gaps if g[0] == side]

        def clear(z: float, closed: list[tuple[float, float]] = closed) -> bool:
            return all(not low < z < high for low, high in closed)

        edge = side * (road.half_width + 0.55)
        with_trees = rng.random() < 0.6
        spacing = float(rng.uniform(13, 19))
        for index, z in enumerate(np.arange(float(rng.uniform(5, 12)), road.length - 3, spacing / 2)):
            place = float(z + rng.uniform(-0.6, 0.6))
            if not clear(place):
                continue
            if index % 2 == 0:
                stand(place, edge, "lamp", 7.4)
            elif with_trees:
                stand(place, edge + side * 0.3, "tree", float(rng.uniform(6.0, 8.5)))
        for z in rng.uniform(7, 60, 4):
            if clear(float(z)):
                stand(float(z), edge, "sign", 2.95)
        if road.zebra is not None:
            stand(road.zebra - 0.8, edge, "signal", 3.5)
        start = float(rng.uniform(6, 34))
        if rng.random() < 0.6 and clear(start) and clear(start + 9):
            for place in range(5):
                stand(start + 1.9 * place, side * (road.half_width + 0.3), "bollard", 0.95)
        for z in rng.uniform(6, 50, 3):
            if clear(float(z)):
                stand(float(z), side * (road.wall - 0.85), "cabinet" if rng.random() < 0.6 else "bush", 1.25)
        for z in 3.0 + 45 * rng.random(int(rng.integers(1, 8))) ** 1.3:
            across = float(rng.uniform(road.half_width + 0.6, road.wall - 0.5))
            stand(float(z), side * across, "person", float(rng.uniform(1.5, 1.9)))
    if road.zebra is not None:
        for _ in range(int(rng.integers(0, 4))):
            across = float(rng.uniform(-road.half_width, road.half_width))
            stand(road.zebra + float(rng.uniform(0.5, 2.8)), across, "person", float(rng.uniform(1.5, 1.9)))
    for z in rng.uniform(9, 70, int(rng.integers(1, 6))):
        stand(float(z), 0.0, "wire", float(rng.uniform(6.4, 8.0)))
    return things


def _plan_rails(rng: np.random.Generator, road: Road) -> list[GuardRail]:
    """Beside one pavement in three: a rail between kerb and walkers, where no side street is."""
    rails: list[GuardRail] = []
    for side in (-1, 1):
        if rng.random() < 0.35:
            z0 = float(rng.uniform(3, 24))
            z1 = z0 + float(rng.uniform(10, 40))
            gaps = [g[1] - 4 for g in road.gaps if g[0] == side and g[2] > z0 - 4]
            z1 = min(z1, road.length - 4, *gaps)
            if road.zebra is not None and z0 < road.zebra + 5:
                z1 = min(z1, road.zebra - 1.5)
            if z1 - z0 > 4:
                rails.append(GuardRail(side * (road.half_width + 0.28), z0, z1))
    return rails
