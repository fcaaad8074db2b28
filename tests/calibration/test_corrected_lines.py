"""Lines of the corrected image, and how they follow the lens."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.calibration.calibration_image import CalibrationImage
from app.calibration.corrected_lines import LensUncertainty, correct_lines
from app.calibration.lens import CameraLens
from app.calibration.mean_points import mean_points
from app.vision.frame import center_of
from app.vision.segments import Segments

LENS = CameraLens("brown", 800, 600, (0.1, 0.02, 0.0, 0.0, 0.0, 0.01, 0.0))
K1 = LensUncertainty(("k1", "cx"), np.diag([0.01**2, 0.005**2]))


def seen(middle, angle, half, noise=0.0, seed=0):
    """A straight line of the corrected image as the lens shows it."""
    steps = np.arange(-half, half)[:, None]
    along = np.array([np.cos(angle), np.sin(angle)])
    across = np.random.default_rng(seed).normal(0, noise, len(steps)) if noise else np.zeros(len(steps))
    return LENS.distort(np.array(middle) + steps * along) + across[:, None] * [-along[1], along[0]]


def test_lines_are_where_they_were_put():
    image = CalibrationImage("one", Segments.from_list([seen((200, 150), 0.3, 80), seen((600, 400), -1.2, 50)]))
    (lines,) = correct_lines([image], LENS, K1)
    assert lines.angle == pytest.approx([0.3, -1.2], abs=1e-5)
    assert lines.length * LENS.scale == pytest.approx(image.segments.extents())
    away = lines.middle * LENS.scale + center_of(800, 600) - [[200, 150], [600, 400]]
    assert np.abs((away * np.stack([-np.sin(lines.angle), np.cos(lines.angle)], -1)).sum(1)).max() < 0.01


def test_a_changed_lens_moves_them_to_first_order():
    image = CalibrationImage("one", Segments.from_list([seen((200, 150), 0.9, 80), seen((650, 100), 0.1, 60)]))
    (lines,) = correct_lines([image], LENS, K1)
    parameters = np.add(LENS.parameters, (0.004, 0, 0, 0, 0, 0.003, 0))
    (moved,) = correct_lines([image], replace(LENS, parameters=tuple(parameters)), K1)
    expected = lines.under(np.array([0.004, 0.003]))
    assert np.abs(moved.angle - lines.angle).max() > 7e-4
    assert expected.angle == pytest.approx(moved.angle, abs=5e-5)
    assert expected.middle == pytest.approx(moved.middle, abs=5e-5)


def test_the_stated_noise_of_a_direction_is_that_of_repeated_draws():
    segments = Segments.from_list([seen((400, 250), 0.4, 75, 0.3, seed) for seed in range(300)])
    (lines,) = correct_lines([CalibrationImage("all", segments)], LENS, K1)
    # noise that neighbouring points don't share is taken to be shared by three, so the statement is on the safe side
    assert np.median(lines.sigma) == pytest.approx(np.sqrt(3) * lines.angle.std(), rel=0.3)


def test_what_says_nothing_is_left_out():
    short, few = seen((300, 300), 0, 5), seen((300, 300), 0, 80)[::40]
    segments = Segments.from_list([short, few, seen((300, 300), 0, 80), seen((300, 300), 1, 80)])
    (lines,) = correct_lines([CalibrationImage("one", segments, np.array([1, 1, 0.01, 0.7]))], LENS, K1)
    assert lines.weight.tolist() == [0.7]
    (none,) = correct_lines([CalibrationImage("none", Segments.empty())], LENS, K1)
    assert len(none) == 0
    assert none.angle_slope.shape == (2, 0)


def test_mean_points_keep_mean_and_noise():
    points = seen((400, 250), 0.4, 150, 0.2, 1)
    means = mean_points(Segments.from_list([points, points[:4]]))
    assert (means.share[0][:, None] * means.points[0]).sum(0) == pytest.approx(points.mean(0), abs=1e-4)
    assert means.share.sum(1) == pytest.approx([1, 1])
    assert means.count.tolist() == [300, 4]
    assert means.noise[0] == pytest.approx(0.2, rel=0.15)
