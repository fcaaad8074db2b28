from __future__ import annotations

from itertools import combinations, permutations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import csr_array

from app.errors import InvalidInput
from app.evaluation import match_one_to_one, match_segments
from app.evaluation.matching import match_pairs
from app.vision.segments import Segments


def pairs(matrix: list[list[float]], threshold: float = 0.5) -> list[tuple[int, int]]:
    found = match_one_to_one(np.array(matrix), threshold)
    return list(zip(found.row.tolist(), found.column.tolist(), strict=True))


def test_the_most_pairs_come_before_the_greatest_sum() -> None:
    assert pairs([[1.0, 0.5], [0.5, 0.0]]) == [(0, 1), (1, 0)]


def test_among_as_many_pairs_the_greatest_sum_wins() -> None:
    assert pairs([[0.6, 0.9], [0.8, 0.7]]) == [(0, 1), (1, 0)]


def test_fewer_pairs_of_a_greater_sum_win_where_that_is_asked_for() -> None:
    # 0 - 0 - 1 - 1 - 2 - 2 is a chain whose inner two links are worth more than its outer three
    rows, columns = np.array([0, 1, 1, 2, 2]), np.array([0, 0, 1, 1, 2])
    values = np.array([0.51, 1.0, 0.51, 1.0, 0.51])
    most = match_pairs(rows, columns, values, 0.5)
    best = match_pairs(rows, columns, values, 0.5, most_pairs=False)
    assert list(zip(most.row.tolist(), most.column.tolist(), strict=True)) == [(0, 0), (1, 1), (2, 2)]
    assert list(zip(best.row.tolist(), best.column.tolist(), strict=True)) == [(1, 0), (2, 1)]


def test_a_row_or_column_is_used_once() -> None:
    assert pairs([[0.9], [0.95], [0.9]]) == [(1, 0)]


def test_the_threshold_itself_matches_and_less_does_not() -> None:
    assert pairs([[0.5]]) == [(0, 0)]
    assert pairs([[0.5 - 1e-12]]) == [(0, 0)]
    assert pairs([[0.4999]]) == []


@pytest.mark.parametrize("threshold", [0.0, -1.0, 1.1, float("nan")])
def test_a_senseless_threshold_is_refused(threshold: float) -> None:
    with pytest.raises(InvalidInput, match="threshold"):
        match_one_to_one(np.ones((1, 1)), threshold)


def test_nothing_to_match() -> None:
    assert pairs([[]]) == []
    assert match_segments(Segments.empty(), Segments.empty()).value.shape == (0,)


cells = st.sampled_from([0.0, 0.3, 0.5, 0.55, 0.7, 0.9, 1.0])


@settings(deadline=None)
@given(st.integers(1, 4).flatmap(lambda n: st.lists(st.lists(cells, min_size=n, max_size=n), min_size=1, max_size=4)))
def test_is_the_best_of_all_assignments(rows: list[list[float]]) -> None:
    matrix = np.array(rows)
    best = (0, 0.0)
    for size in range(1, min(matrix.shape) + 1):
        for chosen in combinations(range(matrix.shape[0]), size):
            for columns in permutations(range(matrix.shape[1]), size):
                values = matrix[list(chosen), list(columns)]
                if (values >= 0.5).all():
                    best = max(best, (size, float(values.sum())))
    found = match_one_to_one(csr_array(matrix), 0.5)
    assert len(found.row) == best[0]
    assert found.value.sum() == pytest.approx(best[1])
    assert (matrix[found.row, found.column] == found.value).all()
    assert len(set(found.row.tolist())) == len(set(found.column.tolist())) == best[0]


def test_segments_of_a_later_run_are_found_again(line) -> None:
    old = Segments.from_list([line(200, 10), line(150, 80, (200.0, 200.0)), line(90, 0, (800.0, 100.0))])
    new = Segments.from_list(
        [line(140, 80, (201.0, 203.0)), line(60, 0, (300.0, 900.0)), line(170, 10.3), line(195, 10, (500.0, 501.0))]
    )
    matches = match_segments(old, new)
    assert (matches.row.tolist(), matches.column.tolist()) == ([0, 1], [3, 0])
    assert (matches.value > 0.8).all()


def test_york_labels_match_themselves(york_lines: dict[str, list[np.ndarray]]) -> None:
    labels = Segments.from_list(next(iter(york_lines.values())))
    matches = match_segments(labels, labels)
    assert matches.row.tolist() == matches.column.tolist() == list(range(len(labels)))
    assert matches.value == pytest.approx(np.ones(len(labels)))
