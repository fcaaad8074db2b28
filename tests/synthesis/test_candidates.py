"""Candidates made of points, with the truth about them."""

from __future__ import annotations

import numpy as np
import pytest

from app.errors import InvalidInput
from app.synthesis.candidates import SHORTEST, CandidateConditions, draw_camera, draw_candidates, draw_radial_lens
from app.synthesis.lens import make_lens

CLEAN = CandidateConditions(1, 40, 1.0, 0.0, 1.0, 80.0)


def bends(points: np.ndarray) -> float:
    """Largest distance from the chord."""
    chord = points[-1] - points[0]
    across = (points - points[0]) @ np.array([-chord[1], chord[0]]) / np.hypot(*chord)
    return float(np.abs(across).max())


@pytest.mark.parametrize("seed", range(6))
def test_a_drawn_camera_is_the_same_for_the_same_seed_and_within_its_frame(seed: int):
    camera, again = draw_camera(seed), draw_camera(seed)
    for segments, same, straight in zip(camera.segments, again.segments, camera.straight, strict=True):
        assert np.array_equal(segments.points, same.points)
        assert len(segments) == len(straight)
        assert (segments.points >= 0).all()
        assert (segments.points <= [camera.lens.width - 1, camera.lens.height - 1]).all()
        assert 0.25 <= straight.mean() <= 1


def test_straight_edges_are_straight_once_the_lens_is_taken_out():
    lens = make_lens(640, 480, 480.0, [-0.3, 0.08, 0, 0, 0])
    camera = draw_candidates(lens, CLEAN, np.random.default_rng(3))
    assert camera.straight[0].all()
    rays = [lens.to_rays(points.astype(np.float64)) * 480.0 for points in camera.segments[0]]
    assert max(bends(points) for points in rays) < 1e-3
    assert max(bends(points) for points in camera.segments[0]) > 1
    assert camera.segments[0].extents().min() >= SHORTEST


@pytest.mark.parametrize("kinds", [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0)])
def test_others_are_not(kinds: tuple[float, float, float]):
    lens = make_lens(640, 480, 480.0, np.zeros(5))
    conditions = CandidateConditions(2, 30, 0.0, 0.0, 1.0, 80.0, kinds)
    camera = draw_candidates(lens, conditions, np.random.default_rng(4))
    assert not camera.straight[0].any()
    assert np.median([bends(points) for points in camera.segments[0]]) > 0.3


def test_border_edges_are_straight_in_the_image_whatever_the_lens():
    lens = make_lens(640, 480, 480.0, [-0.3, 0.08, 0, 0, 0])
    conditions = CandidateConditions(1, 20, 0.0, 0.0, 1.0, 80.0, (0.0, 0.0, 1.0))
    camera = draw_candidates(lens, conditions, np.random.default_rng(5))
    for points in camera.segments[0]:
        assert bends(points) < 1e-6
        assert min(points.min(), (np.array([639, 479]) - points).min()) <= 12


def test_what_belongs_to_the_vehicle_stays_in_place():
    lens = make_lens(640, 480, 480.0, np.zeros(5))
    conditions = CandidateConditions(3, 12, 0.0, 0.0, 1.0, 80.0, vehicle=True)
    camera = draw_candidates(lens, conditions, np.random.default_rng(6))
    first = [segments[0] for segments in camera.segments]
    assert np.array_equal(first[0], first[1])
    assert np.array_equal(first[0], first[2])


def test_noise_is_of_the_size_asked_for():
    lens = make_lens(640, 480, 480.0, np.zeros(5))
    conditions = CandidateConditions(1, 200, 1.0, 0.2, 0.5, 80.0)
    camera = draw_candidates(lens, conditions, np.random.default_rng(7))
    rms: list[float] = []
    for points in camera.segments[0]:
        x = points.astype(np.float64) - points.mean(0)
        rms.append(float(np.linalg.svd(x, compute_uv=False)[1] / np.sqrt(len(x))))
    assert np.median(rms) == pytest.approx(0.2, rel=0.15)


def test_lenses_go_from_barrel_to_pincushion_and_have_an_inverse():
    lenses = [draw_radial_lens(np.random.default_rng(seed), 640, 480) for seed in range(40)]
    k1 = np.array([lens.coefficients[0] for lens in lenses])
    assert k1.min() < -0.2
    assert k1.max() > 0.02
    assert any(lens.coefficients[1] == 0 for lens in lenses)
    assert any(lens.coefficients[1] != 0 for lens in lenses)


@pytest.mark.parametrize(("images", "candidates", "share"), [(0, 5, 0.5), (1, 0, 0.5), (1, 5, 1.5)])
def test_impossible_conditions_are_refused(images: int, candidates: int, share: float):
    with pytest.raises(InvalidInput):
        CandidateConditions(images, candidates, share, 0.1, 1.0, 80.0)
