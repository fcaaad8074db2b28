"""The same edge in two frames."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from app.review.frame_matches import frame_matches
from app.vision import Segments

SIZE = (640, 480)
Lines = Callable[..., Segments]


def test_a_frame_matches_itself_without_cost(facade: tuple[Segments, np.ndarray]) -> None:
    segments, _ = facade
    found = frame_matches(segments, segments, SIZE)
    assert found.first.tolist() == found.second.tolist() == list(range(len(segments)))
    assert np.allclose(found.cost, 0, atol=1e-6)


@settings(max_examples=20, deadline=None)
@given(st.floats(-10, 10), st.floats(-10, 10), st.integers(0, 2**16))
def test_a_moved_and_shuffled_frame_is_matched_edge_by_edge(
    facade: tuple[Segments, np.ndarray], dx: float, dy: float, seed: int
) -> None:
    segments, _ = facade
    order = np.random.default_rng(seed).permutation(len(segments))
    moved = Segments.from_list([points + np.array([dx, dy], np.float32) for points in segments.select(order)])
    found = frame_matches(segments, moved, SIZE)
    assert np.mean(order[found.second] == found.first) > 0.9
    assert len(found.first) > 0.9 * len(segments)


def test_an_edge_that_turned_grew_or_went_away_is_not_matched(lines: Lines) -> None:
    first = lines([((100, 100), (100, 200)), ((300, 100), (300, 200)), ((500, 100), (500, 200))])
    second = lines([((80, 150), (120, 240)), ((300, 100), (300, 400)), ((400, 300), (400, 400))])
    assert len(frame_matches(first, second, SIZE).first) == 0


def test_no_edge_is_matched_twice(lines: Lines) -> None:
    first = lines([((100, 100), (100, 200)), ((104, 100), (104, 200))])
    second = lines([((102, 100), (102, 200))])
    assert len(frame_matches(first, second, SIZE).first) == 1
    assert len(frame_matches(Segments.empty(), second, SIZE).first) == 0
    assert len(frame_matches(first, Segments.empty(), SIZE).first) == 0
