"""What features measure, and what they must not depend on."""

from __future__ import annotations

from collections.abc import Callable

import cv2
import numpy as np
import pytest

from app.review.features import FEATURES, NeighbourFrames, candidate_features
from app.vision import Segments
from app.vision.distortion import estimate_distortion

SIZE = (640, 480)
Lines = Callable[..., Segments]
Facade = tuple[Segments, np.ndarray]


def column(table: np.ndarray, name: str) -> np.ndarray:
    return table[:, FEATURES.index(name)]


def test_names_are_distinct_and_as_many_as_columns(facade: Facade) -> None:
    segments, gray = facade
    table = candidate_features(segments, gray=gray, size=SIZE)
    assert len(set(FEATURES)) == len(FEATURES)
    assert table.shape == (len(segments), len(FEATURES))
    assert table.dtype == np.float32


def test_what_is_not_known_is_nan_and_nothing_else(facade: Facade) -> None:
    segments, gray = facade
    table = candidate_features(segments, gray=gray, size=SIZE)
    unknown = {FEATURES[index] for index in np.flatnonzero(np.isnan(table).any(axis=0))}
    assert unknown == {"straightness", "residual", "residual over length", "frames before and after"}
    blind = candidate_features(segments, gray=None, size=SIZE)
    assert np.isnan(column(blind, "contrast")).all()
    assert np.array_equal(column(blind, "length"), column(table, "length"))


def test_a_mirrored_image_has_the_same_features(facade: Facade) -> None:
    segments, gray = facade
    mirrored = Segments.from_list([[639, 0] + points * [-1, 1] for points in segments], segments.scores)
    table = candidate_features(segments, gray=gray, size=SIZE)
    flipped = candidate_features(mirrored, gray=np.ascontiguousarray(gray[:, ::-1]), size=SIZE)
    assert np.allclose(table, flipped, atol=0.02, equal_nan=True)


def test_the_order_of_candidates_does_not_matter(facade: Facade) -> None:
    segments, gray = facade
    order = np.random.default_rng(2).permutation(len(segments))
    table = candidate_features(segments, gray=gray, size=SIZE)[order]
    shuffled = candidate_features(segments.select(order), gray=gray, size=SIZE)
    # vanishing points come from random triples
    steady = [index for index, name in enumerate(FEATURES) if "vanishing" not in name and "support" not in name]
    steady = [index for index in steady if FEATURES[index] not in ("upright deviation", "length pointing along")]
    assert np.allclose(table[:, steady], shuffled[:, steady], atol=1e-4, equal_nan=True)


def test_a_moved_picture_keeps_what_is_not_a_place(lines: Lines) -> None:
    gray = np.full((480, 640), 90, np.uint8)
    cv2.rectangle(gray, (150, 120), (300, 260), 200, -1)
    ends = [((150, 120), (300, 120)), ((150, 120), (150, 260)), ((300, 120), (300, 260)), ((150, 260), (300, 260))]
    segments = lines(ends, [0.5, 0.6, 0.7, 0.8])
    moved = Segments.from_list([points + np.array([40, 20], np.float32) for points in segments], segments.scores)
    table = candidate_features(segments, gray=gray, size=SIZE)
    shifted = candidate_features(moved, gray=np.roll(gray, (20, 40), (0, 1)), size=SIZE)
    for name in ("length", "contrast", "polarity", "corners", "length rank", "upright", "bar", "parallel distance"):
        assert np.allclose(column(table, name), column(shifted, name), atol=1e-3), name


def test_contrast_polarity_and_corners_of_a_square(lines: Lines) -> None:
    gray = np.full((480, 640), 90, np.uint8)
    gray[120:261, 150:301] = 200
    square = lines([((149.5, 122), (149.5, 258)), ((152, 119.5), (298, 119.5)), ((400, 50), (400, 200))])
    table = candidate_features(square, gray=gray, size=SIZE)
    assert column(table, "contrast")[:2] == pytest.approx(np.log1p(110), abs=0.02)
    assert column(table, "contrast")[2] == 0
    assert column(table, "polarity")[:2].tolist() == [1, 1]
    assert column(table, "corners").tolist() == [1, 1, 0]
    assert column(table, "goes on beyond end")[0] == pytest.approx(0, abs=0.05)


def test_a_double_a_parallel_and_a_continuation(lines: Lines) -> None:
    ends = [((100, 100), (300, 100)), ((120, 102), (220, 102)), ((100, 140), (300, 140)), ((330, 100), (430, 100))]
    table = candidate_features(lines(ends, [0.9, 0.2, 0.5, 0.5]), gray=None, size=SIZE)
    assert column(table, "double of a longer one").tolist() == [0, 1, 0, 0]
    assert column(table, "double of a better one").tolist() == [0, 1, 0, 0]
    assert column(table, "doubles").tolist() == [1, 1, 0, 0]
    assert column(table, "parallel distance")[2] == pytest.approx(np.log1p(38))
    assert column(table, "continuation gap")[3] == pytest.approx(np.log1p(30))
    assert column(table, "crossings").tolist() == [0, 0, 0, 0]


def test_an_edge_of_both_neighbouring_frames_persists(lines: Lines) -> None:
    segments = lines([((100, 100), (100, 220)), ((300, 100), (420, 100))])
    moved = Segments.from_list([segments[0] + 3])
    frames = NeighbourFrames(before=moved, after=segments)
    table = candidate_features(segments, gray=None, size=SIZE, neighbours=frames)
    assert column(table, "frames before and after").tolist() == [1.0, 0.5]


def test_lens_residuals_and_straightness_are_taken_as_given(facade: Facade) -> None:
    segments, _ = facade
    lens = estimate_distortion([segments], SIZE)
    residuals = np.full(len(segments), 0.2)
    straightness = np.linspace(0, 1, len(segments))
    table = candidate_features(
        segments, gray=None, size=SIZE, residuals=residuals, straightness=straightness, lens=lens
    )
    assert column(table, "straightness") == pytest.approx(straightness)
    assert column(table, "residual") == pytest.approx(np.log(0.25))


def test_no_candidate_one_point_and_one_candidate() -> None:
    gray = np.zeros((30, 41), np.uint8)
    assert candidate_features(Segments.empty(), gray=gray, size=(41, 30)).shape == (0, len(FEATURES))
    one = candidate_features(Segments.from_list([[[5.0, 5.0]]]), gray=gray, size=(41, 30))
    assert not np.isinf(one).any()
    two = candidate_features(Segments.from_list([[[5, 5], [20, 9]], [[40, 29], [0, 0]]]), gray=gray, size=(41, 30))
    assert not np.isinf(two).any()
