"""Reviewed lines of scenes of which it is known what they tell of a camera's focal length.

Built scenes are only about square: directions called square differ by some tenths of a degree, and so do edges called
parallel. Both are drawn anew for every camera, from exact to twice as bad as usual.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from app.calibration.calibration_image import CalibrationImage
from app.calibration.lens import CameraLens
from app.vision.frame import center_of, half_diagonal
from app.vision.segments import Segments

Array = NDArray[np.float64]
Kind = Literal["square", "street", "oblique", "single"]
KINDS: tuple[Kind, ...] = get_args(Kind)
"""Square buildings seen at an angle; a street seen along its axis; buildings whose walls meet at any angle, the same
in all images; one direction alone."""
SIZES = ((640, 480), (1024, 768), (1280, 720), (1300, 398), (1920, 1080))


@dataclass(frozen=True, eq=False)
class BuiltScene:
    """Lines of one camera; truth in px.

    Attributes:
        images: Its images.
        lens: Its true lens.
        focal_length: Of the undistorted image.
        principal_point: Likewise.
    """

    images: tuple[CalibrationImage, ...]
    lens: CameraLens
    focal_length: float
    principal_point: tuple[float, float]


def draw_scene(kind: Kind, seed: int, *, images: int | None = None, lines: int | None = None) -> BuiltScene:
    """Draw a camera and the lines of its images; the same for the same seed.

    Args:
        kind: What the camera looks at.
        seed: From 0 up.
        images: Their number; 1 to 12 where it isn't said.
        lines: Of each image; 20 to 100 where it isn't said.
    """
    rng = np.random.default_rng([seed, KINDS.index(kind), 6])
    width, height = SIZES[rng.integers(len(SIZES))]
    scale = half_diagonal(width, height)
    focal = float(np.exp(rng.uniform(np.log(0.8), np.log(3.0)))) * scale
    offset = rng.normal(0, 0.025, 2) * scale
    lens = _draw_lens(rng, width, height)
    xc, yc = center_of(width, height)
    center = (xc + float(offset[0]), yc + float(offset[1]))
    number = images or int(rng.integers(1, 13))
    each = lines or int(rng.integers(20, 101))
    badness = rng.uniform(0, 2)
    painter = _Painter(rng, lens, focal, center, np.deg2rad(0.15) * badness, float(np.exp(rng.normal(-2.0, 0.5))))
    corner = float(np.deg2rad(rng.choice([rng.uniform(45, 78), rng.uniform(102, 135)])))
    drawn = []
    for index in range(number):
        axes = _axes(rng, kind, corner) + rng.normal(0, np.deg2rad(0.3) * badness, (3, 3))
        share = [0.0, 0.85, 0.0, 0.15] if kind == "single" else [0.3, 0.35, 0.25, 0.1]
        if kind == "oblique":
            share = [0.5, 0.0, 0.4, 0.1]
        drawn.append(CalibrationImage(f"{index:03}", painter.lines(axes, share, each)))
    return BuiltScene(tuple(drawn), lens, focal, center)


def _draw_lens(rng: np.random.Generator, width: int, height: int) -> CameraLens:
    while True:
        parameters = (rng.uniform(-0.03, 0.25), rng.uniform(-0.03, 0.05), 0.0, 0.0, 0.0, *rng.normal(0, 0.01, 2))
        lens = CameraLens("brown", width, height, tuple(map(float, parameters)))
        if lens.is_invertible():
            return lens


def _axes(rng: np.random.Generator, kind: Kind, corner: float) -> Array:
    """Directions of walls' breadth, the vertical and walls' depth in the camera's axes, one per row."""
    yaw, pitch, roll = rng.uniform(-np.pi, np.pi), rng.normal(0, 0.12), rng.normal(0, 0.03)
    if kind == "street":
        yaw, pitch, roll = rng.normal(0, 0.03), rng.normal(0.02, 0.012), rng.normal(0, 0.01)
    (cy, sy), (cp, sp), (cr, sr) = ((np.cos(a), np.sin(a)) for a in (yaw, pitch, roll))
    turn = np.array([[cy, 0, -sy], [0, 1, 0], [sy, 0, cy]])
    tilt = np.array([[1, 0, 0], [0, cp, sp], [0, -sp, cp]])
    lean = np.array([[cr, sr, 0], [-sr, cr, 0], [0, 0, 1]])
    world = np.eye(3)
    if kind == "oblique":
        world[2] = [np.cos(corner), 0, np.sin(corner)]
    return np.asarray(world @ (lean @ tilt @ turn).T, np.float64)


@dataclass(frozen=True, eq=False)
class _Painter:
    """Draws measured lines; `parallel` in rad, `noise` in px."""

    rng: np.random.Generator
    lens: CameraLens
    focal: float
    center: tuple[float, float]
    parallel: float
    noise: float

    def lines(self, axes: Array, share: list[float], number: int) -> Segments:
        """Lines towards each axis and, for the last share, anywhere."""
        found: list[Array] = []
        while len(found) < number:
            axis = int(self.rng.choice(4, p=share))
            towards = axes[axis] if axis < 3 else self.rng.normal(0, 1, 3)
            points = self._line(towards + self.rng.normal(0, self.parallel, 3) * (axis < 3))
            if points is not None:
                found.append(points)
        return Segments.from_list(found)

    def _line(self, towards: Array) -> Array | None:
        size = np.array([self.lens.width - 1.0, self.lens.height - 1.0])
        middle = self.lens.undistort(self.rng.uniform(0.03, 0.97, 2)[None] * size)[0]
        along = self.focal * towards[:2] - (middle - self.center) * towards[2]
        along /= np.hypot(*along)
        half = 30 + self.rng.exponential(0.09 * self.lens.scale)
        points = self.lens.distort(middle + np.arange(-half, half)[:, None] * along)
        inside = np.isfinite(points).all(1) & (points >= 0).all(1) & (points <= size).all(1)
        points = points[inside]
        if len(points) < 50:
            return None
        noise = np.convolve(self.rng.normal(0, self.noise, len(points) + 2), np.ones(3) / np.sqrt(3), "valid")
        return np.asarray(points + noise[:, None] * [-along[1], along[0]], np.float64)
