"""No edge is returned twice."""

import cv2
import numpy as np
import pytest
from scipy.spatial import KDTree

from app.vision.parameters import DetectionParameters
from app.vision.pipeline import detect
from app.vision.segments import Segments

EVERYTHING = DetectionParameters(min_length=50, operating_point="recall")
DISTANCE = 1.0
ANGLE = np.radians(5.0)


def largest_overlap(segments: Segments) -> float:
    """Largest share of a segment's points that lie within 1 px of a longer one that runs within 5 degrees there."""
    points, segment = segments.points.astype(float), segments.segment_of_point
    rows = np.arange(len(points))
    before = np.maximum(rows - 4, segments.offsets[:-1][segment])
    after = np.minimum(rows + 4, segments.offsets[1:][segment] - 1)
    direction = points[after] - points[before]
    direction /= np.hypot(*direction.T)[:, None]
    pairs = KDTree(points).query_pairs(DISTANCE * np.sqrt(2) + 0.1, output_type="ndarray")
    one, other = np.concatenate([pairs, pairs[:, ::-1]]).T
    apart = points[other] - points[one]
    own = direction[one]
    near = np.abs(own[:, 0] * apart[:, 1] - own[:, 1] * apart[:, 0]) <= DISTANCE
    near &= np.abs((own * direction[other]).sum(axis=1)) >= np.cos(ANGLE)
    near &= segments.counts[segment[one]] <= segments.counts[segment[other]]
    near &= segment[one] != segment[other]
    covered = np.unique(one[near] * len(segments) + segment[other[near]])
    shorter, longer = segment[covered // len(segments)], covered % len(segments)
    _, first, count = np.unique(shorter * len(segments) + longer, return_index=True, return_counts=True)
    return float((count / segments.counts[shorter[first]]).max(initial=0))


def test_two_copies_of_an_edge_are_noticed() -> None:
    line = np.stack([np.arange(100.0), np.full(100, 20.0)], axis=1)
    assert largest_overlap(Segments.from_list([line, line[20:60] + np.array([0, 0.8])])) == 1.0
    assert largest_overlap(Segments.from_list([line, line[20:60] + np.array([0, 1.2])])) == 0.0
    assert largest_overlap(Segments.from_list([line, line[60:] + np.array([20, 0.5])])) == 0.525


@pytest.mark.parametrize("name", ["P1020171", "P1030001", "P1040845"])
def test_no_edge_of_a_photo_is_returned_twice(street, name: str) -> None:
    found = detect(street(name), EVERYTHING)
    assert len(found) > 100
    assert largest_overlap(found) <= 0.5


@pytest.mark.parametrize("seed", range(3))
def test_no_edge_of_a_scene_of_bars_and_curves_is_returned_twice(seed: int) -> None:
    rng = np.random.default_rng(seed)
    image = np.full((300, 400), 110, np.uint8)
    for _ in range(12):
        start, end = rng.integers(0, (400, 300), (2, 2)).tolist()
        cv2.line(image, start, end, (int(rng.integers(0, 256)),), int(rng.integers(2, 9)), cv2.LINE_AA)
    for _ in range(3):
        center, radius = rng.integers(0, (400, 300)).tolist(), int(rng.integers(60, 300))
        cv2.circle(image, center, radius, (int(rng.integers(0, 256)),), 3, cv2.LINE_AA)
    noisy = np.clip(image + rng.normal(0, 3, image.shape), 0, 255).astype(np.uint8)
    found = detect(cv2.GaussianBlur(noisy, (0, 0), 0.7), EVERYTHING)
    assert len(found) >= 10
    assert largest_overlap(found) <= 0.5


def test_steps_on_either_side_of_a_bar_are_no_copies() -> None:
    image = np.full((120, 200), 60, np.uint8)
    image[60:63, 20:180] = 180
    found = detect(cv2.GaussianBlur(image, (0, 0), 0.6), EVERYTHING)
    assert len(found) == 2
    assert largest_overlap(found) == 0.0
