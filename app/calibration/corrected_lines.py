"""The segments of an image as straight lines of the corrected image: where, in which direction, how sure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from app.calibration.lens import CameraLens
from app.calibration.mean_points import BINS, MeanPoints, mean_points
from app.vision.frame import center_of
from app.vision.segments import Segments

Array = NDArray[np.float64]

FEWEST_POINTS = 8
SHORTEST = 0.04
"""Chord in half diagonals; a shorter segment points everywhere."""
LEAST_NOISE = 0.05
"""px; points of a segment are not believed to be better than this."""
CORRELATED = 3.0
"""Edge points that one independent point stands for: they share the blur of the image."""
BENT = 4.0
"""Independent errors along a segment that isn't straight for other reasons than noise."""
LEAST_PROBABILITY = 0.05
MOST_LINES = 300
"""Of an image, the longest and surest; more add time but nothing to what is known."""


class ImageLines(Protocol):
    """One image of a camera, as `app.calibration.calibrate` takes it."""

    @property
    def name(self) -> str:
        """Of the image."""
        ...

    @property
    def segments(self) -> Segments:
        """In px of the measured image."""
        ...

    @property
    def probability(self) -> NDArray[np.float64] | None:
        """Of each segment, to be a straight line of the scene; ``None`` where a person kept all."""
        ...


@dataclass(frozen=True, eq=False)
class LensUncertainty:
    """How far the parameters of a lens may be off.

    Attributes:
        released: Names of the uncertain parameters.
        covariance: float64 ``(P, P)`` of these.
    """

    released: tuple[str, ...]
    covariance: Array


@dataclass(frozen=True, eq=False)
class CorrectedLines:
    """Lines of one image without distortion; lengths in half diagonals from the image centre.

    Attributes:
        middle: float64 ``(L, 2)``, mean of each line's corrected points.
        angle: float64 ``(L,)`` rad, of each line's direction.
        length: float64 ``(L,)``, from end to end as measured.
        sigma: float64 ``(L,)`` rad, standard deviation of the angle from the scatter of the points.
        weight: float64 ``(L,)`` in [0, 1], probability of being a straight line.
        middle_slope: float64 ``(P, L, 2)``, derivative of the middle by each uncertain parameter of the lens.
        angle_slope: float64 ``(P, L)``, of the angle.
    """

    middle: Array
    angle: Array
    length: Array
    sigma: Array
    weight: Array
    middle_slope: Array
    angle_slope: Array

    def __len__(self) -> int:
        return len(self.length)

    @property
    def direction(self) -> Array:
        """Unit vectors along the lines, float64 ``(L, 2)``."""
        return np.stack([np.cos(self.angle), np.sin(self.angle)], -1)

    def select(self, chosen: NDArray[np.bool_] | NDArray[np.int64]) -> CorrectedLines:
        """Return the chosen lines: a mask or indices."""
        return CorrectedLines(
            self.middle[chosen],
            self.angle[chosen],
            self.length[chosen],
            self.sigma[chosen],
            self.weight[chosen],
            self.middle_slope[:, chosen],
            self.angle_slope[:, chosen],
        )

    def under(self, change: Array) -> CorrectedLines:
        """Return the lines as they would be after a small change ``(P,)`` of the lens, to first order."""
        return replace(
            self,
            middle=self.middle + np.tensordot(change, self.middle_slope, 1),
            angle=self.angle + change @ self.angle_slope,
        )


def correct_lines(images: Sequence[ImageLines], lens: CameraLens, uncertain: LensUncertainty) -> list[CorrectedLines]:
    """Return the usable lines of each image: total least squares through the corrected points of each segment.

    Args:
        images: Of one camera.
        lens: Its lens.
        uncertain: Which of its parameters to give derivatives by.
    """
    return [_of_image(image, lens, uncertain) for image in images]


def _of_image(image: ImageLines, lens: CameraLens, uncertain: LensUncertainty) -> CorrectedLines:
    segments, probability = image.segments, image.probability
    odds = np.ones(len(segments)) if probability is None else np.asarray(probability, np.float64)
    lengths = segments.extents()
    usable = (segments.counts >= FEWEST_POINTS) & (lengths >= SHORTEST * lens.scale) & (odds > LEAST_PROBABILITY)
    surest = np.argsort(-np.where(usable, odds * lengths, 0.0), kind="stable")[: min(int(usable.sum()), MOST_LINES)]
    chosen = np.sort(surest)
    means = mean_points(segments.select(chosen))
    middle, angle, scatter = _fitted(means, lens)
    middle_slopes, angle_slopes = [np.zeros((0, *middle.shape))], [np.zeros((0, *angle.shape))]
    for name, variance in zip(uncertain.released, np.diag(uncertain.covariance), strict=True):
        step = 0.1 * float(np.sqrt(variance)) + 1e-9
        parameters = list(lens.parameters)
        parameters[lens.names.index(name)] += step
        ahead_middle, ahead_angle, _ = _fitted(means, replace(lens, parameters=tuple(parameters)))
        middle_slopes.append((ahead_middle - middle)[None] / step)
        turn = ahead_angle - angle
        angle_slopes.append((turn - np.pi * np.round(turn / np.pi))[None] / step)
    noise = np.maximum(means.noise, LEAST_NOISE) / lens.scale
    count = np.maximum(means.count, 1)
    bent = np.maximum(scatter**2 - noise**2 * BINS / count, 0.0)
    spread = np.sqrt(CORRELATED * noise**2 / count + bent / BENT)
    length = lengths[chosen] / lens.scale
    lines = CorrectedLines(
        middle=middle,
        angle=angle,
        length=length,
        # a straight line fitted to points of equal distance over a length (variance of the slope)
        sigma=np.sqrt(12) * spread / np.maximum(length, 1e-9),
        weight=odds[chosen],
        middle_slope=np.concatenate(middle_slopes),
        angle_slope=np.concatenate(angle_slopes),
    )
    whole = np.isfinite(middle).all(1) & np.isfinite(lines.middle_slope).all((0, 2)) & (length > 0)
    return lines.select(whole)


def _fitted(means: MeanPoints, lens: CameraLens) -> tuple[Array, Array, Array]:
    """Return middle, angle in rad and scatter across of lines through corrected mean points, in half diagonals."""
    corrected = lens.undistort(means.points.reshape(-1, 2)) - center_of(lens.width, lens.height)
    corrected = corrected.reshape(means.points.shape) / lens.scale
    middle = (means.share[:, :, None] * corrected).sum(1)
    x, y = np.moveaxis(corrected - middle[:, None], -1, 0)
    xx, xy, yy = ((means.share * values).sum(1) for values in (x * x, x * y, y * y))
    angle = 0.5 * np.arctan2(2 * xy, xx - yy)
    across = np.maximum((xx + yy) / 2 - np.hypot((xx - yy) / 2, xy), 0.0)
    return middle, angle, np.sqrt(across)
