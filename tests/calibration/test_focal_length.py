"""Focal length and principal point from drawn scenes of which both are known."""

from __future__ import annotations

import json

import numpy as np
import pytest

from app.calibration.calibration_image import CalibrationImage
from app.calibration.corrected_lines import LensUncertainty
from app.calibration.focal_estimate import FocalEstimate
from app.calibration.focal_length import estimate_focal
from app.calibration.lens import CameraLens
from app.errors import InvalidInput
from app.vision.frame import center_of
from app.vision.segments import Segments

WIDTH, HEIGHT = 1024, 768
FOCAL = 900.0
BARREL = CameraLens("brown", WIDTH, HEIGHT, (0.12, 0.02, 0.0, 0.0, 0.0, 0.01, -0.005))


def axes(yaw, pitch, corner=np.pi / 2):
    """Two horizontal directions at an angle, and the vertical between them, in the camera's axes."""
    world = np.array([[1, 0, 0], [0, 1, 0], [np.cos(corner), 0, np.sin(corner)]])
    cy, sy, cp, sp = np.cos(yaw), np.sin(yaw), np.cos(pitch), np.sin(pitch)
    return (
        world @ (np.array([[1, 0, 0], [0, cp, -sp], [0, sp, cp]]) @ np.array([[cy, 0, -sy], [0, 1, 0], [sy, 0, cy]])).T
    )


def image(name, directions, rng, each=12, center=None, noise=0.1, lens=BARREL):
    """Lines of 60 to 300 px towards each direction, through the lens."""
    xc, yc = center or center_of(WIDTH, HEIGHT)
    size = np.array([WIDTH - 1, HEIGHT - 1])
    lines = []
    for direction in directions:
        drawn = 0
        while drawn < each:
            middle = lens.undistort(rng.uniform(0.05, 0.95, (1, 2)) * size)[0]
            along = FOCAL * direction[:2] - (middle - [xc, yc]) * direction[2]
            along = along / np.hypot(*along)
            points = lens.distort(middle + np.arange(-rng.uniform(30, 150), rng.uniform(30, 150))[:, None] * along)
            points = points[np.isfinite(points).all(1) & ((points >= 0) & (points <= size)).all(1)]
            if len(points) >= 50:
                lines.append(points + rng.normal(0, noise, len(points))[:, None] * [-along[1], along[0]])
                drawn += 1
    return CalibrationImage(name, Segments.from_list(lines))


def facade(number, seed, **options):
    rng = np.random.default_rng(seed)
    return [
        image(f"{index}", axes(rng.uniform(0.4, 1.1), rng.normal(0, 0.1)), rng, **options) for index in range(number)
    ]


def told(found):
    """Focal length and sigma of an estimate that has them."""
    assert found.focal_length is not None
    assert found.sigma is not None
    return found.focal_length, found.sigma


def test_images_of_square_buildings_tell_the_focal_length():
    found = estimate_focal(facade(4, 1), BARREL)
    assert found.observable
    focal, sigma = told(found)
    assert focal == pytest.approx(FOCAL, rel=0.02)
    assert abs(focal - FOCAL) < 3 * sigma
    assert sigma < 0.03 * FOCAL
    assert found.images == 4
    assert found.reason is None


def test_three_directions_in_one_image_confirm_each_other():
    found = estimate_focal(facade(1, 2), BARREL)
    assert found.observable
    focal, sigma = told(found)
    assert abs(focal - FOCAL) < 3 * sigma
    assert found.principal_point is None  # one image can't tell
    assert sorted(point.lines for point in found.vanishing_points) >= [9, 9, 9]
    for point in found.vanishing_points:
        assert np.linalg.norm(point.direction) == pytest.approx(1)


def test_the_principal_point_is_found_where_many_images_tell():
    center = (WIDTH / 2 + 30, HEIGHT / 2 - 25)
    found = estimate_focal(facade(8, 3, each=20, center=center), BARREL)
    assert found.principal_point is not None
    away = np.abs(np.array(found.principal_point) - center)
    assert (away < 3 * np.array(found.principal_point_sigma)).all()
    assert (away < 12).all()


