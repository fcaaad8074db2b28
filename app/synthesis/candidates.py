"""Candidates of a camera with a known lens, made of points directly: no image is rendered and none is searched.

For measuring estimates of lenses over many cameras in little time. What makes real candidates hard is drawn along:
most straight edges of a scene share three directions (Coughlan and Yuille 1999, "Manhattan World"), edge points err
together with their neighbours, and edges that aren't straight come in families - a kerb, an arch or a bonnet gives
several pieces that bend alike -, as foliage, and along the border of the frame, where the lens has no say.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from app.errors import InvalidInput
from app.synthesis.lens import Lens, is_invertible
from app.vision.segments import Segments

Array = NDArray[np.float64]
Kind = Literal["curve", "foliage", "border"]

SIZES = ((640, 480), (480, 640), (1024, 768), (1280, 720), (1300, 398), (1920, 1080))
SHORTEST = 60.0
"""px of chord; shorter pieces are drawn anew."""
KINDS: tuple[Kind, ...] = get_args(Kind)


@dataclass(frozen=True)
class CandidateConditions:
    """How hard the candidates of a camera are.

    Attributes:
        images: Number of images.
        candidates: Of each image.
        straight_share: Share of them that are straight lines of the scene, 0 to 1.
        noise: px, standard deviation of edge points across their edge, typical of the camera.
        correlation: Edge points over which the noise is smoothed.
        mean_length: px by which chords exceed `SHORTEST` on average (exponential law).
        kinds: Shares of curve, foliage and border among those that aren't straight; add up to 1.
        vehicle: Whether the first curve is fixed to the camera, the same in all images.
    """

    images: int
    candidates: int
    straight_share: float
    noise: float
    correlation: float
    mean_length: float
    kinds: tuple[float, float, float] = (0.5, 0.3, 0.2)
    vehicle: bool = False

    def __post_init__(self) -> None:
        if self.images < 1 or self.candidates < 1 or not 0 <= self.straight_share <= 1:
            raise InvalidInput("no such candidates", where="conditions", expected="images, candidates and a share")


@dataclass(frozen=True, eq=False)
class CandidateCamera:
    """Candidates of one camera, and the truth about them.

    Attributes:
        lens: What they are seen through.
        segments: Of each image, in px.
        straight: For each image, bool ``(S,)``: whether a candidate is a straight line of the scene.
    """

    lens: Lens
    segments: tuple[Segments, ...]
    straight: tuple[NDArray[np.bool_], ...]


def draw_camera(seed: int) -> CandidateCamera:
    """Draw a lens, how hard its candidates are, and the candidates; the same for the same seed.

    Images number 1 for six cameras in ten, else 2 to 8; candidates 15 to 300 (150 of several images) each, of which 30
    to 100 % are straight; noise is 0.03 to 0.3 px; all over the range by equal ratios where it spans a decade.
    """
    rng = np.random.default_rng(seed)
    images = 1 if rng.random() < 0.6 else int(rng.integers(2, 9))
    shares = rng.dirichlet([2.0, 1.0, 0.5])
    conditions = CandidateConditions(
        images=images,
        candidates=round(float(np.exp(rng.uniform(np.log(15), np.log(300 if images == 1 else 150))))),
        straight_share=float(rng.uniform(0.3, 1.0)),
        noise=float(np.exp(rng.uniform(np.log(0.03), np.log(0.3)))),
        correlation=float(rng.uniform(0.5, 3.0)),
        mean_length=float(rng.uniform(40, 100)),
        kinds=(float(shares[0]), float(shares[1]), float(shares[2])),
        vehicle=bool(rng.random() < 0.3),
    )
    width, height = SIZES[rng.integers(len(SIZES))]
    return draw_candidates(draw_radial_lens(rng, width, height), conditions, rng)


def draw_radial_lens(rng: np.random.Generator, width: int, height: int) -> Lens:
    """Draw a lens from barrel over none to pincushion, with k1 alone or with k2, centre within about 2 %.

    The polynomial goes the way of OpenCV, distorting, so that no model in the undistort direction has it exactly.
    """
    while True:
        k1 = rng.uniform(-0.4, 0.0) if rng.random() < 0.8 else rng.uniform(0.0, 0.12)
        k2 = 0.0 if rng.random() < 0.5 else -k1 * rng.uniform(0.1, 0.6)
        focal = max(width, height) * rng.uniform(0.6, 1.1)
        centre = np.array([(width - 1) / 2, (height - 1) / 2]) + rng.normal(0, 0.008, 2) * np.hypot(width, height) / 2
        matrix = np.array([[focal, 0, centre[0]], [0, focal, centre[1]], [0, 0, 1]])
        try:
            lens = Lens(width, height, matrix, np.array([k1, k2, 0, 0, 0]))
        except InvalidInput:
            continue
        if is_invertible(lens, 0.3):
            return lens


def draw_candidates(lens: Lens, conditions: CandidateConditions, rng: np.random.Generator) -> CandidateCamera:
    """Draw the candidates of a camera.

    Edges of the vehicle come first among those that aren't straight, and those after the straight ones.
    """
    painter = _Painter(lens, conditions, rng)
    vehicle = painter.curve_family(6) if conditions.vehicle else []
    segments: list[Segments] = []
    straight: list[NDArray[np.bool_]] = []
    for _ in range(conditions.images):
        wanted = round(conditions.candidates * conditions.straight_share)
        true = painter.straight_edges(wanted)
        false = [painter.shaken(piece) for piece in vehicle]
        while len(false) < conditions.candidates - wanted:
            kind = KINDS[rng.choice(len(KINDS), p=conditions.kinds)]
            if kind == "curve":
                false += painter.curve_family(int(rng.integers(1, 7)))
            else:
                false += painter.foliage() if kind == "foliage" else painter.border()
        false = false[: conditions.candidates - wanted]
        segments.append(Segments.from_list([*true, *false]))
        straight.append(np.arange(len(true) + len(false)) < len(true))
    return CandidateCamera(lens, tuple(segments), tuple(straight))


class _Painter:
    """Draws edges of one camera as points in px, noise included."""

    def __init__(self, lens: Lens, conditions: CandidateConditions, rng: np.random.Generator) -> None:
        self.lens, self.conditions, self.rng = lens, conditions, rng
        self.size = np.array([lens.width - 1.0, lens.height - 1.0])
        self.focal = float(lens.matrix[0, 0])

    def straight_edges(self, count: int) -> list[Array]:
        """Lines of a box-like scene: towards three vanishing points, one in ten anywhere."""
        axes = _rotation(self.rng.uniform(-np.pi, np.pi), self.rng.normal(0, 0.1), self.rng.normal(0, 0.03))
        edges: list[Array] = []
        while len(edges) < count:
            axis = self.rng.choice(4, p=[0.25, 0.4, 0.25, 0.1])
            middle = self.lens.to_rays(self.rng.uniform(0.02, 0.98, 2) * self.size)
            towards = axes[axis] if axis < 3 else self.rng.normal(0, 1, 3)
            along = towards[:2] - middle * towards[2]
            edges += self._piece(middle, float(np.arctan2(along[1], along[0])), 0.0)
        return edges

    def curve_family(self, pieces: int) -> list[Array]:
        """Pieces of one arc of the scene, beside and behind one another, lying rather than upright."""
        middle = self.lens.to_rays(self.rng.uniform(0.05, 0.95, 2) * self.size)
        angle = self.rng.normal(0, 0.35) if self.rng.random() < 0.7 else self.rng.uniform(-np.pi, np.pi)
        radius = float(np.exp(self.rng.uniform(np.log(0.4), np.log(6)))) * self.lens.width / self.focal
        curvature = self.rng.choice([-1, 1]) / radius
        edges: list[Array] = []
        for _ in range(pieces):
            ahead = self.rng.uniform(-0.3, 0.3) * self.lens.width / self.focal
            aside = self.rng.uniform(-12, 12) / self.focal
            turned = angle + ahead * curvature
            start = middle + _arc(angle, curvature, np.array([ahead]))[0] + aside * _normal(turned)
            edges += self._piece(start, turned, curvature)
        return edges

    def foliage(self) -> list[Array]:
        """An edge that wavers and bends a little, in no direction in particular."""
        middle = self.lens.to_rays(self.rng.uniform(0.02, 0.98, 2) * self.size)
        bend = self.rng.normal(0, 0.015) * 8 * self.focal / self._length()
        waves = float(np.exp(self.rng.uniform(np.log(0.1), np.log(1.0))))
        return self._piece(middle, self.rng.uniform(0, np.pi), bend, waves, self.rng.uniform(3, 20))

    def border(self) -> list[Array]:
        """An edge along a side of the frame, straight in the image as it is."""
        length, along_x = self._length(), self.rng.random() < 0.5
        side, other = (self.size if along_x else self.size[::-1]).tolist()
        start = self.rng.uniform(0, max(side - length, 1.0))
        depth = self.rng.uniform(1, 12)
        t = np.arange(start, min(start + length, side))
        across = np.full_like(t, depth if self.rng.random() < 0.5 else other - depth)
        points = np.stack([t, across] if along_x else [across, t], -1)
        return [self.shaken(points)] if len(points) > SHORTEST else []

    def shaken(self, points: Array, waves: float = 0.0, wave_length: float = 1.0) -> Array:
        """Add edge noise, and slower waves of a size in px, across the chord; nothing leaves the frame."""
        chord = points[-1] - points[0]
        normal = np.array([-chord[1], chord[0]]) / np.hypot(*chord)
        noise = self.conditions.noise * float(np.exp(self.rng.normal(0, 0.25)))
        across = noise * self._smooth(len(points), self.conditions.correlation)
        across += waves * self._smooth(len(points), wave_length)
        return np.clip(points + across[:, None] * normal, 0, self.size)

    def _piece(
        self, middle: Array, angle: float, curvature: float, waves: float = 0.0, wave_length: float = 1.0
    ) -> list[Array]:
        """An arc about a ray, cut to the frame; nothing if less than `SHORTEST` is left."""
        half = self._length() / 2
        steps = np.arange(-half, half + 1) / self.focal
        points = self.lens.to_pixels(middle + _arc(angle, curvature, steps))
        inside = ((points >= 0) & (points <= self.size)).all(1)
        outside = np.flatnonzero(~inside)
        centre = len(points) // 2
        first = outside[outside < centre].max(initial=-1) + 1
        last = outside[outside >= centre].min(initial=len(points))
        points = points[first:last]
        if len(points) < 2 or np.hypot(*(points[-1] - points[0])) < SHORTEST:
            return []
        return [self.shaken(points, waves, wave_length)]

    def _length(self) -> float:
        return SHORTEST + float(self.rng.exponential(self.conditions.mean_length))

    def _smooth(self, count: int, sigma: float) -> Array:
        """Gaussian noise of unit variance, smoothed by a Gaussian of `sigma` samples."""
        reach = int(3 * sigma) + 1
        kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) / sigma) ** 2)
        kernel /= np.sqrt((kernel**2).sum())
        return np.asarray(np.convolve(self.rng.normal(0, 1, count + 2 * reach), kernel, "valid"), np.float64)


def _arc(angle: float, curvature: float, steps: Array) -> Array:
    """Points ``(N, 2)`` at arc lengths from the origin, starting in direction `angle`."""
    turn = curvature * steps
    # sin(t) / t and (1 - cos t) / t, which stay exact for a straight line
    ahead = steps * np.sinc(turn / np.pi)
    aside = steps * np.sinc(turn / (2 * np.pi)) * np.sin(turn / 2)
    return np.outer(ahead, [np.cos(angle), np.sin(angle)]) + np.outer(aside, _normal(angle))


def _normal(angle: float) -> Array:
    return np.array([-np.sin(angle), np.cos(angle)])


def _rotation(yaw: float, pitch: float, roll: float) -> Array:
    """Directions of the scene's width, height and depth in the camera's axes, one per row."""
    (cy, sy), (cp, sp), (cr, sr) = ((np.cos(a), np.sin(a)) for a in (yaw, pitch, roll))
    turn = np.array([[cy, 0, -sy], [0, 1, 0], [sy, 0, cy]])
    tilt = np.array([[1, 0, 0], [0, cp, sp], [0, -sp, cp]])
    lean = np.array([[cr, sr, 0], [-sr, cr, 0], [0, 0, 1]])
    return np.transpose(lean @ tilt @ turn).astype(np.float64)
