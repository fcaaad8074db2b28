"""The report that a worker makes of a finished calibration."""

from __future__ import annotations

from datetime import UTC, datetime

import numpy as np
import pytest

from app.calibration.calibrate import CalibrationImage, calibrate
from app.formats.reference_camera import ReferenceCamera
from app.jobs.calibration_report import ReportInputs, report_task
from app.vision.segments import Segments

MATRIX = ((900.0, 0.0, 320.0), (0.0, 900.0, 240.0), (0.0, 0.0, 1.0))


@pytest.fixture(scope="module")
def result():
    lines = [np.linspace((20, 40 * row), (600, 40 * row + 15), 200) for row in range(1, 11)]
    return calibrate([CalibrationImage("a", Segments.from_list(lines))], (640, 480), family="division").as_dict()


@pytest.mark.parametrize(
    ("reference", "compared"),
    [
        (None, False),
        (ReferenceCamera(640, 480, MATRIX, (-0.2, 0.0, 0.0, 0.0, 0.0)), True),
        (ReferenceCamera(640, 480, MATRIX, (-50.0, 0.0, 0.0, 0.0, 0.0)), False),
        (ReferenceCamera(640, 480, MATRIX, (1e11, 0.0, 0.0, 0.0, 0.0)), False),
    ],
)
def test_a_reference_beyond_comparing_takes_no_report_away(result, reference, compared: bool) -> None:
    made = datetime(2026, 1, 2, tzinfo=UTC)
    page = report_task(ReportInputs(result, None, (1,), "<front>", None, reference, made), 10**6).decode()
    assert "&lt;front&gt;" in page
    assert ("Difference to" in page) == compared
