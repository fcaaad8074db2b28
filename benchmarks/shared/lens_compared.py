"""One camera's reviewed lines, calibrated by us and by others, against its true lens."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from shared.plain_plumb_line import PlumbLine

from app.calibration.calibrate import CalibrationImage, calibrate
from app.calibration.lens import CameraLens, Family
from app.vision.bins import bin_segments
from app.vision.field import Lens, apply_homography, best_homography, displacement
from app.vision.frame import center_of, frame_grid
from app.vision.msac import msac_brown
from app.vision.segments import Segments

INNER = 0.8


@dataclass(frozen=True)
class Compared:
    """Field errors in px RMS of one camera.

    Attributes:
        identity: Of no correction.
        msac: Of the paper's estimate; NaN where its lines are too short for it.
        plumb_line: Of the plain plumb line.
        ours: Of ours, accepted or not.
        inner: Of ours over the inner 80 % of the frame.
        pred: What we expect.
        bound: What we say ours lies below with 95 %.
        cells: Share of the map's cells whose error lies below their own bound.
        accepted: Whether we say that it may be used.
        seconds: Of the processor, for ours with uncertainty, focal length and free model.
    """

    identity: float
    msac: float
    plumb_line: float
    ours: float
    inner: float
    pred: float
    bound: float
    cells: float
    accepted: bool
    seconds: float


def compare(
    segments: Sequence[Segments],
    truth: Lens,
    width: int,
    height: int,
    *,
    peers: bool = True,
    family: Family | None = None,
) -> Compared:
    """Calibrate one camera and compare with its true lens."""
    images = [CalibrationImage(str(index), each) for index, each in enumerate(segments)]
    start = time.thread_time()
    found = calibrate(images, (width, height), family=family)
    seconds = time.thread_time() - start
    grid, shown = frame_grid(width, height), found.map
    cells = np.stack(np.meshgrid(shown.x, shown.y), -1).reshape(-1, 2)
    aligned = distances(truth, found.lens, cells)
    return Compared(
        identity=error(truth, CameraLens.identity("brown", width, height), grid),
        msac=_msac_error(segments, truth, width, height) if peers else np.nan,
        plumb_line=error(truth, PlumbLine(segments, width, height), grid) if peers else np.nan,
        ours=error(truth, found.lens, grid),
        inner=error(truth, found.lens, inner_grid(width, height)),
        pred=found.uncertainty.pred,
        bound=found.uncertainty.bound95,
        cells=float(np.mean(aligned <= shown.sigma.ravel())),
        accepted=found.accepted,
        seconds=seconds,
    )


def error(truth: Lens, lens: Lens, grid: NDArray[np.float64]) -> float:
    """Return the field error over a grid, px RMS; NaN where a lens folds."""
    reference, estimate = truth.undistort(grid), lens.undistort(grid)
    if not (np.isfinite(reference).all() and np.isfinite(estimate).all()):
        return float("nan")
    return displacement(reference, estimate).rms


def distances(truth: Lens, lens: Lens, grid: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the error at each point of a grid, px, after the best homography of the whole."""
    reference, estimate = truth.undistort(grid), lens.undistort(grid)
    return np.hypot(*(apply_homography(best_homography(estimate, reference), estimate) - reference).T)


def inner_grid(width: int, height: int) -> NDArray[np.float64]:
    """Return a grid over the inner 80 % of the frame, by its sides."""
    center = np.array(center_of(width, height))
    return center + INNER * (frame_grid(width, height) - center)


def _msac_error(segments: Sequence[Segments], truth: Lens, width: int, height: int) -> float:
    binned = bin_segments(segments, width, height)
    if len(binned) < 3:
        return float("nan")
    return error(truth, msac_brown(binned, width, height).brown, frame_grid(width, height))
