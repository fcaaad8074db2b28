"""M10: what the lines are good for: how well a camera is calibrated from a submission's segments.

The estimator of `app.vision`, with its settings as they stand, gets the submitted segments of all images of a camera
and answers with a lens. It is part of the scorer: a change that moves its answers raises `SCORER_VERSION`. Two numbers
judge the lens:

- the straightness of the *labelled* lines under that lens: RMS distance of their points from straight lines, px.
  Source: Tang, Grompone von Gioi, Monasse and Morel, "High-precision camera distortion measurements with a calibration
  harp" (JOSA A 2012), but with distances in the measured image (`app.vision.sampson`), since in the corrected one a
  lens that shrinks the image would shrink them too;
- where the camera's distortion is known, the difference of both lenses over a grid of the frame after the best
  homography, which lines can't see, RMS in px. Source: the comparison of calibrations in Kogan's mrcal (2021).

A lens that the estimator itself refuses is not used: the camera then counts as not corrected at all, and that is said.
The same labels under no correction at all are the measure to compare with.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from app.evaluation.ground_truth import GroundTruth
from app.evaluation.resampling import resample
from app.vision.brown import Brown
from app.vision.distortion import estimate_distortion
from app.vision.field import Lens, field_error
from app.vision.sampson import sampson_residuals
from app.vision.segments import Segments

SEED = 0
_STEP = 2.0  # px between the points of a labelled line whose straightness counts


@dataclass(frozen=True)
class CalibrationScore:
    """How well a camera is calibrated from a submission's segments.

    Attributes:
        camera: Its name.
        images: Number of its images.
        accepted: Whether the estimator vouches for its lens; if not, all numbers are those of no correction.
        reasons: Why not, in words.
        rms: RMS distance of the labelled lines' points from straight lines under the lens, px; ``None`` without labels.
        rms_uncorrected: The same without any correction, px.
        points: Points that the RMS is taken over.
        grid: RMS difference to the reference distortion over the frame, px; ``None`` where no reference is known.
        grid_uncorrected: The same without any correction, px.
    """

    camera: str
    images: int
    accepted: bool
    reasons: tuple[str, ...]
    rms: float | None
    rms_uncorrected: float | None
    points: int
    grid: float | None
    grid_uncorrected: float | None

    def as_dict(self) -> dict[str, Any]:
        """Return the fields for JSON."""
        return {**asdict(self), "reasons": list(self.reasons)}


@dataclass(frozen=True)
class CalibrationTotals:
    """The calibration scores of all cameras as one.

    Attributes:
        rms: RMS over the points of all cameras, px; ``None`` without any.
        grid: RMS over the cameras whose reference is known, px; ``None`` without any.
    """

    rms: float | None
    grid: float | None


def score_calibration(
    camera: str,
    truths: Sequence[GroundTruth],
    predictions: Sequence[Segments],
    size: tuple[int, int],
    *,
    reference: Lens | None = None,
) -> CalibrationScore:
    """Calibrate a camera from submitted segments and judge the lens.

    Args:
        camera: Name of the camera.
        truths: The labels of each of its images; ignored ones don't count.
        predictions: The submitted segments of each, px.
        size: Width and height of its images, px.
        reference: Its distortion as known from elsewhere.

    Raises:
        InvalidInput: If the size isn't positive.
    """
    width, height = size
    estimate = estimate_distortion(list(predictions), size, seed=SEED)
    none = Brown.identity(width, height)
    lens = estimate.brown if estimate.accepted else none
    lines = _labelled_lines(truths)
    return CalibrationScore(
        camera=camera,
        images=len(truths),
        accepted=estimate.accepted,
        reasons=estimate.reasons,
        rms=_straightness(lines, lens),
        rms_uncorrected=_straightness(lines, none),
        points=len(lines.points),
        grid=None if reference is None else field_error(reference, lens, width, height).rms,
        grid_uncorrected=None if reference is None else field_error(reference, none, width, height).rms,
    )


def total_calibration(scores: Sequence[CalibrationScore]) -> CalibrationTotals:
    """Return the scores of cameras as one: squares are averaged, over points and over cameras."""
    squares = sum(score.points * score.rms**2 for score in scores if score.rms is not None)
    points = sum(score.points for score in scores if score.rms is not None)
    grids = [score.grid for score in scores if score.grid is not None]
    return CalibrationTotals(
        rms=float(np.sqrt(squares / points)) if points else None,
        grid=float(np.sqrt(np.mean(np.square(grids)))) if grids else None,
    )


def _labelled_lines(truths: Sequence[GroundTruth]) -> Segments:
    """Return the labels that count, of all images together, as points at even steps: each px of line counts alike."""
    lines = []
    for truth in truths:
        samples = resample(truth.segments.select(~truth.ignored), step=_STEP)
        lines += np.split(samples.points, samples.offsets[1:-1]) if len(samples) else []
    return Segments.from_list(lines)


def _straightness(lines: Segments, lens: Brown) -> float | None:
    return float(np.sqrt(np.mean(sampson_residuals(lines, lens) ** 2))) if len(lines) else None
