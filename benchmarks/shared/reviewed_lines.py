"""Lines of a camera with a known lens as a reviewer leaves them: nearly all straight, few of them not.

Points are computed, no image is rendered, so that calibrations can be measured over many cameras in little time. The
lenses are of kinds that cameras have, of which most follow none of the models of `app.calibration` exactly.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, Protocol, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from app.calibration.lens import CameraLens, Family
from app.vision.frame import center_of, frame_grid, half_diagonal
from app.vision.segments import Segments

Array = NDArray[np.float64]
Kind = Literal["opencv", "opencv full", "fisheye", "brown", "division"]
KINDS: tuple[Kind, ...] = get_args(Kind)
KIND_SHARES = (0.35, 0.25, 0.15, 0.15, 0.1)
SIZES = ((640, 480), (480, 640), (1024, 768), (1280, 720), (1392, 512), (1920, 1080))
SHORTEST = 40.0
"""px of a line."""
LEAST_DETERMINANT = 0.25
"""Area ratio that no lens goes below on its frame."""
STEP = 0.5
"""px over which the ratio is taken."""


class TrueLens(Protocol):
    """A lens in both directions."""

    @property
    def width(self) -> int:
        """Of the image, px."""
        ...

    @property
    def height(self) -> int:
        """Likewise."""
        ...

    def undistort(self, points: ArrayLike) -> Array:
        """Map measured points ``(N, 2)`` in px to corrected ones."""
        ...

    def distort(self, points: ArrayLike) -> Array:
        """Map corrected points ``(N, 2)`` in px to measured ones; NaN where there is none."""
        ...


@dataclass(frozen=True)
class FisheyeLens:
    """A lens whose radius grows with the angle: ``r_d = f theta (1 + k theta^2)``, ``r_u = f tan theta``.

    The first term of the model of Kannala and Brandt (2006).

    Attributes:
        width: Of the image, px.
        height: Likewise.
        focal: f in px.
        k: Coefficient.
        center: Distortion centre in px.
    """

    width: int
    height: int
    focal: float
    k: float
    center: tuple[float, float]

    def undistort(self, points: ArrayLike) -> Array:
        """Map measured points ``(N, 2)`` in px to corrected ones; NaN at right angles to the axis and beyond."""
        offset = np.asarray(points, np.float64).reshape(-1, 2) - self.center
        radius = np.hypot(*offset.T) / self.focal
        theta = radius.copy()
        for _ in range(20):
            theta -= (theta * (1 + self.k * theta**2) - radius) / (1 + 3 * self.k * theta**2)
        theta = np.where(theta < 0.49 * np.pi, theta, np.nan)
        return self.center + offset * (np.tan(theta) / np.maximum(radius, 1e-12))[:, None]

    def distort(self, points: ArrayLike) -> Array:
        """Map corrected points ``(N, 2)`` in px to measured ones."""
        offset = np.asarray(points, np.float64).reshape(-1, 2) - self.center
        radius = np.hypot(*offset.T) / self.focal
        theta = np.arctan(radius)
        return self.center + offset * (theta * (1 + self.k * theta**2) / np.maximum(radius, 1e-12))[:, None]


@dataclass(frozen=True)
class ReviewConditions:
    """How many lines there are and how good.

    Attributes:
        images: Number of images.
        lines: Of all images together.
        wrong_share: Share of them that aren't straight, 0 to 1.
        noise: px, standard deviation of points across their line.
        correlation: Points over which the noise is smoothed (Gaussian); 0 for independent points.
        lengths: Shortest and longest line in px; each length's logarithm is as likely.
        any_direction: Whether lines run anywhere; else towards three directions of a scene, mostly.
    """

    images: int
    lines: int
    wrong_share: float
    noise: float
    correlation: float
    lengths: tuple[float, float] = (60.0, 400.0)
    any_direction: bool = False


@dataclass(frozen=True, eq=False)
class ReviewedCamera:
    """Lines of one camera, and the truth about them.

    Attributes:
        kind: Of its lens.
        lens: What the lines are seen through.
        conditions: How they were drawn.
        segments: Of each image, px.
        straight: For each image, bool ``(S,)``.
    """

    kind: Kind
    lens: TrueLens
    conditions: ReviewConditions
    segments: tuple[Segments, ...]
    straight: tuple[NDArray[np.bool_], ...]


def draw_reviewed_camera(seed: int) -> ReviewedCamera:
    """Draw a lens and its lines, the same for the same seed.

    1 to 20 images, 15 to 300 lines, noise of 0.05 to 0.4 px (equal ratios as likely) that neighbouring points share,
    0 to 5 % of lines that are no straight ones.
    """
    rng = np.random.default_rng(seed)
    lines = round(float(np.exp(rng.uniform(np.log(15), np.log(300)))))
    conditions = ReviewConditions(
        images=min(round(float(np.exp(rng.uniform(0, np.log(20))))), lines),
        lines=lines,
        wrong_share=float(rng.uniform(0, 0.05)),
        noise=float(np.exp(rng.uniform(np.log(0.05), np.log(0.4)))),
        correlation=float(rng.uniform(0.5, 3.0)),
    )
    width, height = SIZES[rng.integers(len(SIZES))]
    kind = KINDS[rng.choice(len(KINDS), p=KIND_SHARES)]
    lens = draw_true_lens(rng, kind, width, height)
    segments, straight = draw_reviewed_lines(rng, lens, conditions)
    return ReviewedCamera(kind, lens, conditions, segments, straight)


def draw_true_lens(rng: np.random.Generator, kind: Kind, width: int, height: int) -> TrueLens:
    """Draw a lens of a kind, from plain to wide, one-to-one on its frame with a margin."""
    while True:
        lens = _drawn(rng, kind, width, height)
        corrected = lens.undistort(frame_grid(width, height, 40))
        if not np.isfinite(corrected).all() or np.abs(corrected).max() > 4 * max(width, height):
            continue
        if isinstance(lens, FisheyeLens) or _least_determinant(lens) > LEAST_DETERMINANT:
            return lens


def draw_reviewed_lines(
    rng: np.random.Generator, lens: TrueLens, conditions: ReviewConditions
) -> tuple[tuple[Segments, ...], tuple[NDArray[np.bool_], ...]]:
    """Draw the lines of a camera's images, and which of them are straight."""
    wrong = rng.random(conditions.lines) < conditions.wrong_share
    of_image = rng.permutation(np.arange(conditions.lines) % conditions.images)
    segments: list[Segments] = []
    straight: list[NDArray[np.bool_]] = []
    for image in range(conditions.images):
        vanishing = _vanishing_points(rng, lens)
        bent = wrong[of_image == image]
        segments.append(Segments.from_list([_line(rng, lens, conditions, vanishing, bool(each)) for each in bent]))
        straight.append(~bent)
    return tuple(segments), tuple(straight)


