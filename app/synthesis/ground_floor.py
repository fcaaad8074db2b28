"""What houses have at street level: shops with awnings, doors (some arched) and plain windows."""

from __future__ import annotations

import numpy as np

from app.synthesis.geometry import Drawing, Panel, Points
from app.synthesis.light import Colour, Light, rgb
from app.synthesis.textures import Materials
from app.synthesis.windows import WindowStyle, draw_ledges, draw_windows

SHOP_COLOURS: tuple[tuple[int, int, int], ...] = (
    (38, 74, 84), (124, 38, 40), (44, 62, 48), (52, 48, 58), (178, 128, 52), (196, 196, 188), (34, 52, 96),
)  # fmt: skip

_READABLE_WITHIN = 24.0  # m; farther lettering isn't drawn


def draw_ground_floor(
    drawing: Drawing,
    panel: Panel,
    width: float,
    height: float,
    style: WindowStyle,
    *,
    eye: Points,
    light: Light,
    materials: Materials,
    rng: np.random.Generator,
    detailed: bool = True,
) -> None:
    """Divide a ground floor of width x height m into bays and fill each with a shop, a door or a window."""
    count = max(int(width / float(rng.uniform(3.2, 4.4))), 1)
    bay = width / count
    shops = rng.random() < 0.55
    shop_colour = rgb(*SHOP_COLOURS[int(rng.integers(len(SHOP_COLOURS)))])
    door_at = int(rng.integers(count))
    arched = rng.random() < 0.45
    for index in range(count):
        left, right = index * bay, (index + 1) * bay
        bay_rng = np.random.default_rng(rng.integers(2**32))
        if index == door_at:
            _draw_door(drawing, panel, (left + right) / 2, height, arched, style, eye, light, bay_rng, detailed)
        elif shops:
            _draw_shop(drawing, panel, left, right, height, shop_colour, eye, light, materials, bay_rng, detailed)
        else:
            middle, half = (left + right) / 2, min(bay * 0.3, 0.75)
            box = [middle - half, 1.1, middle + half, min(height - 0.75, 2.9)]
            draw_windows(
                drawing,
                panel,
                box,
                style,
                eye=eye,
                light=light,
                materials=materials,
                rng=bay_rng,
                detailed=detailed,
            )


def _draw_shop(
    drawing: Drawing,
    panel: Panel,
    left: float,
    right: float,
    height: float,
    colour: Colour,
    eye: Points,
    light: Light,
    materials: Materials,
    rng: np.random.Generator,
    detailed: bool,
) -> None:
    front = [left + 0.12, 0.05, right - 0.12, height - 0.14]
    drawing.paint(panel.rectangles(front), light.shade(colour, panel.normal), kind="shop front")
    style = WindowStyle(
        colour, colour, np.clip(colour * 1.15 + 12, 0, 255), recess=0.12, surround=0.0, columns=2, sill=False
    )
    box = [left + 0.3, 0.55, right - 0.3, height - 1.2]
    draw_windows(drawing, panel, box, style, eye=eye, light=light, materials=materials, rng=rng, detailed=detailed)
    sign = [left + 0.12, height - 1.0, right - 0.12, height - 0.44]
    board = np.clip(colour * 0.7 + 70, 0, 255) if rng.random() < 0.5 else colour
    draw_ledges(drawing, panel, sign, 0.1, board, eye=eye, light=light, kind="shop sign")
    has_awning = rng.random() < 0.55
    if np.linalg.norm(panel.point(left, height) - eye) < _READABLE_WITHIN:
        _draw_lettering(drawing, panel, sign, board, light, rng)
    if has_awning:
        _draw_awning(drawing, panel, left + 0.2, right - 0.2, height - 1.04, colour, eye, light)


