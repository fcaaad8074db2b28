"""Where further lines would tell most about a lens, and which images are worth labelling next.

Nothing is fitted: lines add to the information about the lens what their amplitudes' derivatives say, whatever the
amplitudes turn out to be, so the uncertainty that they would leave can be told before anybody draws them (optimal
design of experiments; Pukelsheim 1993). What counts is the field (A-optimality in px), not the parameters.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.calibration.calibration import Calibration
from app.calibration.lens import CameraLens
from app.calibration.lens_solver import judged
from app.calibration.line_noise import UNKNOWN, LineNoise, variances
from app.calibration.observations import (
    SHORTEST,
    LabelledImage,
    LineObservations,
    Observed,
    observe,
    observe_distinct,
)
from app.calibration.posterior import extended_slopes, field_sensitivity, lens_posterior, observable_fields
from app.calibration.priors import BEYOND_SD, prior_sd
from app.vision.frame import frame_grid
from app.vision.segments import Segments

Array = NDArray[np.float64]

MOST_CELLS = 5
APART = 4
"""Cells that two pieces of advice are apart at least."""
LINES, LENGTH, SHARE = 5, 150.0, 0.8
"""What is proposed: so many lines, so many px long, but no longer than a share of the shorter side, in directions
spread evenly."""
USUAL_NOISE = LineNoise(3.0, 0.03, 5.0)
"""Law of lines that aren't there yet."""


def advice(calibration: Calibration, images: Sequence[LabelledImage]) -> list[dict[str, Any]]:
    """Return where five more lines of 150 px would help most, best first.

    Args:
        calibration: Of the camera.
        images: The lines that it was made of.

    Returns:
        At most five cells of the calibration's map: ``x`` and ``y`` of the centre in px, ``column``, ``row``, the
        bound on the cell's error now (``sigma_now``) and with the lines (``sigma_with``) in px, and whether that
        ``halves`` it. None where the frame is too small for lines.
    """
    lens, shown = calibration.lens, calibration.map
    if SHARE * min(lens.width, lens.height) < 2 * SHORTEST:
        return []
    rows, columns = shown.sigma.shape
    observed = observe_distinct(images, lens.width, lens.height)
    posterior = lens_posterior(observed, judged(observed, lens, calibration.released))
    covariance = posterior.covariance[int(np.argmax(posterior.weight))]
    told = _information(_proposed(lens, shown.x, shown.y, calibration.noise), lens).reshape(
        rows * columns, LINES, *covariance.shape
    )
    with_lines = np.linalg.inv(np.linalg.inv(covariance) + told.sum(1))

    sensitivity = field_sensitivity(lens)
    left = np.einsum("cpq,qp->c", with_lines, sensitivity)
    fields = observable_fields(lens, frame_grid(lens.width, lens.height, columns))
    of_cell = np.stack([fields[: rows * columns], fields[rows * columns :]], 1)
    now = np.einsum("cdp,pq,cdq->c", of_cell, covariance, of_cell)
    then = np.einsum("cdp,cpq,cdq->c", of_cell, with_lines, of_cell)
    ratio = np.sqrt(then / np.maximum(now, 1e-300))

    chosen: list[int] = []
    for cell in np.argsort(left, kind="stable"):
        row, column = divmod(int(cell), columns)
        if all(max(abs(row - c // columns), abs(column - c % columns)) >= APART for c in chosen):
            chosen.append(int(cell))
        if len(chosen) == MOST_CELLS:
            break
    return [
        {
            "x": float(shown.x[cell % columns]),
            "y": float(shown.y[cell // columns]),
            "column": cell % columns,
            "row": cell // columns,
            "sigma_now": float(shown.sigma[cell // columns, cell % columns]),
            "sigma_with": float(shown.sigma[cell // columns, cell % columns] * ratio[cell]),
            "halves": bool(ratio[cell] <= 0.5),
        }
        for cell in chosen
    ]


def image_gain(calibration: Calibration, segments: Segments, probability: Array | None = None) -> float:
    """Return by how many px the expected error would fall if an image's candidates were kept.

    Args:
        calibration: Of the camera.
        segments: Candidates of the image, px.
        probability: float64 ``(S,)`` in [0, 1] of each to be kept; ``None`` if all will be.
    """
    lens = calibration.lens
    observed = observe([Observed(segments, probability)], lens.width, lens.height)
    if not len(observed):
        return 0.0
    told = (_information(observed, lens) * observed.probability[:, None, None]).sum(0)
    index = [lens.names.index(name) for name in calibration.released]
    known = np.diag(np.append(prior_sd(lens.family), BEYOND_SD) ** -2.0)
    known[np.ix_(index, index)] = np.linalg.inv(calibration.covariance)
    sensitivity = field_sensitivity(lens)
    before, after = (float(np.trace(np.linalg.inv(matrix) @ sensitivity)) for matrix in (known, known + told))
    return calibration.uncertainty.pred * (1 - np.sqrt(after / before))


def _information(observed: LineObservations, lens: CameraLens) -> Array:
    """Return what each line would tell of all parameters and the one beyond, ``(S, P + 1, P + 1)``."""
    slopes = extended_slopes(observed, lens)
    variance = np.where(observed.known, variances(observed, USUAL_NOISE), np.inf)
    scaled = slopes / np.sqrt(variance)[..., None]
    return np.einsum("sdp,sdq->spq", scaled, scaled)


def _proposed(lens: CameraLens, x: Array, y: Array, noise: float) -> LineObservations:
    """Return lines through the middle of every cell, pushed into the frame where they would leave it."""
    length = min(LENGTH, SHARE * min(lens.width, lens.height))
    angles = np.pi * (np.arange(LINES) + 0.5) / LINES
    half = length / 2 * np.stack([np.cos(angles), np.sin(angles)], -1)
    middle = np.stack(np.meshgrid(x, y), -1).reshape(-1, 1, 2)
    size = np.array([lens.width - 1.0, lens.height - 1.0])
    middle = np.clip(middle, np.abs(half), size - np.abs(half)).reshape(-1, 1, 2)
    along = np.linspace(-1, 1, max(int(length), 8))[:, None]
    points = middle + along * np.tile(half, (len(x) * len(y), 1))[:, None, :]
    segments = Segments.from_list(list(points))
    observed = observe([Observed(segments)], lens.width, lens.height)
    return observed.with_roughness(noise if noise > 0 else UNKNOWN)
