"""Cohen's kappa against numbers worked out by hand."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from app.errors import InvalidInput
from app.review.agreement import cohen_kappa, kappa_by_length, kappa_of, verdict_table


def test_kappa_of_a_table_by_hand() -> None:
    # p_o = 35/50 = 0.7; p_e = 0.5 * 0.6 + 0.5 * 0.4 = 0.5; kappa = 0.2 / 0.5
    kappa = cohen_kappa([[20, 5], [10, 15]])
    assert kappa.observed == pytest.approx(0.7)
    assert kappa.expected == pytest.approx(0.5)
    assert kappa.value == pytest.approx(0.4)
    assert kappa.count == 50


def test_interval_of_a_table_by_hand() -> None:
    # Fleiss, Cohen and Everitt: A = 0.4 (0.5 - 1.1 * 0.3)^2 + 0.3 (0.5 - 0.9 * 0.3)^2 = 0.02743,
    # B = 0.09 (0.1 * (0.6 + 0.5)^2 + 0.2 * (0.4 + 0.5)^2) = 0.02547, C = (0.7 * 0.5 - 2 * 0.5 + 0.7)^2 = 0.0025,
    # variance = (A + B - C) / (50 * 0.5^4) = 0.016128
    kappa = cohen_kappa([[20, 5], [10, 15]])
    assert kappa.low == pytest.approx(0.4 - 1.959964 * np.sqrt(0.016128), abs=1e-5)
    assert kappa.high == pytest.approx(0.4 + 1.959964 * np.sqrt(0.016128), abs=1e-5)


@pytest.mark.parametrize(
    ("table", "value"),
    [([[7, 0], [0, 5]], 1.0), ([[0, 5], [5, 0]], -1.0), ([[25, 25], [25, 25]], 0.0), ([[3, 0], [0, 0]], None)],
)
def test_kappa_at_its_ends(table: list[list[int]], value: float | None) -> None:
    assert cohen_kappa(table).value == pytest.approx(value)


def test_nothing_judged_has_no_kappa() -> None:
    assert cohen_kappa(np.zeros((3, 3))) == (None, None, None, None, None, 0)


@given(arrays(np.int64, (3, 3), elements=st.integers(0, 40)))
def test_kappa_knows_no_first_and_second_and_no_order_of_verdicts(table: np.ndarray) -> None:
    kappa, turned, shuffled = (cohen_kappa(each) for each in (table, table.T, table[[2, 0, 1]][:, [2, 0, 1]]))
    if kappa.value is not None:
        assert kappa.low is not None
        assert kappa.high is not None
        assert -1 - 1e-9 <= kappa.low <= kappa.value <= kappa.high <= 1 + 1e-9
        assert turned.value == pytest.approx(kappa.value)
        assert shuffled.low == pytest.approx(kappa.low, abs=1e-7)  # a root of almost nothing


@pytest.mark.parametrize("table", [[[1, 2, 3]], [[1, -1], [0, 2]], [[np.nan, 1], [1, 1]], np.zeros((0, 0))])
def test_what_is_no_table_is_refused(table: object) -> None:
    with pytest.raises(InvalidInput, match="table"):
        cohen_kappa(table)  # type: ignore[arg-type]


def test_verdicts_that_do_not_count_are_left_out() -> None:
    first, second = ["keep", "keep", "ambiguous", "reject"], ["keep", "reject", "keep", "reject"]
    assert verdict_table(first, second, ("keep", "reject")).tolist() == [[1, 1], [0, 1]]
    assert kappa_of(first, second, ("keep", "reject")).count == 3


def test_bins_of_length_take_their_lower_end() -> None:
    first, second = ["keep", "reject", "keep", "keep"], ["keep", "reject", "reject", "keep"]
    bins = kappa_by_length(first, second, [10, 49.9, 50, 500], ("keep", "reject"), (0, 50, 400))
    assert [(each.low, each.high, each.kappa.count) for each in bins] == [(0, 50, 2), (50, 400, 1), (400, None, 1)]
    assert bins[0].kappa.value == 1.0


def test_lists_of_different_length_are_refused() -> None:
    with pytest.raises(InvalidInput, match="one each of both"):
        kappa_of(["keep"], [], ("keep", "reject"))
    with pytest.raises(InvalidInput, match="lengths"):
        kappa_by_length(["keep"], ["keep"], [1.0, 2.0], ("keep", "reject"))
