"""Chains of edge points, and the runs they are split into."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.vision.chaining import Runs, find_runs

LOW, HIGH = 40, 80


def chains(runs: Runs) -> list[list[int]]:
    """Rows of each chain."""
    return [rows.tolist() for rows in np.split(runs.rows, runs.chain_ends)[:-1]]


def chained(edges) -> list[list[int]]:
    return chains(find_runs(edges, 0, LOW, HIGH))


def columns(*spans: tuple[int, int]) -> list[int]:
    return [column for first, last in spans for column in range(first, last + 1)]


def test_a_line_is_linked_point_to_point(edges_of) -> None:
    x = np.arange(3, 13)
    assert chained(edges_of(x, 10 + 0.2 * (x - 3), slope=0.2)) == [list(range(10))]


def test_up_to_two_missing_columns_are_stepped_over(edges_of) -> None:
    x = columns((3, 7), (10, 14), (16, 20))
    assert chained(edges_of(x, [10.0] * len(x))) == [list(range(15))]


def test_three_missing_columns_end_a_chain(edges_of) -> None:
    x = columns((3, 7), (11, 15))
    assert chained(edges_of(x, [10.0] * 10)) == [[0, 1, 2, 3, 4], [5, 6, 7, 8, 9]]


def test_opposite_sides_of_a_bar_are_never_linked(edges_of) -> None:
    x = columns((3, 12))
    assert chained(edges_of(x, [10.0] * 10, norm=[90] * 5 + [-90] * 5)) == [[0, 1, 2, 3, 4], [5, 6, 7, 8, 9]]


def test_a_branch_goes_to_the_nearer_point_and_the_other_starts_anew(edges_of) -> None:
    x = columns((3, 7)) + [column for column in columns((8, 12)) for _ in range(2)]
    rows = [10.0] * 5 + [10.1, 11.4] * 5
    assert chained(edges_of(x, rows)) == [[*range(5), *range(5, 15, 2)], [*range(6, 15, 2)]]


def test_weak_points_are_stepped_over(edges_of) -> None:
    norm = [90.0] * 9
    norm[4] = LOW
    assert chained(edges_of(columns((3, 11)), [10.0] * 9, norm=norm)) == [[0, 1, 2, 3, 5, 6, 7, 8]]


def test_a_point_that_points_elsewhere_is_not_linked(edges_of) -> None:
    slope = [-1.0] * 5 + [1.0] * 5
    assert len(chained(edges_of(columns((3, 12)), [10.0] * 10, slope=slope))) == 2


def test_a_chain_needs_five_points_and_one_strong_one(edges_of) -> None:
    assert chained(edges_of(columns((1, 4)), [5.0] * 4)) == []
    assert chained(edges_of(columns((1, 5)), [5.0] * 5, norm=HIGH)) == []
    norm = [79.0, 79.0, HIGH + 1.0, 79.0, 79.0]
    assert chained(edges_of(columns((1, 5)), [5.0] * 5, norm=norm)) == [[0, 1, 2, 3, 4]]


def test_no_points_make_no_chains(edges_of) -> None:
    runs = find_runs(edges_of(), 0, LOW, HIGH)
    assert (len(runs), len(runs.rows), len(runs.chain_ends)) == (0, 0, 0)


@given(st.data())
def test_chains_are_ordered_and_share_no_point(edges_of, data: st.DataObject) -> None:
    cells = data.draw(st.sets(st.tuples(st.integers(0, 59), st.integers(1, 38)), max_size=300))
    ordered = sorted(cells)
    edges = edges_of([x for x, _ in ordered], [float(y) for _, y in ordered])
    runs = find_runs(edges, 0, LOW, HIGH)
    assert len(set(runs.rows.tolist())) == len(runs.rows)
    for chain in chains(runs):
        assert len(chain) >= 5
        steps = np.diff(edges.points[0]["along"][chain])
        assert ((steps >= 1) & (steps <= 3)).all()
    inside = np.concatenate([[0], runs.chain_ends])
    for first, last in runs.bounds:
        chain = np.searchsorted(inside, first, side="right")
        assert inside[chain - 1] <= first < last <= inside[chain]
    assert (runs.bounds[1:, 0] >= runs.bounds[:-1, 1]).all()


def split(edges_of, across: np.ndarray) -> list[tuple[int, int]]:
    """Runs of one chain whose points lie at ``across``, one per column."""
    x = np.arange(len(across))
    edges = edges_of(x, across, slope=np.gradient(across), shape=(110, len(across)))
    runs = find_runs(edges, 0, LOW, HIGH)
    assert len(runs.chain_ends) == 1
    return [(int(first), int(last)) for first, last in runs.bounds]


def test_a_line_stays_whole(edges_of) -> None:
    assert split(edges_of, 5 + 0.3 * np.arange(80.0)) == [(0, 80)]


def test_a_gentle_arc_stays_whole(edges_of) -> None:
    assert split(edges_of, 5 + np.arange(100.0) ** 2 / 2000) == [(0, 100)]


def test_a_corner_is_cut_at_its_point(edges_of) -> None:
    assert split(edges_of, 5 + 0.35 * np.abs(np.arange(61.0) - 30)) == [(0, 30), (31, 61)]


def test_a_tight_curve_becomes_several_runs_within_tolerance(edges_of) -> None:
    x = np.arange(121.0)
    across = 105 - np.sqrt(100.0**2 - (x - 60) ** 2)
    found = split(edges_of, across)
    assert len(found) >= 2
    for first, last in found:
        parabola = np.polynomial.Polynomial.fit(x[first:last], across[first:last], 2)
        assert np.abs(parabola(x[first:last]) - across[first:last]).max() < 0.7


def test_chains_are_split_apart_from_each_other(edges_of) -> None:
    x = np.arange(40.0)
    across = np.concatenate([10 + 0 * x, 20 + 0.35 * np.abs(x - 20), 40 + 0.4 * x])
    slope = np.concatenate([0 * x, 0.35 * np.sign(x - 20), 0 * x + 0.4])
    runs = find_runs(edges_of(np.tile(x, 3), across, slope=slope), 0, LOW, HIGH)
    assert runs.chain_ends.tolist() == [40, 80, 120]
    assert runs.bounds.tolist() == [[0, 40], [40, 60], [61, 80], [80, 120]]


@pytest.mark.parametrize(("count", "expected"), [(5, []), (6, [(0, 6)])])
def test_six_points_make_a_run(edges_of, count: int, expected: list[tuple[int, int]]) -> None:
    assert split(edges_of, np.full(count, 5.0)) == expected
