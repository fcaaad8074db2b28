"""Drawing up a street from a seed: how wide, which houses, what is parked and planted where."""

from __future__ import annotations

import numpy as np

from app.synthesis.facades import WALLS, House, HouseStyle
from app.synthesis.geometry import Panel
from app.synthesis.light import TimeOfDay, draw_light, rgb
from app.synthesis.road import END, KERB, Road
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
    road = Road(
        half_width=half,
        wall=wall,
        length=length,
        gaps=tuple(gaps),
        marking=str(rng.choice(["dashed", "dashed", "double", "tram"] if half > 4 else ["dashed", "double"])),
        zebra=float(rng.uniform(11, 18)) if rng.random() < 0.5 else None,
        parking=tuple(side for side in (-1, 1) if half > 4.3 and rng.random() < 0.7),
        turning=gaps[0][0] if gaps and rng.random() < 0.6 else 0,
    )
    houses = _plan_houses(rng, road)
    return Street(
        seed=seed,
        light=light,
        materials=make_materials(np.random.default_rng([seed, 2]), light),
        road=road,
        houses=tuple(houses),
        cars=tuple(_plan_cars(rng, road)),
        things=tuple(_plan_things(rng, road)),
        lane=half * 0.42,
    )


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
                panel = Panel(
                    np.array([side * road.wall, -KERB, z]),
                    np.array([0.0, 0.0, 1.0]),
                    np.array([-float(side), 0.0, 0.0]),
                )
                house = _plan_house(rng, panel, width, tallness, last_wall)
                last_wall = tuple(house.wall)
                houses.append(house)
                z += width
            if starts:
                z = starts.pop(0)
    across = -36.0
    while across < 36:
        width = float(rng.uniform(11, 18))
        panel = Panel(
            np.array([across, -KERB, road.length + END]), np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, -1.0])
        )
        houses.append(_plan_house(rng, panel, width, tallness, last_wall))
        across += width
    return houses


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
        return Car(x, z, away, body, rgb(*PAINTS[int(rng.integers(len(PAINTS)))]))

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
                things.append(Thing(place, edge, "lamp", 7.4, _seed(rng)))
            elif with_trees:
                things.append(Thing(place, edge + side * 0.3, "tree", float(rng.uniform(6.0, 8.5)), _seed(rng)))
        signs = [float(z) for z in rng.uniform(7, 60, 4)]
        things += [Thing(z, edge, "sign", 2.95, _seed(rng)) for z in signs if clear(z)]
        if road.zebra is not None:
            things.append(Thing(road.zebra - 0.8, edge, "signal", 3.5, _seed(rng)))
        start = float(rng.uniform(6, 34))
        if rng.random() < 0.6 and clear(start) and clear(start + 9):
            row = side * (road.half_width + 0.3)
            things += [Thing(start + 1.9 * place, row, "bollard", 0.95, _seed(rng)) for place in range(5)]
        for z in rng.uniform(6, 50, 3):
            if clear(float(z)):
                kind = "cabinet" if rng.random() < 0.6 else "bush"
                things.append(Thing(float(z), side * (road.wall - 0.55), kind, 1.25, _seed(rng)))
    things += [Thing(float(z), 0.0, "wire", 7.2, _seed(rng)) for z in rng.uniform(9, 70, int(rng.integers(1, 5)))]
    return things
