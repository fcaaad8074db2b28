"""Guard rails beside the road: beams on posts, straight with the street and bent where it bends."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from app.synthesis.bend import Bend
from app.synthesis.furniture import draw_post, post
from app.synthesis.geometry import Drawing, Points
from app.synthesis.light import Light, rgb
from app.synthesis.road import KERB

_STEP = 2.0  # m between posts
_LEVELS = (0.50, 0.60, 0.66, 0.72, 0.82)  # m above the pavement: the folds of the beam
_OUT = (0.0, 0.05, 0.01, 0.05, 0.0)  # m towards the road


@dataclass(frozen=True)
class GuardRail:
    """A rail in the street's plan: its line x, and from where to where along the axis, m."""

    x: float
    z0: float
    z1: float


def rail_places(rail: GuardRail, bend: Bend) -> Points:
    """Places along the axis at which a rail's pieces meet, ``(n,)``."""
    places = [np.array([rail.z0])]
    for begin, end, _ in bend.pieces(rail.z0, rail.z1):
        count = max(round((end - begin) / _STEP), 1)
        places.append(np.linspace(begin, end, count + 1)[1:])
    return np.concatenate(places)


def draw_rail_piece(drawing: Drawing, rail: GuardRail, bend: Bend, z0: float, z1: float, light: Light) -> None:
    """Paint the beam between two places, and the post at the farther one."""
    steel = rgb(176, 182, 186)
    foot = bend.place(rail.x, z1)
    draw_post(drawing, post(foot[0], foot[2] + 0.02, KERB, KERB + 0.7, 0.1), steel * 0.7, light, "guard rail post")
    side = -float(np.sign(rail.x))
    folds = [bend.place(rail.x + side * out, [z0, z1], KERB + level) for level, out in zip(_LEVELS, _OUT, strict=True)]
    for index, (low, high) in enumerate(pairwise(folds)):
        tilt = 0.55 if index % 2 else -0.55
        tone = light.shade(steel, np.array([side, tilt, 0.0]) / np.hypot(1, tilt), sunlit=index % 2 == 1)
        drawing.paint(np.stack([high[0], high[1], low[1], low[0]]), tone, margin=0.2)


def outline_rail(drawing: Drawing, rail: GuardRail, bend: Bend) -> None:
    """Add the folds of a rail: edges where it is straight, distractors where it bends."""
    side = -float(np.sign(rail.x))
    for begin, end, straight in bend.pieces(rail.z0, rail.z1):
        for level, out in zip(_LEVELS, _OUT, strict=True):
            x, height = rail.x + side * out, KERB + level
            if straight:
                drawing.lines(bend.place(x, [begin, end], height)[None], "guard rail")
            else:
                drawing.curve(bend.place(x, bend.steps(begin, end), height), "curved guard rail")
