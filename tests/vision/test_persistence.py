"""Static edges over the frames of a drive."""

from __future__ import annotations

import numpy as np

from app.vision.persistence import static_segments
from app.vision.segments import Segments

WIDTH, HEIGHT = 640, 480


def line(x0: float, y0: float, x1: float, y1: float) -> np.ndarray:
    t = np.linspace(0, 1, int(np.hypot(x1 - x0, y1 - y0)) + 1)[:, None]
    return np.array([x0, y0]) + t * np.array([x1 - x0, y1 - y0])


def drive(frames: int) -> list[Segments]:
    """Each frame: the bonnet's rim, a little jittered, and lines of the scene elsewhere each time."""
    generator = np.random.default_rng(3)
    images = []
    for _ in range(frames):
        scene = [line(*generator.uniform([20, 20, 300, 20], [300, 330, 620, 330])) for _ in range(6)]
        images.append(Segments.from_list([line(100, 440, 540, 440) + generator.uniform(-1, 1, (1, 2)), *scene]))
    return images


def test_the_bonnet_is_found_and_the_scene_is_not():
    masks = static_segments(drive(12), WIDTH, HEIGHT)
    assert all(mask[0] for mask in masks)
    assert np.mean([mask[1:].mean() for mask in masks]) < 0.1


def test_another_direction_at_the_same_place_is_not_static():
    images = drive(12)
    crossing = Segments.from_list([line(300, 400, 300, 478)])
    masks = static_segments([*images, crossing], WIDTH, HEIGHT)
    assert not masks[-1][0]


def test_a_texture_of_parallel_lines_hits_beside_as_well():
    # shutters: lines every 12 px, in the same place in every image
    shutters = Segments.from_list([line(100, y, 300, y) for y in range(100, 300, 12)])
    masks = static_segments([shutters] * 12, WIDTH, HEIGHT)
    assert not any(mask[3:-3].any() for mask in masks)


def test_few_images_or_none_tell_nothing():
    assert static_segments([], WIDTH, HEIGHT) == []
    assert not np.concatenate(static_segments(drive(3), WIDTH, HEIGHT)).any()
    assert [len(mask) for mask in static_segments([Segments.empty()] * 5, WIDTH, HEIGHT)] == [0] * 5


def test_points_outside_the_frame_do_no_harm():
    outside = Segments.from_list([line(-50, -20, 700, 500)])
    assert len(static_segments([outside] * 5, WIDTH, HEIGHT)) == 5
