"""Focal length, principal point and the frames of all images together, by least squares over the lines.

Shared by all images are the focal length, the principal point and what isn't known of the lens. Each image has the
rotation of a frame of three directions, and how far these are from right angles: the corners of buildings are square
to some tenths of a degree. What is made small is the angle between each line and its way to the vanishing point it
belongs to. What belongs to one image is eliminated (Schur complement), so that each image leaves one set of equations
for what is shared: of these the covariance and the effect of leaving an image out follow directly.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.calibration.corrected_lines import CorrectedLines
from app.calibration.pinhole import Pinhole
from app.calibration.vanishing_points import REACH, signed_deviations

Array = NDArray[np.float64]

STEPS = 15
SMALL = 1e-6
"""Step that derivatives are taken over."""
SETTLED = 2e-5
"""Change of what is shared at which the adjustment ends; a thousandth of the smallest uncertainty."""
FREEDOM = 5.0
"""Of Student's law, which the disagreement of lines is taken to follow."""
CORRELATED = 1.5
"""Lines that one independent line stands for: both edges of a thing share their error."""
TYPICAL_PARALLEL, TYPICAL_SQUARE = np.deg2rad(0.15), np.deg2rad(0.45)
"""rad; angles by which edges called parallel aren't, and directions called square aren't, before any is seen."""
LINES_BEFORE, FRAMES_BEFORE = 20.0, 10.0
"""Lines, and right angles, that these count as."""


@dataclass(frozen=True, eq=False)
class Frame:
    """Three directions of an image.

    Attributes:
        rotation: float64 ``(3, 3)``, unit vectors at right angles in the camera's axes, one per row.
        oblique: float64 ``(3,)`` rad, by which the directions 1 and 2, 1 and 3, 2 and 3 are off a right angle.
        directions: How many of them lines may belong to, the first ones: 2 or 3.
    """

    rotation: Array
    oblique: Array
    directions: int

    @property
    def rays(self) -> Array:
        """The directions themselves, float64 ``(directions, 3)``."""
        a, b, c = self.oblique / 2
        rays = np.array([[1, a, b], [a, 1, c], [b, c, 1]]) @ self.rotation
        return rays[: self.directions] / np.linalg.norm(rays[: self.directions], axis=1, keepdims=True)

    def moved(self, step: Array) -> Frame:
        """Return it turned by a small rotation vector ``step[:3]`` and skewed by ``step[3:]``."""
        x, y, z = step[:3]
        turned = self.rotation + self.rotation @ np.array([[0, z, -y], [-z, 0, x], [y, -x, 0]])
        return Frame(_square(turned), self.oblique + step[3:], self.directions)


@dataclass(frozen=True, eq=False)
class Adjustment:
    """The answer; shared are log focal length, principal point, then the lens's uncertain parameters.

    Attributes:
        pinhole: Focal length and principal point.
        frames: Of each image.
        members: For each image, int64 ``(L,)``: the direction each line belongs to, -1 where none.
        covariance: float64 ``(3 + P, 3 + P)`` of what is shared.
        information: float64 ``(I, 3 + P, 3 + P)``, what each image says of it.
        left_out: float64 ``(I, 3 + P)``, by how much leaving an image out would move it.
        parallel: rad, by which parallel edges were found to differ.
        square: rad, by which right angles were found to differ.
    """

    pinhole: Pinhole
    frames: tuple[Frame, ...]
    members: tuple[NDArray[np.int64], ...]
    covariance: Array
    information: Array
    left_out: Array
    parallel: float
    square: float


@dataclass(frozen=True, eq=False)
class _State:
    pinhole: Pinhole
    lens: Array
    frames: tuple[Frame, ...]
    parallel: float
    square: float


def adjust(
    lines: Sequence[CorrectedLines], starts: Sequence[Array], focal: float, center_sigma: float, lens_covariance: Array
) -> Adjustment:
    """Adjust all frames together.

    Args:
        lines: Of each image.
        starts: For each image two or three vanishing points, unit vectors over the image plane in rows.
        focal: Focal length to begin with, in half diagonals.
        center_sigma: Standard deviation of the principal point before, in half diagonals.
        lens_covariance: float64 ``(P, P)`` of the lens's uncertain parameters.
    """
    pinhole = Pinhole(focal, np.zeros(2))
    frames = tuple(_frame(pinhole.rays(start)) for start in starts)
    state = _State(pinhole, np.zeros(len(lens_covariance)), frames, TYPICAL_PARALLEL, TYPICAL_SQUARE)
    prior = np.zeros((3 + len(lens_covariance),) * 2)
    prior[1:3, 1:3] = np.eye(2) / center_sigma**2
    prior[3:, 3:] = np.linalg.inv(lens_covariance)
    for _ in range(STEPS):
        equations = [_equations(state, frame, each) for frame, each in zip(state.frames, lines, strict=True)]
        step = _step(state, equations, prior)
        state = _moved(state, equations, step)
        if np.abs(step).max() < SETTLED:
            break
    return _result(
        state, [_equations(state, frame, each) for frame, each in zip(state.frames, lines, strict=True)], prior
    )


@dataclass(frozen=True, eq=False)
class _Equations:
    """Normal equations of one image, with what is its own eliminated."""

    reduced: Array
    gradient: Array
    own: Array
    own_gradient: Array
    mixed: Array
    members: NDArray[np.int64]
    residual: Array
    sigma: Array
    odds: Array

    def own_step(self, step: Array) -> Array:
        return np.asarray(np.linalg.solve(self.own, self.own_gradient - self.mixed.T @ step), np.float64)


