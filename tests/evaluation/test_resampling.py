from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.evaluation.resampling import resample
from app.vision.segments import Segments


def test_a_straight_line_has_a_sample_per_px_with_both_ends() -> None:
    samples = resample(Segments.from_list([np.array([[0.0, 0], [30, 40]])]))
    along = np.arange(51)[:, None]
    assert samples.points == pytest.approx(along * [[0.6, 0.8]])
    assert samples.tangents == pytest.approx(np.tile([0.6, 0.8], (51, 1)))
    assert samples.lengths.tolist() == [50]
    assert samples.largest_step == 1


def test_a_corner_is_followed_and_its_tangent_turns_within_three_samples() -> None:
    samples = resample(Segments.from_list([np.array([[0.0, 0], [20, 0], [20, 20]])]))
    assert samples.points[20].tolist() == [20, 0]
    assert samples.points[30].tolist() == [20, 10]
    assert samples.tangents[[17, 20, 23]] == pytest.approx(np.array([[1, 0], [0.5**0.5, 0.5**0.5], [0, 1]]))


def test_segments_do_not_run_into_each_other() -> None:
    first, second = np.array([[0.0, 0], [5, 0]]), np.array([[1000.0, 7], [1000, 2]])
    samples = resample(Segments.from_list([first, second]))
    assert samples.polyline.tolist() == [0] * 6 + [1] * 6
    assert samples.points[:6, 0] == pytest.approx(np.arange(6))
    assert samples.points[6:, 1] == pytest.approx(np.arange(7, 1, -1))
    assert samples.tangents == pytest.approx(np.repeat([[1, 0], [0, -1]], 6, axis=0))


def test_a_pixel_staircase_is_not_a_turn() -> None:
    x = np.arange(80)
    samples = resample(Segments.from_list([np.stack([x, x // 4], axis=1)]))
    angle = np.degrees(np.arctan2(samples.tangents[:, 1], samples.tangents[:, 0]))
    assert np.abs(angle[5:-5] - np.degrees(np.arctan(0.25))).max() < 10


def test_a_point_has_two_samples_and_no_direction() -> None:
    samples = resample(Segments.from_list([np.array([[3.0, 4]]), np.array([[3.0, 4], [3, 4]])]))
    assert samples.points.tolist() == [[3, 4]] * 4
    assert samples.tangents.tolist() == [[0, 0]] * 4
    assert samples.lengths.tolist() == [0, 0]


def test_no_segments_have_no_samples() -> None:
    samples = resample(Segments.empty())
    assert samples.points.shape == (0, 2)
    assert len(samples) == 0
    assert samples.largest_step == 0


coordinate = st.floats(-100, 100, width=32)


@settings(max_examples=40, deadline=None)
@given(st.lists(st.lists(st.tuples(coordinate, coordinate), min_size=1, max_size=6), max_size=4))
def test_the_reverse_of_a_segment_has_the_reverse_samples(polylines: list[list[tuple[float, float]]]) -> None:
    forward = resample(Segments.from_list(polylines))
    backward = resample(Segments.from_list([polyline[::-1] for polyline in polylines]))
    for one, other in zip(np.split(forward.points, forward.offsets[1:-1]), polylines, strict=False):
        assert one[[0, -1]] == pytest.approx(np.array([other[0], other[-1]]), abs=1e-6)
    if (np.diff(forward.offsets) == np.diff(backward.offsets)).all():  # else a length lies between two roundings
        for start, end in zip(forward.offsets[:-1], forward.offsets[1:], strict=True):
            assert forward.points[start:end] == pytest.approx(backward.points[start:end][::-1], abs=1e-6)
