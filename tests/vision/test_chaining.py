import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from app.vision.chaining import chain, link
from app.vision.subpixel import EdgePoints


def edge_points(
    along: list[int], across: list[float], slope: float = 0.0, sign: list[int] | None = None, norm: float = 100.0
) -> EdgePoints:
    """Points of a horizontal pass in an image of 40 x 60 px."""
    index = np.full((40, 60), -1, np.int32)
    pixel = np.rint(across).astype(int)
    index[pixel, along] = np.arange(len(along))
    return EdgePoints(
        axis=0,
        along=np.array(along, np.int64),
        across=np.array(across, float),
        slope=np.full(len(along), slope),
        sign=np.array(sign or [1] * len(along), np.int8),
        norm=np.full(len(along), norm, np.float32),
        index=index,
    )


def _all(points: EdgePoints) -> np.ndarray:
    return np.ones(len(points), bool)


def test_a_line_is_linked_point_to_point() -> None:
    points = edge_points([3, 4, 5, 6], [10.0, 10.2, 10.4, 10.6], slope=0.2)
    assert link(points, _all(points)).tolist() == [1, 2, 3, -1]


def test_a_missing_column_is_stepped_over() -> None:
    points = edge_points([3, 4, 7, 8], [10.0, 10.0, 10.0, 10.0])
    assert link(points, _all(points)).tolist() == [1, 2, 3, -1]


def test_three_missing_columns_end_a_chain() -> None:
    points = edge_points([3, 4, 8, 9], [10.0, 10.0, 10.0, 10.0])
    assert link(points, _all(points)).tolist() == [1, -1, 3, -1]


def test_opposite_sides_of_a_bar_are_never_linked() -> None:
    points = edge_points([3, 4], [10.0, 10.0], sign=[1, -1])
    assert link(points, _all(points)).tolist() == [-1, -1]


def test_a_branch_goes_to_the_nearer_point_and_the_other_starts_anew() -> None:
    points = edge_points([3, 4, 4, 5, 5], [10.0, 10.1, 11.4, 10.2, 12.0])
    assert link(points, _all(points)).tolist() == [1, 3, 4, -1, -1]


def test_points_that_may_not_be_used_are_stepped_over() -> None:
    points = edge_points([3, 4, 5], [10.0, 10.0, 10.0])
    assert link(points, np.array([True, False, True])).tolist() == [2, -1, -1]


def test_a_chain_needs_five_points_and_one_strong_one() -> None:
    short = edge_points([1, 2, 3, 4], [5.0] * 4)
    assert chain(short, 40, 80).offsets.tolist() == [0]
    weak = edge_points([1, 2, 3, 4, 5], [5.0] * 5, norm=79)
    assert chain(weak, 40, 80).offsets.tolist() == [0]
    weak.norm[2] = 81
    found = chain(weak, 40, 80)
    assert (found.rows.tolist(), found.offsets.tolist()) == ([0, 1, 2, 3, 4], [0, 5])


def test_no_points_make_no_chains() -> None:
    found = chain(edge_points([], []), 40, 80)
    assert (len(found.rows), found.offsets.tolist()) == (0, [0])


@given(st.data())
def test_chains_are_ordered_and_share_no_point(data: st.DataObject) -> None:
    cells = data.draw(st.sets(st.tuples(st.integers(0, 59), st.integers(1, 38)), max_size=150))
    ordered = sorted(cells, key=lambda cell: (cell[1], cell[0]))
    points = edge_points([x for x, _ in ordered], [float(y) for _, y in ordered])
    found = chain(points, 40, 80)
    assert len(set(found.rows.tolist())) == len(found.rows)
    for begin, end in zip(found.offsets[:-1], found.offsets[1:], strict=True):
        steps = np.diff(points.along[found.rows[begin:end]])
        assert ((steps >= 1) & (steps <= 3)).all()
