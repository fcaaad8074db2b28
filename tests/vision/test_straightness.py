"""Probability of being straight under a lens."""

from __future__ import annotations

import numpy as np
import pytest

from app.vision.brown import Brown
from app.vision.distortion import DistortionEstimate, estimate_distortion
from app.vision.segments import Segments
from app.vision.straightness import edge_noise, judge_straightness

SIZE = 640, 480
LENS = Brown(*SIZE, (319.5, 239.5), 400.0, (0.2, 0.0, 0.0))


@pytest.fixture
def accepted(segments_through) -> DistortionEstimate:
    estimate = estimate_distortion([segments_through(LENS, 150)], SIZE)
    assert estimate.accepted
    return estimate


@pytest.fixture
def refused() -> DistortionEstimate:
    return estimate_distortion([], SIZE)


def arc(sagitta: float, noise: float = 0.0) -> np.ndarray:
    """A horizontal arc of 300 px through the image's centre, where a lens bends nothing."""
    t = np.linspace(0, 1, 301)
    offset = sagitta * (4 * t * (1 - t) - 2 / 3) + noise * np.random.default_rng(0).normal(size=301)
    return np.stack([169.5 + 300 * t, 239.5 + offset], -1)


def test_true_lines_pass_and_curves_fail(segments_through, accepted: DistortionEstimate):
    straightness = judge_straightness(segments_through(LENS, 60, bent=0.5, seed=9), accepted)
    assert straightness.dtype == np.float32
    assert straightness[:30].max() < 0.5
    assert straightness[30:].min() > 0.9


def test_lines_that_only_look_straight_fail_under_the_lens(segments_through, accepted: DistortionEstimate):
    straight_in_the_image = Segments.from_list([np.linspace([20, 30], [600, 30], 500)])
    assert judge_straightness(straight_in_the_image, accepted)[0] < 0.1


def test_half_a_px_of_rms_is_as_likely_as_not(refused: DistortionEstimate):
    # the RMS of a parabola of sagitta s after its line is s * 4 / sqrt(180)
    sagitta = 0.5 * np.sqrt(180) / 4
    values = judge_straightness(Segments.from_list([arc(0.5 * sagitta), arc(sagitta), arc(2 * sagitta)]), refused)
    assert values == pytest.approx([16 / 17, 0.5, 1 / 17], abs=0.02)


def test_one_far_point_counts(refused: DistortionEstimate):
    spike = arc(0.0)
    spike[150, 1] += 3.0
    assert judge_straightness(Segments.from_list([spike]), refused)[0] == pytest.approx(1 / 17, abs=0.02)


def test_falls_with_the_bend(refused: DistortionEstimate):
    values = judge_straightness(Segments.from_list([arc(s) for s in np.linspace(0, 12, 30)]), refused)
    assert (np.diff(values) <= 0).all()
    assert values[0] == pytest.approx(1)
    assert values[-1] < 0.01


def test_without_a_lens_a_line_under_any_plausible_one_passes(segments_through, refused: DistortionEstimate):
    values = judge_straightness(segments_through(LENS, 40, seed=4), refused)
    assert (values >= 0.5).mean() > 0.9
    # but a strong bend against the lens, or where no lens bends, is none
    assert judge_straightness(Segments.from_list([arc(8.0)]), refused)[0] < 0.1


def test_noise_is_measured_and_widens_the_limit(refused: DistortionEstimate):
    noisy = Segments.from_list([arc(0.0, 0.25)] * 3)
    assert edge_noise(noisy) == pytest.approx(0.25, rel=0.2)
    assert edge_noise(Segments.from_list([arc(3.0)])) < 0.01
    bend = 0.6 * np.sqrt(180) / 4
    alone, among_noise = Segments.from_list([arc(bend)]), Segments.from_list([arc(bend), *[arc(0.0, 0.25)] * 3])
    assert judge_straightness(alone, refused)[0] < 0.5 < judge_straightness(among_noise, refused)[0]


def test_the_same_after_the_estimate_was_stored(segments_through, accepted: DistortionEstimate):
    segments = segments_through(LENS, 30, bent=0.5, noise=0.2)
    stored = DistortionEstimate.from_dict(accepted.as_dict())
    assert (judge_straightness(segments, stored) == judge_straightness(segments, accepted)).all()


def test_none_and_tiny_segments(accepted: DistortionEstimate, refused: DistortionEstimate):
    assert judge_straightness(Segments.empty(), accepted).shape == (0,)
    tiny = Segments.from_list([[[5, 5]], [[1, 1], [9, 4]], [[3, 3], [3, 3]]])
    for estimate in (accepted, refused, estimate_distortion([], (1, 1))):
        assert judge_straightness(tiny, estimate) == pytest.approx(np.ones(3))