def _equations(state: _State, frame: Frame, lines: CorrectedLines) -> _Equations:
    number = len(state.lens)
    now = lines.under(state.lens)
    every = signed_deviations(state.pinhole.vanishing(frame.rays)[:, None], now)
    nearest = np.argmin(np.abs(every), axis=0)
    residual = every[nearest, np.arange(len(lines))]
    sigma = np.hypot(lines.sigma, state.parallel)
    ratio = residual / sigma
    agreeing = np.abs(residual) < 1.5 * REACH * np.hypot(lines.sigma, max(state.parallel, TYPICAL_PARALLEL))
    odds = np.where(agreeing, lines.weight * (FREEDOM + 1) / (FREEDOM + ratio**2), 0.0)
    heavy = odds / sigma**2 / CORRELATED

    slopes = np.empty((len(lines), 3 + number + 6))
    for column in range(slopes.shape[1]):
        step = np.zeros(slopes.shape[1])
        step[column] = SMALL
        pinhole, other = state.pinhole.moved(step[:3]), frame.moved(step[3 + number :])
        seen = now if column < 3 or column >= 3 + number else lines.under(state.lens + step[3 : 3 + number])
        slopes[:, column] = (signed_deviations(pinhole.vanishing(other.rays)[nearest], seen) - residual) / SMALL
    normal = slopes.T @ (heavy[:, None] * slopes)
    right = -slopes.T @ (heavy * residual)
    split = 3 + number
    square = np.append(np.zeros(3), np.full(3, state.square**-2))
    own = normal[split:, split:] + np.diag(square + 1e-3)
    own_gradient = right[split:] - square * np.append(np.zeros(3), frame.oblique)
    mixed = normal[:split, split:]
    solved = np.linalg.solve(own, np.column_stack([mixed.T, own_gradient]))
    return _Equations(
        reduced=normal[:split, :split] - mixed @ solved[:, :split],
        gradient=right[:split] - mixed @ solved[:, split],
        own=own,
        own_gradient=own_gradient,
        mixed=mixed,
        members=np.where(agreeing, nearest, -1),
        residual=residual,
        sigma=lines.sigma,
        odds=odds,
    )


def _step(state: _State, equations: Sequence[_Equations], prior: Array) -> Array:
    system = np.sum([each.reduced for each in equations], axis=0) + prior + 1e-9 * np.eye(len(prior))
    gradient = np.sum([each.gradient for each in equations], axis=0)
    gradient -= prior @ np.concatenate([[0.0], state.pinhole.center, state.lens])
    step = np.linalg.solve(system, gradient)
    return np.asarray(step * min(1.0, 0.2 / max(float(np.abs(step[:3]).max()), 1e-12)), np.float64)


def _moved(state: _State, equations: Sequence[_Equations], step: Array) -> _State:
    frames = tuple(
        frame.moved(equation.own_step(step)) for frame, equation in zip(state.frames, equations, strict=True)
    )
    return _State(
        state.pinhole.moved(step[:3]),
        state.lens + step[3:],
        frames,
        _parallel(equations, state.parallel),
        _squareness(frames, equations),
    )


def _parallel(equations: Sequence[_Equations], before: float) -> float:
    """Return the angle by which parallel edges differ, one step of expectation and maximisation (Dempster 1977)."""
    residual = np.concatenate([each.residual for each in equations])
    noise = np.concatenate([each.sigma for each in equations]) ** 2
    odds = np.concatenate([each.odds for each in equations])
    share = before**2 / (before**2 + noise)
    expected = (share * residual) ** 2 + share * noise
    total = LINES_BEFORE * TYPICAL_PARALLEL**2 + float(odds @ expected)
    return float(np.sqrt(total / (LINES_BEFORE + odds.sum())))


def _squareness(frames: Sequence[Frame], equations: Sequence[_Equations]) -> float:
    """Return the angle by which right angles differ, likewise; only triples can tell."""
    total, count = FRAMES_BEFORE * TYPICAL_SQUARE**2, FRAMES_BEFORE
    for frame, equation in zip(frames, equations, strict=True):
        if frame.directions == 3:
            total += float((frame.oblique**2).sum() + np.diag(np.linalg.inv(equation.own))[3:].sum())
            count += 3
    return float(np.sqrt(total / count))


def _result(state: _State, equations: Sequence[_Equations], prior: Array) -> Adjustment:
    information = np.array([each.reduced for each in equations])
    total = information.sum(0) + prior + 1e-9 * np.eye(len(prior))
    left_out = [
        -np.linalg.solve(total - some, equation.gradient) for some, equation in zip(information, equations, strict=True)
    ]
    return Adjustment(
        pinhole=state.pinhole,
        frames=state.frames,
        members=tuple(each.members for each in equations),
        covariance=np.linalg.inv(total),
        information=information,
        left_out=np.array(left_out),
        parallel=state.parallel,
        square=state.square,
    )


def _frame(rays: Array) -> Frame:
    """Return the frame at right angles nearest to two or three directions."""
    number = len(rays)
    if number == 2:
        rays = np.vstack([rays, np.cross(rays[0], rays[1])])
    return Frame(_square(rays), np.zeros(3), number)


def _square(rays: Array) -> Array:
    left, _, right = np.linalg.svd(rays)
    return np.asarray(left @ right, np.float64)