def test_an_uncertain_lens_makes_the_answer_uncertain():
    images = facade(1, 4, each=5)
    sure, unsure = (
        estimate_focal(images, BARREL, uncertain=LensUncertainty(("cx", "cy"), np.diag([sd**2, sd**2])))
        for sd in (1e-4, 0.1)
    )
    assert told(unsure)[1] > 1.005 * told(sure)[1]


def test_a_lens_may_be_known_exactly():
    images = facade(2, 13)
    exact = estimate_focal(images, BARREL, uncertain=LensUncertainty((), np.zeros((0, 0))))
    assert told(exact)[0] == pytest.approx(FOCAL, rel=0.03)


def test_a_wrong_lens_is_taken_for_what_it_may_be():
    wrong = CameraLens("brown", WIDTH, HEIGHT, (0.10, 0.02, 0.0, 0.0, 0.0, 0.01, -0.005))
    found = estimate_focal(facade(6, 5, each=20), wrong, uncertain=LensUncertainty(("k1",), np.array([[0.02**2]])))
    assert found.observable
    focal, sigma = told(found)
    assert abs(focal - FOCAL) < 3 * sigma


def test_a_street_seen_along_its_axis_leaves_it_open():
    rng = np.random.default_rng(6)
    images = [image(str(index), axes(0.01, 0.005), rng) for index in range(4)]
    found = estimate_focal(images, BARREL)
    assert not found.observable
    assert found.focal_length is None
    assert found.sigma is None
    assert "axis" in str(found.reason) or "agree" in str(found.reason)


def test_one_pair_of_directions_in_one_image_is_not_taken_on_trust():
    rng = np.random.default_rng(7)
    found = estimate_focal([image("only", axes(0.7, 0.0)[[0, 2]], rng, each=20)], BARREL)
    assert not found.observable
    assert "nothing confirms" in str(found.reason)


@pytest.mark.parametrize("seed", range(3))
def test_walls_at_another_angle_do_not_pass_for_square(seed):
    rng = np.random.default_rng(seed)
    images = [
        image(str(index), axes(rng.uniform(-np.pi, np.pi), rng.normal(0, 0.1), np.deg2rad(60))[[0, 2]], rng)
        for index in range(6)
    ]
    assert not estimate_focal(images, BARREL).observable


def test_one_direction_is_not_enough():
    rng = np.random.default_rng(8)
    found = estimate_focal([image("road", axes(0.3, 0.0)[2:], rng, each=20)], BARREL)
    assert not found.observable
    assert "one vanishing point" in str(found.reason)


def test_nothing_tells_nothing():
    found = estimate_focal([CalibrationImage("empty", Segments.empty())], BARREL)
    assert found == FocalEstimate(False, reason=found.reason)
    assert "no image" in str(found.reason)
    assert estimate_focal([], BARREL).observable is False


def test_improbable_lines_do_not_count():
    rng = np.random.default_rng(9)
    good = facade(3, 10)
    disturbed = []
    for each in good:
        false = image("false", rng.normal(0, 1, (3, 3)), rng, each=10).segments
        both = Segments.from_list([*each.segments, *false])
        odds = np.where(np.arange(len(both)) < len(each.segments), 0.95, 0.02)
        disturbed.append(CalibrationImage(each.name, both, odds))
    plain, found = estimate_focal(good, BARREL), estimate_focal(disturbed, BARREL)
    assert told(found)[0] == pytest.approx(told(plain)[0], rel=0.01)


def test_the_same_lines_give_the_same_answer():
    images = facade(2, 11)
    assert estimate_focal(images, BARREL, seed=3) == estimate_focal(images, BARREL, seed=3)


def test_the_interval_covers_what_it_should():
    ratios = []
    for seed in range(16):
        found = estimate_focal(facade(2, 100 + seed, each=7), BARREL)
        if found.observable:
            focal, sigma = told(found)
            ratios.append(abs(focal - FOCAL) / sigma)
    assert len(ratios) >= 12
    assert np.mean(np.array(ratios) < 1.96) >= 0.85


def test_fields_are_read_back():
    for images in (facade(3, 12), []):
        found = estimate_focal(images, BARREL)
        assert FocalEstimate.from_dict(json.loads(json.dumps(found.as_dict()))) == found
    with pytest.raises(InvalidInput, match="focal length"):
        FocalEstimate.from_dict({"observable": True})
