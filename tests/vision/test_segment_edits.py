"""Cutting, trimming, joining and extending: pure geometry on measured points."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.errors import InvalidInput, NoEdge
from app.vision.edge_following import follow_edge
from app.vision.edits import cut, joined, junction, trim
from app.vision.measured_points import edges_of_image
from app.vision.tracing import trace_edge


def line(start: float, stop: float, *, slope: float = 0.3) -> np.ndarray:
    x = np.arange(start, stop + 1, dtype=np.float32)
    return np.stack([x, slope * x + 5], axis=1)


def same(one: np.ndarray, other: np.ndarray) -> bool:
    return np.array_equal(one, other) or np.array_equal(one[::-1], other)


@given(length=st.integers(4, 60), place=st.integers(2, 57), beside=st.floats(-8, 8))
def test_a_cut_keeps_every_point_in_order(length, place, beside) -> None:
    points = line(0, length)
    at = (place + 0.5, 0.3 * (place + 0.5) + 5 + beside)
    if not 4 <= at[0] + 0.3 * beside <= length - 3:
        return
    first, second = cut(points, at)
    assert np.array_equal(np.concatenate([first, second]), points)
    assert min(len(first), len(second)) >= 2
    # the gap between both is the nearest one, as the place is projected
    assert first[-1, 0] == pytest.approx(np.floor(at[0] + 0.3 * beside / 1.09), abs=1)


@pytest.mark.parametrize("at", [(-5, 0), (0.4, 5), (30.8, 14), (90, 10)])
def test_a_cut_at_an_end_is_refused(at) -> None:
    with pytest.raises(InvalidInput, match="too near an end"):
        cut(line(0, 31), at)


def test_the_nearer_end_is_trimmed_up_to_the_place() -> None:
    points = line(0, 30)
    assert np.array_equal(trim(points, (8.4, 7.5)), points[9:])
    assert np.array_equal(trim(points, (24.6, 12.4)), points[:25])
    assert np.array_equal(trim(points[::-1], (8.4, 7.5)), points[:8:-1])


@pytest.mark.parametrize("turned", [(False, False), (True, False), (False, True), (True, True)])
@pytest.mark.parametrize("swapped", [False, True])
def test_a_join_puts_the_parts_in_order_whichever_way_they_run(turned, swapped) -> None:
    parts = [each[::-1] if turn else each for each, turn in zip((line(0, 40), line(50, 90)), turned, strict=True)]
    found = junction(*(parts[::-1] if swapped else parts))
    assert found.gap == pytest.approx(10 * np.hypot(1, 0.3), abs=1e-3)
    assert same(joined(found), np.concatenate([line(0, 40), line(50, 90)]))


@pytest.mark.parametrize("overlap", [(30, 90), (10, 90), (40, 90)])
def test_a_join_of_parts_that_overlap_has_no_point_twice(overlap) -> None:
    assert same(joined(junction(line(0, 40), line(*overlap))), line(0, 90))


def test_what_is_measured_in_the_gap_fills_it() -> None:
    found = junction(line(0, 40), line(50, 90))
    assert same(joined(found, line(38, 52)), line(0, 90))


@pytest.mark.parametrize(
    ("other", "message"),
    [
        (line(50, 90, slope=-0.6), "turn"),
        (line(5, 30) + np.array([0, 2], np.float32), "beside each other"),
        (line(50, 90) + np.array([0, 12], np.float32), "beside the line"),
    ],
)
def test_what_is_no_straight_line_together_is_not_joined(other, message) -> None:
    with pytest.raises(InvalidInput, match=message):
        junction(line(0, 40), other)


@pytest.mark.parametrize(
    "edit", [lambda p: cut(p, (0, 0)), lambda p: trim(p, (0, 0)), lambda p: junction(p, line(0, 9))]
)
def test_a_single_point_is_no_segment(edit) -> None:
    with pytest.raises(InvalidInput):
        edit(np.zeros((1, 2), np.float32))


@pytest.fixture(scope="module")
def wall() -> np.ndarray:
    """Bright above a slanted edge from x = 40 to x = 260, 300 x 160."""
    y, x = np.mgrid[:160, :300].astype(float)
    share = np.clip(0.2 * x + 50 - y + 0.5, 0, 1)
    image = 70 + 110 * share * ((x >= 40) & (x <= 260))
    return np.rint(image).astype(np.uint8)


def test_an_extension_follows_the_edge_to_its_ends_and_keeps_what_was_there(wall) -> None:
    edges = edges_of_image(wall)
    part = trace_edge(edges, [(120, 75), (180, 85)]).points
    whole = follow_edge(edges, part)
    start = int(np.flatnonzero((whole == part[0]).all(axis=1))[0])
    assert np.array_equal(whole[start : start + len(part)], part)
    assert whole[:, 0].min() == pytest.approx(40, abs=4)
    assert whole[:, 0].max() == pytest.approx(260, abs=4)
    assert (np.diff(whole[:, 0]) > 0).all()
    inner = whole[(whole[:, 0] > 48) & (whole[:, 0] < 252)].astype(float)
    assert np.abs(inner[:, 1] - (0.2 * inner[:, 0] + 50)).max() < 0.15
    assert np.array_equal(follow_edge(edges, part[::-1])[::-1], whole)
    assert len(follow_edge(edges, whole)) <= len(whole) + 2


def test_a_segment_off_any_edge_has_nothing_to_follow(wall) -> None:
    with pytest.raises(NoEdge, match="nothing to follow"):
        follow_edge(edges_of_image(wall), line(100, 200, slope=0.0))
