from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from app.errors import InvalidInput
from app.evaluation.ranking import Rank, rank_board, ranks


def mean_of(values: np.ndarray):
    return lambda weights: {"f1": weights @ values / weights.sum(axis=1)}


def test_rows_that_are_clearly_apart_have_one_rank_each() -> None:
    easy = np.random.default_rng(0).uniform(0, 0.2, 40)
    board = rank_board([mean_of(easy + lead) for lead in (0.2, 0.4, 0.0)], np.arange(40), 300, seed=0)
    assert board == [Rank(2, 2, ()), Rank(1, 1, ()), Rank(3, 3, ())]


def test_rows_within_noise_share_an_interval_and_name_each_other() -> None:
    random = np.random.default_rng(3)
    scores = [random.uniform(0.4, 0.6, 40) for _ in range(2)]
    board = rank_board([mean_of(values) for values in [*scores, np.full(40, 0.9)]], np.arange(40), 300, seed=0)
    assert board == [Rank(2, 3, (1,)), Rank(2, 3, (0,)), Rank(1, 1, ())]


def test_equal_rows_are_tied() -> None:
    values = np.linspace(0, 1, 10)
    assert rank_board([mean_of(values)] * 3, np.arange(10), 50, seed=0) == [
        Rank(1, 3, (1, 2)),
        Rank(1, 3, (0, 2)),
        Rank(1, 3, (0, 1)),
    ]


def test_being_tied_is_not_passed_on() -> None:
    """The middle row can't be told from either neighbour, but they can from one another."""
    noise = np.linspace(-1, 1, 200)
    drawn = np.stack([0.0 * noise, 0.6 + noise, 1.0 + 0.0 * noise])
    assert ranks(drawn) == [Rank(2, 3, (1,)), Rank(1, 3, (0, 2)), Rank(1, 2, (1,))]


def test_one_cluster_ties_all() -> None:
    assert rank_board([mean_of(np.zeros(2)), mean_of(np.ones(2))], [1, 1], seed=0) == [
        Rank(1, 2, (1,)),
        Rank(1, 2, (0,)),
    ]


def test_a_board_may_be_empty_or_of_one_row() -> None:
    assert rank_board([], [0, 1], seed=0) == []
    assert rank_board([mean_of(np.ones(2))], [0, 1], 10, seed=0) == [Rank(1, 1, ())]


def test_draws_that_are_no_matrix_are_refused() -> None:
    with pytest.raises(InvalidInput, match="rank nothing"):
        ranks(np.zeros(3))


@given(drawn=arrays(np.float64, st.tuples(st.integers(1, 6), st.integers(1, 9)), elements=st.floats(0, 1)))
def test_ranks_and_ties_agree(drawn: np.ndarray) -> None:
    board = ranks(drawn)
    for place, rank in enumerate(board):
        assert 1 <= rank.low <= rank.high <= len(board)
        assert rank.high - rank.low == len(rank.tied_with)
        assert all(place in board[other].tied_with for other in rank.tied_with)
    assert sorted(rank.low for rank in board)[0] == 1
    order = np.random.default_rng(0).permutation(len(board))
    assert [(rank.low, rank.high) for rank in ranks(drawn[order])] == [(board[i].low, board[i].high) for i in order]
