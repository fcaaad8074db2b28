"""The one type that crosses every border."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from app.errors import InvalidSegments
from app.vision import Segments

POLYLINES = st.lists(
    arrays.arrays(
        np.float32,
        st.tuples(st.integers(1, 8), st.just(2)),
        elements=st.floats(-1000, 1000, width=32),
    ),
    max_size=6,
)


@given(POLYLINES)
def test_a_list_of_polylines_comes_back_as_it_was(polylines: list[np.ndarray]) -> None:
    segments = Segments.from_list(polylines)
    assert len(segments) == len(polylines)
    for one, other in zip(segments, polylines, strict=True):
        np.testing.assert_array_equal(one, other)


@given(POLYLINES)
def test_lengths_boxes_and_extents_agree_with_each_polyline_alone(polylines: list[np.ndarray]) -> None:
    segments = Segments.from_list(polylines)
    for index, line in enumerate(polylines):
        wide = line.astype(np.float64)
        length = np.hypot(*np.diff(wide, axis=0).T).sum()
        assert segments.lengths()[index] == pytest.approx(length)
        assert segments.extents()[index] == pytest.approx(np.hypot(*(wide[-1] - wide[0])))
        np.testing.assert_array_equal(segments.boxes()[index], [*line.min(axis=0), *line.max(axis=0)])


def test_a_right_angle_is_longer_than_its_chord() -> None:
    corner = Segments.from_list([[[0, 0], [3, 0], [3, 4]], [[10, 10], [10, 11]]])
    np.testing.assert_allclose(corner.lengths(), [7, 1])
    np.testing.assert_allclose(corner.extents(), [5, 1])
    assert corner.counts.tolist() == [3, 2]
    assert corner.segment_of_point.tolist() == [0, 0, 0, 1, 1]


def test_selection_by_mask_and_by_index_keeps_points_and_scores() -> None:
    segments = Segments.from_list([[[0, 0]], [[1, 1], [2, 2]], [[3, 3]]], scores=[0.1, 0.2, 0.3])
    by_mask = segments.select(np.array([False, True, True]))
    by_index = segments.select([2, 1])
    np.testing.assert_array_equal(by_mask[0], segments[1])
    np.testing.assert_array_equal(by_index[0], segments[2])
    assert by_index.scores is not None
    np.testing.assert_allclose(by_index.scores, [0.3, 0.2])
    assert len(segments.select([])) == 0


def test_indices_count_from_the_end_and_end_somewhere() -> None:
    segments = Segments.from_list([[[0, 0]], [[1, 1]]])
    np.testing.assert_array_equal(segments[-1], segments[1])
    with pytest.raises(IndexError):
        segments[2]


def test_nothing_is_a_value_too() -> None:
    nothing = Segments.empty()
    assert len(nothing) == 0
    assert nothing.lengths().shape == nothing.extents().shape == (0,)
    assert nothing.boxes().shape == (0, 4)
    assert nothing == Segments(np.zeros((0, 2)), np.zeros(1), np.zeros(0))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("points", "offsets", "scores", "message"),
    [
        (np.zeros((3, 3)), [0, 3], None, "shape"),
        (np.zeros((3, 2)), [0, 2], None, "cover"),
        (np.zeros((3, 2)), [1, 3], None, "cover"),
        (np.zeros((3, 2)), [], None, "cover"),
        (np.zeros((3, 2)), [0, 2, 2, 3], None, "no points"),
        (np.zeros((3, 2)), [0, 3], [0.1, 0.2], "scores"),
        ([[0, 0], [np.nan, 1]], [0, 2], None, "finite"),
        ([[0, 0], [0, np.inf]], [0, 2], None, "finite"),
    ],
)
def test_what_makes_no_segments_is_refused(points: object, offsets: object, scores: object, message: str) -> None:
    with pytest.raises(InvalidSegments, match=message):
        Segments(np.asarray(points), np.asarray(offsets), None if scores is None else np.asarray(scores))