def _drawn(rng: np.random.Generator, kind: Kind, width: int, height: int) -> TrueLens:
    center = rng.normal(0, 0.012, 2)
    if kind == "fisheye":
        focal = half_diagonal(width, height) / rng.uniform(0.3, 1.1)
        x, y = np.add(center_of(width, height), half_diagonal(width, height) * center)
        return FisheyeLens(width, height, focal, float(rng.normal(0, 0.05)), (float(x), float(y)))
    # OpenCV's coefficients belong to the focal length; a half diagonal is 0.5 to 1.0 focal lengths
    wide = rng.uniform(0.5, 1.0)
    k1 = (rng.uniform(-0.4, 0.0) if rng.random() < 0.8 else rng.uniform(0.0, 0.12)) * wide**2
    k2 = 0.0 if rng.random() < 0.4 else -k1 * rng.uniform(0.1, 0.6) * wide**2
    full = kind == "opencv full"
    k3 = float(rng.normal(0, 0.05) * wide**6) if full else 0.0
    p1, p2 = rng.normal(0, 0.001, 2) * wide if full else (0.0, 0.0)
    family: Family = "opencv" if kind.startswith("opencv") else "brown" if kind == "brown" else "division"
    sign = 1.0 if family == "opencv" else -1.0
    tangential = () if family == "division" else (float(p1), float(p2))
    return CameraLens(
        family,
        width,
        height,
        (sign * k1, sign * k2 * (0.5 if sign < 0 else 1.0), sign * k3, *tangential, *map(float, center)),
    )


