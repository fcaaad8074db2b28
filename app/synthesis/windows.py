"""Openings in a wall: set back behind it, with frame, glass, sill and surround; and ledges that stand out of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from app.synthesis.geometry import Drawing, Panel, Points, texture_on
from app.synthesis.light import Colour, Light
from app.synthesis.textures import Materials, fading_shadow

_SOFT_SHADOW = fading_shadow(0.42)
_GLASS_BEYOND = 55.0  # m; farther windows are drawn as panes alone


@dataclass(frozen=True, eq=False)
class WindowStyle:
    """How the windows of one house look. Lengths in m, colours as painted (before light)."""

    wall: Colour
    trim: Colour
    frame: Colour
    recess: float = 0.18
    surround: float = 0.12
    columns: int = 2
    rows: int = 1
    sill: bool = True
    shutters: Colour | None = None


def draw_windows(
    drawing: Drawing,
    panel: Panel,
    boxes: ArrayLike,
    style: WindowStyle,
    *,
    eye: Points,
    light: Light,
    materials: Materials,
    rng: np.random.Generator,
    detailed: bool = True,
) -> None:
    """Draw windows at boxes ``(n, 4)`` (u0, v0, u1, v1 on the panel, m) as seen from `eye`."""
    boxes = np.atleast_2d(np.asarray(boxes, float))
    choice = rng.integers(len(materials.panes), size=len(boxes) * style.columns * style.rows)
    if not len(boxes):
        return
    if not detailed and np.linalg.norm(panel.point(*boxes[0, :2]) - eye) > _GLASS_BEYOND:
        glass = np.array([materials.panes[int(pick)][20, 12, :3] for pick in choice[: len(boxes)]])
        drawing.paint(panel.rectangles(boxes), glass, kind="window opening")
        return
    facade_light = light.shade(style.trim, panel.normal)
    if style.shutters is not None and detailed:
        _draw_shutters(drawing, panel, boxes, style, light)
    if style.surround and detailed:
        grown = boxes + np.array([-1, -1, 1, 1]) * style.surround
        drawing.paint(panel.rectangles(grown), facade_light, kind="window surround")

    hole = _Recess(panel, boxes, style.recess, eye)
    side = light.shade(style.wall, -np.sign(hole.eye[0] - boxes[:, 0])[:, None] * -panel.along, sunlit=False)
    drawing.paint(hole.visible(boxes), side * 0.82)
    drawing.outline(panel.rectangles(boxes), "window opening")
    if detailed:
        _draw_heads(drawing, hole, boxes, light.shade(style.wall, (0, 1, 0)) * 0.7)
    drawing.paint(hole.visible(boxes, inside=True), light.shade(style.frame, panel.normal, sunlit=False))
    drawing.outline(panel.rectangles(boxes, -style.recess), "window frame")
    _draw_glass(drawing, hole, boxes, style, materials, choice, detailed)
    if style.sill and detailed:
        sills = np.stack([boxes[:, 0] - 0.1, boxes[:, 1] - 0.13, boxes[:, 2] + 0.1, boxes[:, 1] - 0.01], axis=1)
        draw_ledges(drawing, panel, sills, 0.13, style.trim, eye=eye, light=light, kind="window sill")


class _Recess:
    """A plane behind the wall, and what of it can be seen through the openings in the wall."""

    def __init__(self, panel: Panel, boxes: NDArray[np.float64], depth: float, eye: Points) -> None:
        self.panel, self.boxes, self.depth = panel, boxes, depth
        self.eye = panel.locate(eye)
        distance = max(float(self.eye[2]), 0.05)
        self.stretch = (distance + depth) / distance  # central projection between parallel planes is a scaling

    def onto(self, boxes: NDArray[np.float64]) -> NDArray[np.float64]:
        """Boxes on the wall, projected from the eye onto the recessed plane."""
        centre = np.tile(self.eye[:2], 2)
        return centre + (boxes - centre) * self.stretch

    def clip(self, boxes: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        """The visible part of boxes on the recessed plane (one for each opening), and which have one."""
        window = self.onto(self.boxes)
        low = np.maximum(boxes[:, :2], window[:, :2])
        high = np.minimum(boxes[:, 2:], window[:, 2:])
        return np.concatenate([low, high], axis=1), np.min(high - low, axis=1) > 0.01

    def visible(self, boxes: NDArray[np.float64], inside: bool = False) -> Points:
        """Corners ``(m, 4, 3)`` of what is seen of the recessed plane: all, or only what lies inside the boxes."""
        if not inside:
            return self.panel.rectangles(self.onto(boxes), -self.depth)
        clipped, seen = self.clip(boxes)
        return self.panel.rectangles(clipped[seen], -self.depth) if seen.any() else np.zeros((0, 4, 3))


def _draw_heads(drawing: Drawing, hole: _Recess, boxes: NDArray[np.float64], colour: Colour) -> None:
    """The undersides of lintels above the eye: between the wall's edge and the recessed plane's."""
    window = hole.onto(boxes)
    above = window[:, 3] > boxes[:, 3] + 0.004
    if not above.any():
        return
    boxes, window = boxes[above], window[above]
    left = np.clip(boxes[:, 0], window[:, 0], window[:, 2])
    right = np.clip(boxes[:, 2], window[:, 0], window[:, 2])
    u = np.stack([window[:, 0], window[:, 2], right, left], axis=1)
    v = np.stack([window[:, 3], window[:, 3], boxes[:, 3], boxes[:, 3]], axis=1)
    drawing.paint(hole.panel.point(u, v, -hole.depth), colour)


def _draw_glass(
    drawing: Drawing,
    hole: _Recess,
    boxes: NDArray[np.float64],
    style: WindowStyle,
    materials: Materials,
    choice: NDArray[np.int64],
    detailed: bool,
) -> None:
    columns, rows = (style.columns, style.rows) if detailed else (1, 1)
    bar = 0.07
    width = (boxes[:, 2] - boxes[:, 0] - bar * (columns + 1)) / columns
    height = (boxes[:, 3] - boxes[:, 1] - bar * (rows + 1)) / rows
    for column in range(columns):
        for row in range(rows):
            u0 = boxes[:, 0] + bar + column * (width + bar)
            v0 = boxes[:, 1] + bar + row * (height + bar)
            glass = np.stack([u0, v0, u0 + width, v0 + height], axis=1)
            clipped, seen = hole.clip(glass)
            if not seen.any():
                continue
            whole = hole.panel.rectangles(glass, -hole.depth)
            picks = choice[(np.arange(len(boxes)) * columns + column) % len(choice)]
            textures = [texture_on(whole[i], materials.panes[int(picks[i])]) for i in np.flatnonzero(seen)]
            drawing.paint(hole.panel.rectangles(clipped[seen], -hole.depth), (60, 70, 82), textures=textures)
            drawing.outline(whole[seen], "window pane")


def _draw_shutters(
    drawing: Drawing, panel: Panel, boxes: NDArray[np.float64], style: WindowStyle, light: Light
) -> None:
    if style.shutters is None:
        return
    width = (boxes[:, 2] - boxes[:, 0]) / 2
    gap = style.surround + 0.03
    for u0 in (boxes[:, 0] - gap - width, boxes[:, 2] + gap):
        leaves = np.stack([u0, boxes[:, 1], u0 + width, boxes[:, 3]], axis=1)
        drawing.paint(panel.rectangles(leaves), light.shade(style.shutters, panel.normal), kind="shutter")
        for low, high in ((0.08, 0.47), (0.53, 0.92)):
            tall = leaves[:, 3] - leaves[:, 1]
            inset = np.stack(
                [leaves[:, 0] + 0.07, leaves[:, 1] + low * tall, leaves[:, 2] - 0.07, leaves[:, 1] + high * tall], 1
            )
            drawing.paint(panel.rectangles(inset), light.shade(style.shutters * 0.8, panel.normal), kind="shutter")


def draw_ledges(
    drawing: Drawing,
    panel: Panel,
    boxes: ArrayLike,
    out: float,
    colour: Colour,
    *,
    eye: Points,
    light: Light,
    kind: str,
    soft_shadow: float = 0.35,
) -> None:
    """Draw bars that stand out of a wall by `out` m (sills, bands, cornices, gutters) with a soft shadow below.

    Args:
        drawing: What to draw into.
        panel: The wall.
        boxes: ``(n, 4)`` u0, v0, u1, v1 of their front faces, m.
        out: How far they stand out, m.
        colour: As painted.
        eye: Where they are seen from.
        light: The light.
        kind: Name of their edges.
        soft_shadow: How far down the wall their shadow fades, m; 0 for none.
    """
    boxes = np.atleast_2d(np.asarray(boxes, float))
    u0, v0, u1, v1 = boxes.T
    eye_u, eye_v, _ = panel.locate(eye)
    if soft_shadow:
        below = panel.rectangles(boxes[:, [0, 1, 2, 1]] - np.array([0.0, soft_shadow, 0.0, 0.0]))
        drawing.paint(below, (0, 0, 0), textures=[texture_on(corners, _SOFT_SHADOW) for corners in below])

    before = eye_u < u0
    ended = before | (eye_u > u1)
    if ended.any():
        end = np.where(before, u0, u1)[:, None]
        ends = panel.point(end, boxes[:, [3, 3, 1, 1]], np.array([0.0, out, out, 0.0]))
        outward = np.where(before, -1.0, 1.0)[:, None] * panel.along
        drawing.paint(ends[ended], light.shade(colour, outward)[ended], kind=kind)

    above = v0 > eye_v
    levelled = above | (v1 < eye_v)
    if levelled.any():
        level = np.where(above, v0, v1)[:, None]
        decks = panel.point(boxes[:, [0, 2, 2, 0]], level, np.array([0.0, 0.0, out, out]))
        facing = np.where(above, 1.0, -1.0)[:, None] * np.array([0.0, 1.0, 0.0])
        tone = light.shade(colour, facing) * np.where(above, 0.72, 1.0)[:, None].astype(np.float32)
        drawing.paint(decks[levelled], tone[levelled], kind=kind)
    drawing.paint(panel.rectangles(boxes, out), light.shade(colour, panel.normal), kind=kind)
