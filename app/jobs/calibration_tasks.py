"""What a worker does to calibrate a camera: lines in; the lens, each line's residual and advice out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.calibration.advice import advice, image_gain
from app.calibration.calibrate import CalibrationImage, calibrate
from app.calibration.calibration import Calibration, LineResiduals
from app.calibration.lens import Family
from app.calibration.line_table import CalibrationLines, packed_lines
from app.calibration.work_order import CalibrationFound, CalibrationInputs, StoredLines
from app.jobs.limits import TaskLimits, bounded
from app.jobs.notes import WorkerNotes, watch_through
from app.jobs.tasks import errors_that_travel

SEED = 0
LIMITS = TaskLimits(seconds=1800.0, megabytes=4096)
"""What the lines of 200 images may take of a worker: a minute and less than a gigabyte, if nothing is wrong."""


def calibrate_task(
    inputs: CalibrationInputs,
    size: tuple[int, int],
    camera_name: str,
    *,
    family: Family | None,
    notes: WorkerNotes,
) -> CalibrationFound:
    """Estimate a camera's lens.

    Args:
        inputs: Its lines.
        size: Width and height of its images, px.
        camera_name: For messages.
        family: The lens model; the one that fits best where it is ``None``.
        notes: Where progress is noted, and the request to stop is found.

    Raises:
        Cancelled: When it was called off.
        ClearLinesError: Always one of the tree, with the reason.
    """
    with errors_that_travel(camera_name, "the calibration"), bounded(LIMITS, "the calibration"):
        watch = watch_through(notes)
        images = [_image(each) for each in inputs.images]
        calibration = calibrate(images, size, family=family, seed=SEED, watch=watch)
        return CalibrationFound(
            parameters=inputs.parameters,
            result=calibration.as_dict(),
            lines=packed_lines(_lines(inputs.images, calibration.lines)),
            advice=_advice(calibration, images, inputs.unlabelled, watch),
        )


def _advice(
    calibration: Calibration,
    images: Sequence[CalibrationImage],
    unlabelled: Sequence[StoredLines],
    watch: Callable[[str, int, int], None],
) -> dict[str, Any]:
    """Return where more lines would help, and what the candidates of unlabelled images would tell."""
    gains: list[dict[str, float]] = []
    for place, each in enumerate(unlabelled):
        watch("advice", place, len(unlabelled))
        gain = float(image_gain(calibration, each.segments, each.probability))
        gains.append({"image_id": each.image_id, "gain": gain if np.isfinite(gain) else 0.0})
    cells = [dict(cell) for cell in advice(calibration, images)]
    return {"cells": cells, "images": sorted(gains, key=lambda entry: -entry["gain"])}


def _image(lines: StoredLines) -> CalibrationImage:
    return CalibrationImage(lines.name, lines.segments, lines.probability)


def _lines(images: Sequence[StoredLines], residuals: Sequence[LineResiduals]) -> CalibrationLines:
    """Put the residuals of all images into one table, under the ids of images and segments."""
    pairs = list(zip(images, residuals, strict=True))
    image_ids = [np.full(len(line.segment), image.image_id, np.int64) for image, line in pairs]
    return CalibrationLines(
        image_id=_joined(image_ids, np.int64),
        segment_id=_joined([image.segment_ids[line.segment] for image, line in pairs], np.int64),
        rms=_joined([line.rms for _, line in pairs], np.float32),
        maximum=_joined([line.maximum for _, line in pairs], np.float32),
        length=_joined([line.length for _, line in pairs], np.float32),
        probability=_joined([line.probability for _, line in pairs], np.float32),
    )


def _joined(parts: Sequence[NDArray], kind: type) -> NDArray:
    return np.concatenate([np.zeros(0, kind), *parts]).astype(kind)