def _draw_lettering(
    drawing: Drawing, panel: Panel, sign: list[float], board: Colour, light: Light, rng: np.random.Generator
) -> None:
    """Round letters on a sign: discs and rings, none of them with a straight edge."""
    middle, size = (sign[1] + sign[3]) / 2, 0.13
    letters = int((sign[2] - sign[0]) * 0.55 / (size * 2.3))
    start = (sign[0] + sign[2]) / 2 - letters * size * 1.15
    ink = rgb(244, 238, 220) if board.mean() < 120 else rgb(50, 46, 44)
    turn = np.linspace(0, 2 * np.pi, 14, endpoint=False)
    for letter in range(letters):
        if rng.random() < 0.15:
            continue
        u = start + (letter + 0.5) * size * 2.3
        for radius, tone in ((size, ink), (size * float(rng.choice([0.5, 0.6])), board)):
            ring = panel.point(u + 0.72 * radius * np.cos(turn), middle + radius * np.sin(turn), 0.1)
            drawing.paint(ring, light.shade(tone, panel.normal))


def _draw_awning(
    drawing: Drawing,
    panel: Panel,
    left: float,
    right: float,
    top: float,
    colour: Colour,
    eye: Points,
    light: Light,
) -> None:
    out, drop = 1.15, 0.55
    count = max(2 * int((right - left) / 0.5) // 2, 2)
    edges = np.linspace(left, right, count + 1)
    pale = rgb(238, 232, 218)
    slope = panel.normal * drop + np.array([0, -out, 0])
    slope /= np.linalg.norm(slope)
    inner, outer = edges[:-1], edges[1:]
    u = np.stack([inner, outer, outer, inner], axis=1)
    tones = np.where((np.arange(count) % 2 == 0)[:, None], colour, pale)
    cloth = panel.point(u, np.array([top, top, top - drop, top - drop]), np.array([0.0, 0, out, out]))
    below = panel.locate(eye)[1] < top - drop
    drawing.paint(cloth, light.shade(tones, slope, sunlit=not below) * (0.9 if below else 1.0), kind="awning")
    valance = panel.point(u, np.array([top - drop, top - drop, top - drop - 0.2, top - drop - 0.2]), out)
    drawing.paint(valance, light.shade(tones, panel.normal), kind="awning")


def _draw_door(
    drawing: Drawing,
    panel: Panel,
    middle: float,
    height: float,
    arched: bool,
    style: WindowStyle,
    eye: Points,
    light: Light,
    rng: np.random.Generator,
    detailed: bool,
) -> None:
    half = float(rng.uniform(0.6, 0.85))
    top = min(height - 0.9, 2.5)
    wood = rgb(*[(92, 60, 44), (44, 70, 62), (52, 58, 84), (110, 44, 40)][int(rng.integers(4))])
    if arched:
        _draw_arch(drawing, panel, middle, half + 0.16, top, light.shade(style.trim, panel.normal))
        _draw_arch(drawing, panel, middle, half, top, light.shade(wood * 0.72, panel.normal, sunlit=False))
    else:
        surround = panel.rectangles([middle - half - 0.16, 0.12, middle + half + 0.16, top + 0.16])
        drawing.paint(surround, light.shade(style.trim, panel.normal), kind="door surround")
        opening = panel.rectangles([middle - half, 0.12, middle + half, top])
        drawing.paint(opening, light.shade(wood * 0.72, panel.normal, sunlit=False), kind="door")
    if not detailed:
        return
    for side in (-1, 1):
        edges = sorted((middle + side * 0.04, middle + side * (half - 0.06)))
        for low, high in ((0.25, 1.05), (1.2, top - 0.12)):
            leaf = panel.rectangles([edges[0], low, edges[1], high])
            drawing.paint(leaf, light.shade(wood, panel.normal, sunlit=False), kind="door panel")
    step = [middle - half - 0.3, 0.0, middle + half + 0.3, 0.13]
    draw_ledges(drawing, panel, step, 0.4, rgb(168, 162, 152), eye=eye, light=light, kind="door step", soft_shadow=0)


def _draw_arch(drawing: Drawing, panel: Panel, middle: float, half: float, spring: float, colour: Colour) -> None:
    """An opening with a round head: its jambs are straight, its head is not."""
    turn = np.linspace(0, np.pi, 25)
    head = panel.point(middle + half * np.cos(turn), spring + half * 0.8 * np.sin(turn))
    foot = panel.point([middle - half, middle + half], 0.12)
    drawing.paint(np.concatenate([head, foot]), colour)
    drawing.curve(head, "arch")
    drawing.lines(np.stack([[head[0], foot[1]], [head[-1], foot[0]]]), "door surround")
