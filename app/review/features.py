"""What is told of each candidate, from which the probability is learnt that a person keeps it.

Nothing depends on the unit of the image's content: lengths are in image diagonals, or in px where the edge itself is
meant; positions are mirrored, so that left and right are alike. An unknown value is NaN, and every model takes it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from app.review.appearance import APPEARANCE, appearance
from app.review.frame_matches import frame_matches
from app.review.neighbourhood import NEIGHBOURHOOD, neighbourhood
from app.review.standing import ranks, standardised
from app.review.strands import Strands, strands
from app.review.vanishing import deviations, vanishing_frame
from app.vision.segments import Segments

Array = NDArray[np.float64]

FEATURE_VERSION = "1"
"""Changes with every change of meaning: what was computed or learnt under another one is made anew."""

PERSISTENCE = ("frames before and after",)
SHAPE = (
    "length",
    "length in px",
    "score",
    "straightness",
    "residual",
    "residual over length",
    "points per px",
    "chord over arc",
)
PLACE = ("across the frame", "down the frame", "to the border", "ends at the border", "upright", "from the centre")
MANHATTAN = (
    "vanishing deviation",
    "second vanishing deviation",
    "upright deviation",
    "vanishing support",
    "upright family",
    "all support",
    "length pointing along",
)
STANDING = (
    "length rank",
    "score rank",
    "length against the image's",
    "score against the image's",
    "contrast against the image's",
    "vanishing deviation rank",
    "candidates",
    "typical score",
)
FEATURES: tuple[str, ...] = (*SHAPE, *PLACE, *MANHATTAN, *NEIGHBOURHOOD, *APPEARANCE, *STANDING, *PERSISTENCE)
"""Names of the columns, in order."""


class Lens(Protocol):
    """The lens as estimated: a ``DistortionEstimate``."""

    @property
    def accepted(self) -> bool:
        """Whether the lens should be used."""
        ...

    def undistort(self, points: ArrayLike) -> Array:
        """Map measured points ``(N, 2)`` in px to corrected ones."""
        ...


@dataclass(frozen=True, eq=False)
class NeighbourFrames:
    """Candidates of the frames next to an image in its sequence; ``None`` where there is none."""

    before: Segments | None = None
    after: Segments | None = None


def candidate_features(
    segments: Segments,
    *,
    gray: NDArray[np.uint8] | None,
    size: tuple[int, int],
    residuals: ArrayLike | None = None,
    straightness: ArrayLike | None = None,
    lens: Lens | None = None,
    neighbours: NeighbourFrames | None = None,
) -> NDArray[np.float32]:
    """Describe candidates.

    Args:
        segments: All S candidates of one image, px; with scores if known.
        gray: The image, uint8 ``(H, W)``, or ``None``.
        size: Width and height of the image, px.
        residuals: RMS distance from straight under the lens, ``(S,)`` px, NaN where not known.
        straightness: Probability of being straight, ``(S,)``, NaN where not known.
        lens: The camera's lens; used where it is accepted.
        neighbours: Candidates of the frames before and after.

    Returns:
        float32 ``(S, len(FEATURES))``, NaN where something isn't known.
    """
    if not len(segments):
        return np.zeros((0, len(FEATURES)), np.float32)
    undistort = lens.undistort if lens is not None and lens.accepted else None
    traced = strands(segments, size, undistort)
    looks = appearance(traced, gray)
    shape = _shape(segments, traced, residuals, straightness)
    manhattan = _manhattan(traced)
    standing = _standing(traced, looks[:, APPEARANCE.index("contrast")], manhattan[:, 0])
    persistence = _persistence(segments, size, neighbours)
    table = np.concatenate(
        [shape, _place(traced), manhattan, neighbourhood(traced), looks, standing, persistence], axis=1
    )
    return table.astype(np.float32)


def _known(values: ArrayLike | None, count: int) -> Array:
    return np.full(count, np.nan) if values is None else np.asarray(values, np.float64).reshape(count)


def _shape(segments: Segments, traced: Strands, residuals: ArrayLike | None, straightness: ArrayLike | None) -> Array:
    count = len(segments)
    length = np.maximum(segments.extents(), 1.0)
    residual = _known(residuals, count)
    columns = [
        np.log(length / traced.diagonal),
        np.log(length),
        np.log((traced.scores + 1e-3) / (1 - traced.scores + 1e-3)),
        _known(straightness, count),
        np.log(residual + 0.05),
        np.log(1e3 * residual / length + 0.05),
        segments.counts / length,
        length / np.maximum(segments.lengths(), 1.0),
    ]
    return np.stack(columns, axis=1)


def _place(traced: Strands) -> Array:
    right, bottom = max(traced.width - 1, 1), max(traced.height - 1, 1)
    x, y = traced.samples[..., 0], traced.samples[..., 1]
    margin = np.minimum(np.minimum(x, right - x), np.minimum(y, bottom - y))
    middle = traced.samples.mean(axis=1)
    columns = [
        np.abs(middle[:, 0] / right - 0.5),
        middle[:, 1] / bottom,
        margin.min(axis=1) / traced.diagonal,
        (margin[:, [0, -1]] < 8).sum(axis=1),
        np.abs(traced.direction[:, 1]),
        np.hypot(middle[:, 0] - right / 2, middle[:, 1] - bottom / 2) / traced.diagonal,
    ]
    return np.stack(columns, axis=1).astype(np.float64)


def _manhattan(traced: Strands) -> Array:
    frame = vanishing_frame(traced)
    if frame is None:
        return np.full((len(traced), len(MANHATTAN)), np.nan)
    angle = np.rad2deg(deviations(frame, traced))
    ordered = np.sort(angle, axis=1)
    nearest = np.argmin(angle, axis=1)
    # a candidate of another direction in space is told by the length that points along with it
    towards = np.exp(-0.5 * (angle / 2) ** 2)
    weight = traced.length / traced.length.sum()
    columns = [
        np.log(ordered[:, 0] + 0.2),
        np.log(ordered[:, 1] + 0.2),
        np.log(angle[:, 0] + 0.2),
        frame.support[nearest],
        nearest == 0,
        np.full(len(traced), frame.support.sum()),
        (towards * (weight @ towards)).max(axis=1),
    ]
    return np.stack(columns, axis=1).astype(np.float64)


def _standing(traced: Strands, contrast: Array, deviation: Array) -> Array:
    log_length = np.log(np.maximum(traced.length, 1.0))
    scores = np.where(np.isfinite(traced.scores), traced.scores, 0.5)
    logit = np.log((scores + 1e-3) / (1 - scores + 1e-3))
    columns = [
        ranks(log_length),
        ranks(scores),
        standardised(log_length),
        standardised(logit),
        standardised(contrast),
        ranks(np.where(np.isfinite(deviation), deviation, 0)),
        np.full(len(traced), np.log(len(traced))),
        np.full(len(traced), np.median(scores)),
    ]
    return np.stack(columns, axis=1)


def _persistence(segments: Segments, size: tuple[int, int], neighbours: NeighbourFrames | None) -> Array:
    frames = [] if neighbours is None else [each for each in (neighbours.before, neighbours.after) if each is not None]
    if not frames:
        return np.full((len(segments), 1), np.nan)
    seen = np.zeros(len(segments))
    for other in frames:
        seen[frame_matches(segments, other, size).first] += 1
    return (seen / len(frames))[:, None]
