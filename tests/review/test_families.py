"""Families: structures that people judge as one."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from app.review.families import families
from app.vision import Segments

SIZE = (640, 480)
Lines = Callable[..., Segments]


def test_a_row_of_window_edges_is_one_family_and_a_stray_line_none(lines: Lines) -> None:
    row = [((100 + 30 * step, 100), (100 + 30 * step, 220)) for step in range(4)]
    found = families(lines([row[0], ((300, 300), (420, 380)), *row[1:]]), SIZE)
    assert found.tolist() == [0, -1, 0, 0, 0]


def test_both_sides_of_a_pole_and_the_steps_of_a_stair_are_two_families(lines: Lines) -> None:
    pole = [((50, 50), (50, 350)), ((58, 52), (58, 348))]
    stair = [((300, 200 + 20 * step), (420, 200 + 20 * step)) for step in range(3)]
    assert families(lines([*stair, *pole]), SIZE).tolist() == [0, 0, 0, 1, 1]


def test_pieces_of_one_line_are_a_family_if_the_gap_is_small(lines: Lines) -> None:
    near = [((100, 100), (200, 100)), ((240, 100), (340, 100))]
    far = [((100, 100), (200, 100)), ((300, 100), (400, 100))]
    assert families(lines(near), SIZE).tolist() == [0, 0]
    assert families(lines(far), SIZE).tolist() == [-1, -1]


@pytest.mark.parametrize(
    "other",
    [((110, 100), (110, 300)), ((110, 100), (130, 195)), ((110, 190), (110, 290)), ((170, 100), (170, 200))],
    ids=["twice as long", "turned", "moved along", "too far"],
)
def test_what_keeps_two_lines_apart(lines: Lines, other: tuple[tuple[int, int], tuple[int, int]]) -> None:
    assert families(lines([((100, 100), (100, 200)), other]), SIZE).tolist() == [-1, -1]


def test_order_and_sense_of_the_points_do_not_matter(facade: tuple[Segments, np.ndarray]) -> None:
    segments, _ = facade
    found = families(segments, SIZE)
    turned = Segments.from_list([points[::-1] for points in segments])
    assert families(turned, SIZE).tolist() == found.tolist()
    order = np.random.default_rng(0).permutation(len(segments))
    shuffled = families(segments.select(order), SIZE)
    together, together_shuffled = (
        (each[:, None] == each[None]) & (each[:, None] >= 0) for each in (found[order], shuffled)
    )
    assert np.array_equal(together, together_shuffled)
    assert found.max() >= 1


def test_none_and_one_have_no_family(lines: Lines) -> None:
    assert families(Segments.empty(), SIZE).tolist() == []
    assert families(lines([((0, 0), (100, 0))]), SIZE).tolist() == [-1]
