"""The error of a lens over the frame, and what a user is told of it.

Errors of parameters are drawn from their law and carried to displacements of a grid, the part that a homography can
imitate taken out, since lines can't see that part and nobody who uses straightened lines does.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from app.calibration.calibration import MAP_COLUMNS, DisplacementMap
from app.calibration.lens import CameraLens
from app.calibration.observations import LineObservations
from app.calibration.posterior import LensPosterior, observable_fields
from app.vision.frame import frame_grid

Array = NDArray[np.float64]

DRAWS = 1500
COVERED = 0.95
BLOCK = 1024
"""Cells at once, which bounds the memory of a frame of many."""


def error_draws(posterior: LensPosterior, seed: int) -> Array:
    """Draw errors of the parameters, float64 ``(1500, P)``."""
    rng = np.random.default_rng(seed)
    values, vectors = np.linalg.eigh(posterior.covariance)
    root = vectors * np.sqrt(np.maximum(values, 0.0))[:, None, :]
    kind = rng.choice(len(posterior.weight), DRAWS, p=posterior.weight)
    normal = rng.standard_normal((DRAWS, values.shape[1]))
    return posterior.mean[kind] + np.einsum("npq,nq->np", root[kind], normal)


def field_errors(draws: Array, sensitivity: Array) -> Array:
    """Return the field error of each draw, px RMS."""
    return np.sqrt(np.maximum(np.einsum("np,pq,nq->n", draws, sensitivity, draws), 0.0))


def displacement_map(lens: CameraLens, observed: LineObservations, draws: Array) -> DisplacementMap:
    """Return correction, uncertainty and coverage place by place.

    Args:
        lens: The lens.
        observed: Its lines.
        draws: Errors of the parameters, from `error_draws`.
    """
    grid = frame_grid(lens.width, lens.height, MAP_COLUMNS)
    rows = len(grid) // MAP_COLUMNS
    shape = rows, MAP_COLUMNS
    fields = observable_fields(lens, grid)
    cells = [np.arange(first, min(first + BLOCK, len(grid))) for first in range(0, len(grid), BLOCK)]
    sigma = [
        np.quantile(np.hypot(draws @ fields[block].T, draws @ fields[len(grid) + block].T), COVERED, axis=0)
        for block in cells
    ]
    shift = np.hypot(*(lens.undistort(grid) - grid).T)
    return DisplacementMap(
        x=np.linspace(0, lens.width - 1, MAP_COLUMNS),
        y=np.linspace(0, lens.height - 1, rows),
        shift=np.nan_to_num(shift).reshape(shape),
        sigma=np.concatenate(sigma).reshape(shape),
        lines=_coverage(lens, observed, shape),
    )


def _coverage(lens: CameraLens, observed: LineObservations, shape: tuple[int, int]) -> Array:
    """Return px of line length nearest to each point of the grid."""
    rows, columns = shape
    x = observed.scale * observed.x + (lens.width - 1) / 2
    y = observed.scale * observed.y + (lens.height - 1) / 2
    column = np.clip(np.rint(x / max(lens.width - 1, 1) * (columns - 1)), 0, columns - 1).astype(np.int64)
    row = np.clip(np.rint(y / max(lens.height - 1, 1) * (rows - 1)), 0, rows - 1).astype(np.int64)
    amount = observed.weight * observed.length[:, None]
    sums = np.bincount((row * columns + column).ravel(), amount.ravel(), math.prod(shape))
    return sums.astype(np.float64).reshape(shape)