def _least_determinant(lens: TrueLens) -> float:
    grid = frame_grid(lens.width, lens.height, 40)
    across, downwards = STEP * np.eye(2)
    along = (lens.undistort(grid + across) - lens.undistort(grid - across)) / (2 * STEP)
    down = (lens.undistort(grid + downwards) - lens.undistort(grid - downwards)) / (2 * STEP)
    determinant = along[:, 0] * down[:, 1] - along[:, 1] * down[:, 0]
    inverse = np.where(determinant > 0, 1 / np.where(determinant > 0, determinant, 1.0), 0.0)
    return float(min(determinant.min(), inverse.min()))


def _vanishing_points(rng: np.random.Generator, lens: TrueLens) -> Array:
    """Return three vanishing points ``(3, 3)``, homogeneous, px of the corrected image."""
    yaw, pitch, roll = rng.uniform(-np.pi, np.pi), rng.normal(0, 0.1), rng.normal(0, 0.03)
    (cy, sy), (cp, sp), (cr, sr) = ((np.cos(a), np.sin(a)) for a in (yaw, pitch, roll))
    turn = np.array([[cy, 0, -sy], [0, 1, 0], [sy, 0, cy]])
    tilt = np.array([[1, 0, 0], [0, cp, sp], [0, -sp, cp]])
    lean = np.array([[cr, sr, 0], [-sr, cr, 0], [0, 0, 1]])
    focal = 0.9 * max(lens.width, lens.height)
    xc, yc = center_of(lens.width, lens.height)
    camera = np.array([[focal, 0, xc], [0, focal, yc], [0, 0, 1]])
    return (camera @ lean @ tilt @ turn).T


def _line(
    rng: np.random.Generator, lens: TrueLens, conditions: ReviewConditions, vanishing: Array, wrong: bool
) -> Array:
    size = np.array([lens.width - 1.0, lens.height - 1.0])
    while True:
        middle = lens.undistort(rng.uniform(0.02, 0.98, 2) * size)[0]
        towards = (
            vanishing[rng.integers(3)] if rng.random() < 0.9 else rng.normal(0, 1, 3) * [lens.width, lens.width, 1]
        )
        along = towards[:2] - middle * towards[2]
        angle = rng.uniform(0, np.pi) if conditions.any_direction else float(np.arctan2(along[1], along[0]))
        wanted = float(np.exp(rng.uniform(*np.log(conditions.lengths))))
        reach = np.linspace(-3 * wanted, 3 * wanted, 601)
        curvature = rng.choice([-1, 1]) * rng.uniform(4, 40) * 8 / wanted**2 if wrong else 0.0
        path = middle + np.outer(reach, [np.cos(angle), np.sin(angle)])
        path += np.outer(curvature * reach**2 / 2, [-np.sin(angle), np.cos(angle)])
        points = _cut(lens.distort(path), size, wanted)
        if len(points) > SHORTEST:
            return _shaken(rng, points, conditions, size)


def _cut(path: Array, size: Array, wanted: float) -> Array:
    """Return points about every px of the part around the path's middle that lies in the frame, `wanted` px long."""
    inside: NDArray[np.bool_] = np.all(np.isfinite(path) & (path >= 0) & (path <= size), axis=1)
    centre = len(path) // 2
    outside = np.flatnonzero(~inside)
    first = outside[outside < centre].max(initial=-1) + 1
    last = outside[outside > centre].min(initial=len(path))
    path = path[first:last]
    if not inside[centre] or len(path) < 2:
        return np.zeros((0, 2))
    arc = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))])
    at, end = float(arc[centre - first]), float(arc[-1])
    places = np.arange(max(at - wanted / 2, 0.0), min(at + wanted / 2, end))
    return np.stack([np.interp(places, arc, path[:, 0]), np.interp(places, arc, path[:, 1])], -1)


def _shaken(rng: np.random.Generator, points: Array, conditions: ReviewConditions, size: Array) -> Array:
    chord = points[-1] - points[0]
    normal = np.array([-chord[1], chord[0]]) / np.hypot(*chord)
    noise = rng.normal(0, 1, len(points))
    if conditions.correlation > 0:
        reach = int(3 * conditions.correlation) + 1
        kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) / conditions.correlation) ** 2)
        kernel /= np.sqrt((kernel**2).sum())
        noise = np.convolve(rng.normal(0, 1, len(points) + 2 * reach), kernel, "valid")
    return np.clip(points + conditions.noise * noise[:, None] * normal, 0, size)
