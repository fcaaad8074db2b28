"""Lines that leave the frame, copies of lines, and frames that are none."""

from __future__ import annotations

import numpy as np
import pytest

from app.calibration.advice import advice
from app.calibration.calibrate import CalibrationImage, calibrate
from app.calibration.calibration import Calibration
from app.calibration.lens import FAMILY_NAMES, CameraLens, Family
from app.calibration.observations import Observed, observe, observe_distinct
from app.errors import InvalidInput
from app.vision.segments import Segments

SIZE = 1280, 720
LENS = CameraLens("brown", *SIZE, (0.12, 0.02, 0.0, 0.0, 0.0, 0.0, 0.0))


def codes(found: Calibration) -> set[str]:
    return {warned.code for warned in found.warnings}


def along(first: tuple[float, float], last: tuple[float, float]) -> np.ndarray:
    return np.linspace(first, last, 300)


@pytest.mark.parametrize("family", FAMILY_NAMES)
@pytest.mark.parametrize("last", [(1600.0, 700.0), (1e6, 1e6), (3e38, 0.0), (-400.0, 300.0)])
def test_a_line_that_leaves_the_frame_changes_nothing(lines_through, family: Family, last: tuple[float, float]):
    images = lines_through(LENS, 24)
    without = calibrate(images, SIZE, family=family)
    stray = CalibrationImage("stray", Segments.from_list([along((1100, 650), last)]))
    found = calibrate([*images, stray], SIZE, family=family)
    np.testing.assert_array_equal(found.lens.parameters, without.lens.parameters)
    assert found.counts["used"] == without.counts["used"] == found.counts["segments"] - 1
    assert "outside-frame" in codes(found) - codes(without)


def test_an_end_may_be_a_little_beyond_the_frame():
    inside, outside = along((900, 650), (1284, 650)), along((900, 650), (1300, 650))
    observed = observe([Observed(Segments.from_list([outside, inside]))], *SIZE)
    assert observed.index.tolist() == [1]


@pytest.mark.parametrize("size", [(640, 360), (64, 48)])
def test_lines_of_larger_images_are_refused_with_the_reason(lines_through, size: tuple[int, int]):
    found = calibrate(lines_through(LENS, 60), size)
    assert not found.accepted
    assert any("60 lines leave the frame" in reason for reason in found.reasons)


def test_copies_count_once(lines_through):
    images = lines_through(LENS, 20, images=1)
    once = calibrate(images, SIZE)
    often = calibrate(images * 6, SIZE)
    assert often.lens == once.lens
    assert often.uncertainty == once.uncertainty
    assert "copies" in codes(often)
    assert {"one-image"} == codes(often) - {"copies"}


def test_what_was_left_out_leaves_the_numbers_of_the_others():
    lines = [along((100, 100), (400, 120)), along((100, 100), (400, 120)), along((0, 0), (0, 9000))]
    images = [Observed(Segments.from_list(lines)), Observed(Segments.from_list([*lines, along((50, 60), (500, 90))]))]
    observed = observe_distinct(images, *SIZE)
    assert list(zip(observed.image.tolist(), observed.index.tolist(), strict=True)) == [(0, 0), (1, 3)]


def test_advice_stands_although_its_lines_lie_on_one_another(lines_through):
    small = CameraLens("brown", 320, 240, LENS.parameters)
    images = [
        CalibrationImage(each.name, Segments.from_list([line / 4 for line in each.segments]))
        for each in lines_through(LENS, 30)
    ]
    assert advice(calibrate(images, (small.width, small.height)), images)


def test_too_small_a_frame_gets_no_advice():
    images = [CalibrationImage("small", Segments.empty())]
    assert advice(calibrate(images, (8, 8)), images) == []


def test_no_distortion_is_called_so(lines_through):
    found = calibrate(lines_through(CameraLens.identity("brown", *SIZE), 60), SIZE)
    assert found.accepted
    assert "within-noise" in codes(found)
    assert "within-noise" not in codes(calibrate(lines_through(LENS, 60), SIZE))


def test_a_stripe_is_no_image():
    with pytest.raises(InvalidInput, match="no camera's image"):
        calibrate([CalibrationImage("stripe", Segments.empty())], (20, 4000))
