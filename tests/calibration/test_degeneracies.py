"""Arrangements of lines that tell little, and the least error that lines allow."""

from __future__ import annotations

import numpy as np
import pytest

from app.calibration.calibrate import CalibrationImage, calibrate
from app.calibration.calibration import Calibration
from app.calibration.cramer_rao import fisher_information, least_field_error
from app.calibration.lens import CameraLens
from app.vision.segments import Segments

SIZE = 800, 600
LENS = CameraLens("division", *SIZE, (0.15, 0.0, 0.0, 0.0, 0.0))
CENTER = np.array([399.5, 299.5])


def codes(found: Calibration) -> set[str]:
    return {warned.code for warned in found.warnings}


def spokes(number: int) -> CalibrationImage:
    """Lines that pass near the centre."""
    rng = np.random.default_rng(0)
    lines = []
    for angle in np.linspace(0, np.pi, number, endpoint=False):
        along, across = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
        path = CENTER + rng.uniform(-20, 20) * across + np.linspace(-250, 250, 400)[:, None] * along
        lines.append(LENS.distort(path) + rng.normal(0, 0.1, (400, 1)) * across)
    return CalibrationImage("spokes", Segments.from_list(lines))


def test_good_lines_warn_of_nothing(lines_through):
    assert codes(calibrate(lines_through(LENS, 80), SIZE, family="division")) == set()


def test_lines_near_the_centre():
    found = calibrate([spokes(20)], SIZE, family="division")
    assert {"near-center", "one-image"} <= codes(found)


def test_few_lines(lines_through):
    assert "few-lines" in codes(calibrate(lines_through(LENS, 6), SIZE, family="division"))


def test_one_band_on_one_side_in_one_direction(lines_through):
    images = lines_through(LENS, 30, left=0.8, right=0.95, angles=(np.pi / 2 - 0.05, np.pi / 2 + 0.05))
    found = calibrate(images, SIZE, family="division")
    assert {"one-band", "one-sided", "one-direction"} <= codes(found)
    words = " ".join(warned.message for warned in found.warnings)
    assert "right side" in words
    assert "90 degrees" in words


def test_information_of_one_line_is_the_closed_form():
    # a line at distance d of the centre, of length L, with n points: 4 d^2 n L^4 / (720 sigma^2), in half diagonals
    distance, length, number, noise = 200.0, 300.0, 301, 0.2
    x = np.linspace(-length / 2, length / 2, number) + CENTER[0]
    line = Segments.from_list([np.stack([x, np.full(number, CENTER[1] + distance)], -1)])
    plain = CameraLens.identity("brown", *SIZE)
    found = fisher_information(plain, ["k1"], [line], noise)[0, 0]
    unit = plain.scale
    expected = 4 * (distance / unit) ** 2 * number * (length / unit) ** 4 / (720 * (noise / unit) ** 2)
    assert found == pytest.approx(expected, rel=0.02)


def test_bound_falls_with_lines_and_rises_with_parameters(lines_through):
    images = [image.segments for image in lines_through(LENS, 40, noise=0.0)]
    few = [image.select(np.arange(5)) for image in images]
    bound = least_field_error(LENS, ["k1"], images, 0.1)
    assert bound < least_field_error(LENS, ["k1"], few, 0.1)
    assert bound < least_field_error(LENS, ["k1", "k2", "cx", "cy"], images, 0.1)
    assert least_field_error(LENS, ["k1"], images, 0.2) == pytest.approx(2 * bound)


def test_an_image_that_tells_nearly_all_is_no_disagreement(lines_through):
    many, few = lines_through(LENS, 300, images=1), lines_through(LENS, 2, images=1, seed=9)
    assert "disagreeing-images" not in codes(calibrate([*many, *few], SIZE, family="division"))
