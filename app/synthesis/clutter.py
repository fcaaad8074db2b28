"""What lies on the ground and is no straight edge: covers, patches and seams of tar."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.synthesis.geometry import Drawing
from app.synthesis.light import Light, rgb
from app.synthesis.road import Road

_UP = (0, -1, 0)


@dataclass(frozen=True)
class Spot:
    """One thing on the carriageway, in the street's plan.

    Attributes:
        kind: "manhole cover", "road patch" or "road seam".
        x: m to the right of the axis.
        z: m along the axis.
        size: Radius, or length along the axis, m.
        seed: Of its shape.
    """

    kind: str
    x: float
    z: float
    size: float
    seed: int


def plan_clutter(rng: np.random.Generator, road: Road) -> tuple[Spot, ...]:
    """Scatter covers, patches and seams over a carriageway."""
    reach = road.half_width - 1.0

    def spot(kind: str, low: float, high: float) -> Spot:
        z = 2.5 + 55 * float(rng.random()) ** 1.7
        return Spot(kind, float(rng.uniform(-reach, reach)), z, float(rng.uniform(low, high)), int(rng.integers(2**31)))

    covers = [spot("manhole cover", 0.28, 0.4) for _ in range(int(rng.integers(1, 5)))]
    patches = [spot("road patch", 0.25, 0.8) for _ in range(int(rng.integers(1, 5)))]
    seams = [spot("road seam", 4.0, 16.0) for _ in range(int(rng.integers(2, 7)))]
    return (*patches, *seams, *covers)


def draw_clutter(drawing: Drawing, spots: tuple[Spot, ...], road: Road, light: Light) -> None:
    """Draw what lies on the carriageway, before shadows fall on it."""
    tarmac = light.shade(rgb(104, 105, 110), _UP)
    for spot in spots:
        rng = np.random.default_rng(spot.seed)
        if spot.kind == "road seam":
            _draw_seam(drawing, spot, road, tarmac * np.float32(rng.uniform(0.5, 0.75)), rng)
            continue
        turn = np.linspace(0, 2 * np.pi, 36, endpoint=False)
        if spot.kind == "manhole cover":
            radius, tone = np.full(36, spot.size), light.shade(rgb(78, 74, 72), _UP)
        else:
            waves = [float(rng.normal(0, 0.12 / n)) * np.cos(n * turn + float(rng.uniform(0, 6))) for n in (2, 3, 4)]
            radius, tone = spot.size * (1 + sum(waves)), tarmac * np.float32(rng.choice([0.72, 0.8, 1.18]))
        rim = road.bend.place(spot.x + radius * np.cos(turn) * 0.8, spot.z + radius * np.sin(turn) * 1.3)
        drawing.paint(rim, tone)
        drawing.curve(np.concatenate([rim, rim[:1]]), spot.kind)


def _draw_seam(drawing: Drawing, spot: Spot, road: Road, tone: np.ndarray, rng: np.random.Generator) -> None:
    """A crack that was filled: a band along the road that wanders."""
    along = np.linspace(0, spot.size, 24)
    phase, wave = float(rng.uniform(0, 6)), float(rng.uniform(1.5, 4.0))
    x = spot.x + 0.12 * np.sin(along / wave + phase) + 0.05 * np.sin(2.7 * along / wave) + 0.06 * along * rng.normal()
    half = 0.035 + 0.012 * np.sin(3 * along + phase)
    left, right = road.bend.place(x - half, spot.z + along), road.bend.place(x + half, spot.z + along)
    drawing.paint(np.stack([left[:-1], left[1:], right[1:], right[:-1]], axis=1), tone, margin=0.2)
    drawing.curve(left, "road seam")
    drawing.curve(right, "road seam")
