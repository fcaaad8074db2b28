from __future__ import annotations

from itertools import islice

import cv2
import numpy as np
import pytest
from scipy.ndimage import map_coordinates

from app.errors import InvalidInput
from app.synthesis import IDEAL_SENSOR, Lens, SyntheticScene, make_lens, synthesize_dataset, synthesize_scene
from app.synthesis.distractors import REASON_OF
from app.synthesis.sampling import across
from app.verdicts import REASONS
from app.vision.segments import Segments

FIELDS = [[89.13, 95.26, 141.76, 161.09], [79.73, 79.05, 93.41, 118.76], [111.86, 108.32, 115.15, 99.87]]
LABELS, LABELLED = 66, 3408.8


def edge_offsets(scene: SyntheticScene, segments: Segments) -> tuple[np.ndarray, np.ndarray]:
    """How far from each point the steepest place across the edge lies, px, and which way is bright (+1, -1)."""
    grey = cv2.cvtColor(scene.image, cv2.COLOR_BGR2GRAY).astype(np.float64)
    points = segments.points.astype(np.float64)
    normals = across(points, segments.segment_of_point)
    steps = np.arange(-1.75, 1.8, 0.25)
    at = points[:, None] + steps[None, :, None] * normals[:, None]
    values = map_coordinates(grey, [at[..., 1], at[..., 0]], order=3, mode="nearest")
    slopes = values[:, 2:] - values[:, :-2]
    polarity = np.sign(values[:, len(steps) // 2 + 2] - values[:, len(steps) // 2 - 2])
    slopes *= polarity[:, None]
    best = slopes[:, 1:-1].argmax(axis=1) + 1
    row = np.arange(len(best))
    a, b, c = slopes[row, best - 1], slopes[row, best], slopes[row, best + 1]
    peak = 0.5 * (a - c) / np.minimum(a - 2 * b + c, -1e-9)
    return steps[1:-1][best] + 0.25 * np.clip(peak, -1, 1), polarity


def deviations_from_straight(lens: Lens, segments: Segments) -> np.ndarray:
    """RMS distance of each segment from a line after undistortion, px."""
    focal = lens.matrix[0, 0]
    residuals = []
    for segment in segments:
        rays = lens.to_rays(segment.astype(np.float64)) * focal
        residuals.append(np.linalg.svd(rays - rays.mean(axis=0), compute_uv=False)[1] / np.sqrt(len(rays)))
    return np.array(residuals)


def test_labels_lie_on_the_edges_of_the_image(scene: SyntheticScene) -> None:
    offsets, polarity = edge_offsets(scene, scene.labels)
    assert np.median(np.abs(offsets)) < 0.15  # with the share of the walls' texture
    assert abs(np.median(offsets)) < 0.03
    assert abs(np.median(offsets * polarity)) < 0.03  # neither fat nor thin


@pytest.mark.parametrize("axis", [0, 1])
def test_labels_are_shifted_neither_sideways_nor_up(scene: SyntheticScene, axis: int) -> None:
    offsets, _ = edge_offsets(scene, scene.labels)
    normals = across(scene.labels.points.astype(np.float64), scene.labels.segment_of_point)
    along_axis = np.abs(normals[:, axis]) > 0.95
    assert along_axis.sum() > 500
    assert abs(np.median((offsets * normals[:, axis])[along_axis])) < 0.03


def test_labels_are_straight_after_undistortion_and_curved_before(scene: SyntheticScene, barrel: Lens) -> None:
    assert deviations_from_straight(barrel, scene.labels).max() < 0.01
    pinhole = make_lens(barrel.width, barrel.height, barrel.matrix[0, 0], np.zeros(5))
    assert deviations_from_straight(pinhole, scene.labels).max() > 1.0


def test_distractors_are_not_straight_but_for_shadows(scene: SyntheticScene, barrel: Lens) -> None:
    assert len(scene.distractors) == len(scene.reasons) == len(scene.distractor_kinds) > 3
    long = (scene.distractors.lengths() > 60) & (np.array(scene.distractor_kinds) != "shadow")
    assert long.any()
    deviations = deviations_from_straight(barrel, scene.distractors.select(long))
    assert deviations.min() > 0.05  # five times what the labels may have
    assert deviations.max() > 0.5


def test_labels_are_sampled_about_every_pixel(scene: SyntheticScene) -> None:
    for segment in scene.labels:
        steps = np.linalg.norm(np.diff(segment.astype(np.float64), axis=0), axis=1)
        assert steps.min() > 0.9
        assert steps.max() < 1.1
    assert scene.labels.extents().min() > 18


def test_labels_are_many_and_of_many_kinds(scene: SyntheticScene) -> None:
    assert len(scene.labels) == len(scene.line_ids) == len(scene.kinds) > 100
    assert (scene.labels.extents() >= 100).sum() > 10
    assert {"kerb", "pole", "window pane", "lane marking", "cornice"} <= set(scene.kinds)


def test_reasons_are_those_of_reviewers(scene: SyntheticScene) -> None:
    assert set(REASON_OF.values()) <= set(REASONS)
    assert scene.reasons == tuple(REASON_OF[kind] for kind in scene.distractor_kinds)
    assert {"shadow", "curved"} <= set(scene.reasons)


def test_no_distractor_lies_on_a_label(scene: SyntheticScene) -> None:
    place = np.zeros(scene.image.shape[:2], bool)
    labels = np.rint(scene.labels.points).astype(int)
    place[labels[:, 1], labels[:, 0]] = True
    on_label = [
        place[points[:, 1], points[:, 0]].mean() for points in map(_rounded, scene.distractors) if len(points) > 40
    ]
    assert max(on_label) < 0.3  # they may cross


def _rounded(segment: np.ndarray) -> np.ndarray:
    return np.rint(segment).astype(int)


def test_hardly_visible_edges_are_not_labels(scene: SyntheticScene) -> None:
    assert 0 < len(scene.ambiguous) == len(scene.ambiguous_ids) == len(scene.ambiguous_kinds) < len(scene.labels)
    grey = cv2.cvtColor(scene.image, cv2.COLOR_BGR2GRAY).astype(np.float64)

    def step(segments: Segments) -> float:
        points = segments.points.astype(np.float64)
        aside = 2.0 * across(points, segments.segment_of_point)
        sides = [map_coordinates(grey, (points + aside * sign)[:, ::-1].T, order=1) for sign in (-1, 1)]
        return float(np.median(np.abs(sides[0] - sides[1])))

    assert step(scene.ambiguous) < 15 < step(scene.labels)


def test_a_seed_gives_one_scene_on_every_machine() -> None:
    """Mean grey of a grid of 4 x 3 fields: other processors and versions of OpenCV may round differently."""
    scene = synthesize_scene(12, width=320, height=240, sensor=IDEAL_SENSOR)
    grey = cv2.cvtColor(scene.image, cv2.COLOR_BGR2GRAY).astype(np.float64)
    fields = grey.reshape(3, 80, 4, 80).mean(axis=(1, 3))
    assert fields == pytest.approx(np.array(FIELDS), abs=0.5)
    assert len(scene.labels) == pytest.approx(LABELS, abs=1)
    assert scene.labels.lengths().sum() == pytest.approx(LABELLED, rel=0.01)


def test_an_edge_behind_something_has_fragments(scene: SyntheticScene) -> None:
    lines, counts = np.unique(scene.line_ids, return_counts=True)
    assert counts.max() > 1
    line = int(lines[counts.argmax()])
    fragments = np.flatnonzero(scene.line_ids == line)
    assert len({scene.kinds[int(index)] for index in fragments}) == 1


def test_image_and_camera_fit_together(scene: SyntheticScene, barrel: Lens) -> None:
    assert scene.image.shape == (barrel.height, barrel.width, 3)
    assert scene.image.dtype == np.uint8
    assert scene.camera.lens is barrel
    assert scene.image.std() > 20
    blue, _, red = scene.image[:20, 300:500].reshape(-1, 3).mean(axis=0)
    assert blue > red  # the sky


def same(one: SyntheticScene, other: SyntheticScene) -> bool:
    return np.array_equal(one.image, other.image) and one.labels == other.labels and one.kinds == other.kinds


def test_a_seed_is_a_scene() -> None:
    one, again, other = (synthesize_scene(seed, width=240, height=160) for seed in (3, 3, 4))
    assert same(one, again)
    assert not np.array_equal(one.image, other.image)
    assert not np.array_equal(one.camera.coefficients, other.camera.coefficients)


def test_a_dataset_is_one_camera_in_several_streets() -> None:
    made = list(synthesize_dataset(3, 5, width=240, height=160, sequence_length=2))
    assert [name for name, _ in made] == ["street-00/000000", "street-00/000001", "street-01/000002"]
    assert len({id(scene.camera.lens) for _, scene in made}) == 1
    assert not np.array_equal(made[0][1].image, made[1][1].image)
    name, scene = next(islice(synthesize_dataset(1, 5, width=240, height=160, sequence_length=2), 1))
    assert name == made[0][0]
    assert same(scene, made[0][1])


def test_no_images_are_a_dataset_too() -> None:
    assert list(synthesize_dataset(0, 1)) == []


@pytest.mark.parametrize(
    "arguments",
    [(-1, 640, 480), (0, 20, 480), (0, 640, 10**6)],
)
def test_what_makes_no_scene_is_refused(arguments: tuple[int, int, int]) -> None:
    seed, width, height = arguments
    with pytest.raises(InvalidInput):
        synthesize_scene(seed, width=width, height=height)


def test_a_lens_for_another_size_is_refused(barrel: Lens) -> None:
    with pytest.raises(InvalidInput, match="the lens is for"):
        synthesize_scene(0, width=640, height=480, lens=barrel)


@pytest.mark.parametrize(("count", "length"), [(-1, 4), (2, 0)])
def test_what_makes_no_dataset_is_refused_at_once(count: int, length: int) -> None:
    with pytest.raises(InvalidInput):
        synthesize_dataset(count, 0, sequence_length=length)
