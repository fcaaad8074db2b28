"""How the benchmark of synthetic scenes compares two orders."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.shared.rank_agreement import agreement, draws, places


def test_places_count_from_the_greatest() -> None:
    assert places(np.array([0.2, 0.9, 0.5, 0.5])).tolist() == [4, 1, 2, 3]


def test_one_order_agrees_with_itself_and_not_with_its_reverse() -> None:
    scores = np.array([0.1, 0.4, 0.2, 0.9])
    many = np.tile(scores, (5, 1))
    same, reverse = agreement(scores, scores, many, many), agreement(scores, -scores, many, -many)
    assert (same.spearman, same.kendall) == (pytest.approx(1), pytest.approx(1))
    assert reverse.kendall_interval == (pytest.approx(-1), pytest.approx(-1))


def test_two_that_change_places_cost_what_they_should() -> None:
    scores, other = np.array([4.0, 3.0, 2.0, 1.0]), np.array([3.0, 4.0, 2.0, 1.0])
    found = agreement(scores, other, scores[None], other[None])
    assert found.spearman == pytest.approx(1 - 6 * 2 / (4 * 15))
    assert found.kendall == pytest.approx((5 - 1) / 6)


def test_draws_take_as_many_images_as_there_are() -> None:
    assert (draws(7, 20, 1).sum(axis=1) == 7).all()
    assert (draws(7, 20, 1) == draws(7, 20, 1)).all()
