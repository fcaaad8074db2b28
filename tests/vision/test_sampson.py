"""Straightness residuals in the measured image."""

from __future__ import annotations

import numpy as np
import pytest

from app.vision.bins import bin_segments
from app.vision.brown import Brown
from app.vision.lens_fit import DIVISION
from app.vision.msac import BROWN
from app.vision.sampson import bend, sampson_residuals
from app.vision.segments import Segments

LENS = Brown(640, 480, (319.5, 239.5), 400.0, (0.25, 0.0, 0.0))


def test_residuals_of_a_known_zigzag():
    points = np.array([[x, 100 + 0.5 * (-1) ** x] for x in range(200)])
    residual = sampson_residuals(Segments.from_list([points]), Brown.identity(640, 480))
    assert residual == pytest.approx(0.5 * (-1.0) ** np.arange(200), abs=0.01)


def test_residuals_vanish_for_lines_seen_through_the_lens(segments_through):
    segments = segments_through(LENS, 20, noise=0.0)
    assert np.abs(sampson_residuals(segments, LENS)).max() < 0.01
    assert np.abs(sampson_residuals(segments, Brown.identity(640, 480))).max() > 1


def test_residuals_are_px_of_the_measured_image_however_far_the_lens_stretches(segments_through):
    segments = segments_through(LENS, 20, noise=0.3)
    assert np.sqrt(np.mean(sampson_residuals(segments, LENS) ** 2)) == pytest.approx(0.3, rel=0.05)


def test_segments_without_extent_have_no_residuals():
    segments = Segments.from_list([[[5, 5]], [[1, 1], [9, 4]], [[3, 3], [3, 3]]])
    assert np.abs(sampson_residuals(segments, LENS)).max() < 1e-9


def test_bend_of_a_parabola_is_its_quadratic_amplitude():
    # on [0, 1] the RMS of s * 4 t (1 - t) without its linear part is s * 4 / sqrt(180)
    t = np.linspace(0, 1, 4800)
    points = np.stack([100 + 400 * t, 200 + 3 * 4 * t * (1 - t)], -1)
    left = bend(bin_segments([Segments.from_list([points])], 640, 480), DIVISION, np.zeros(5))
    assert abs(left.quadratic[0]) == pytest.approx(3 * 4 / np.sqrt(180), rel=0.01)
    assert abs(left.cubic[0]) < 0.01


@pytest.mark.parametrize("bent", [0.0, 1.0])
def test_slopes_of_the_bend_agree_with_finite_differences(segments_through, bent: float):
    binned = bin_segments([segments_through(LENS, 20, noise=0.0, bent=bent)], 640, 480)
    parameters = np.array([0.15, 0, 0, 0, 0, 0, 0])
    left = bend(binned, BROWN, parameters, slopes=range(7))
    for column in range(7):
        shift = 1e-4 * np.eye(7)[column]
        ahead, behind = bend(binned, BROWN, parameters + shift), bend(binned, BROWN, parameters - shift)
        for name in ("quadratic", "cubic"):
            here, up, down = (getattr(each, name) for each in (left, ahead, behind))
            # a vertical line's sense may turn between them
            up, down = (np.where(np.abs(there - here) > np.abs(there + here), -there, there) for there in (up, down))
            clear = np.abs(here) > np.abs(up - down)
            exact = (up - down) / 2e-4
            assert clear.mean() > 0.5
            slope = getattr(left, f"{name}_slope")[:, column]
            assert slope[clear] == pytest.approx(exact[clear], abs=1e-3 * np.abs(exact).max())


def test_slopes_come_in_the_order_asked_for(segments_through):
    binned = bin_segments([segments_through(LENS, 5)], 640, 480)
    every, some = (bend(binned, BROWN, np.zeros(7), slopes=columns) for columns in (range(7), (5, 0)))
    assert (some.quadratic_slope == every.quadratic_slope[:, [5, 0]]).all()
    assert bend(binned, BROWN, np.zeros(7)).cubic_slope.shape == (5, 0)


def test_division_and_brown_bend_alike_under_weak_lenses(segments_through):
    binned = bin_segments([segments_through(LENS, 20, noise=0.0)], 640, 480)
    division = bend(binned, DIVISION, np.zeros(5), slopes=range(5))
    brown = bend(binned, BROWN, np.zeros(7), slopes=range(7))
    assert division.quadratic == pytest.approx(brown.quadratic)
    assert division.quadratic_slope[:, :3] == pytest.approx(brown.quadratic_slope[:, :3], abs=1e-4)
    assert division.quadratic_slope[:, 3:] == pytest.approx(brown.quadratic_slope[:, 5:], abs=1e-4)
