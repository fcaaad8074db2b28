"""Selection: one segment per edge, and what is measured along it."""

import numpy as np
import pytest

from app.errors import Cancelled
from app.vision.merging import Merging, not_merged
from app.vision.native.records import ARC
from app.vision.selection import Selection, select
from app.vision.watch import Watch

Row = tuple[float, float, float]


@pytest.fixture
def arcs_along(probes):
    """Return a function that makes arcs along rows: ``(y, x0, x1)``."""

    def make(*rows: Row) -> Merging:
        runs = [np.stack([np.linspace(a, b, 40), np.full(40, y)], axis=1) for y, a, b in rows]
        records = np.zeros(2 * len(rows) + 1, ARC)
        records[: len(rows)] = probes.fit(runs, np.array([[40 * 50.0, 40 * 80.0, 40 * 100.0]] * len(rows)))
        return not_merged(records)

    return make


@pytest.fixture
def measured(arcs_along, edges_of):
    """Return a function that selects one arc from (20, y) to (60, y) among points in row 30."""

    def run(y: float, rows=30.0, columns=None, **of_points) -> Selection:
        columns = np.arange(20, 61) if columns is None else np.asarray(columns)
        edges = edges_of(columns, np.broadcast_to(rows, len(columns)), **of_points)
        return select(arcs_along((y, 20, 60)), edges, 10.0, Watch())

    return run


def test_every_column_gives_the_point_measured_there(measured) -> None:
    columns = np.arange(20, 61)
    rows = 30 + 0.3 * np.sin(columns)
    found = measured(30, rows, columns)
    assert found.points == pytest.approx(np.stack([columns, rows], axis=1), abs=1e-5)
    finding = found.findings[0]
    assert (finding["arc"], finding["first"], finding["last"]) == (0, 0, 41)
    assert (finding["samples"], finding["hits"], finding["close"]) == (41, 41, 41)
    assert finding["chord"] == pytest.approx(np.hypot(40, rows[-1] - rows[0]), abs=1e-4)
    assert finding["rms"] == pytest.approx(np.sqrt(((rows - 30) ** 2).mean()), abs=1e-5)
    assert finding["mean_norm"] == 90
    assert (finding["contrast"], finding["longest_gap"]) == (30, 0)


def test_the_points_follow_the_arcs_direction(arcs_along, edges_of) -> None:
    edges = edges_of(np.arange(20, 61), np.full(41, 30.0))
    found = select(arcs_along((30, 60, 20)), edges, 10.0, Watch())
    assert found.points[:, 0].tolist() == list(range(60, 19, -1))


def test_points_off_the_arc_or_in_another_direction_are_no_support(measured) -> None:
    assert len(measured(30, 32.0).findings) == 0
    assert len(measured(30, slope=1.5).findings) == 0
    far = measured(30, 30.7)
    assert far.findings["hits"].tolist() == [41]
    assert far.findings["close"].tolist() == [0]


def test_two_points_of_a_rounded_corner_belong_to_the_edge(measured) -> None:
    slope = np.zeros(41)
    slope[[0, 1, 2, -2, -1]] = 0.8
    assert measured(30, slope=slope).points[:, 0].tolist() == [20, 21, *range(23, 61)]


def test_gaps_are_left_without_points(measured) -> None:
    found = measured(30, columns=[*range(20, 41), *range(46, 61)])
    finding = found.findings[0]
    assert len(found.points) == finding["hits"] == 36
    assert (finding["samples"], finding["longest_gap"]) == (41, 5)


def test_what_has_no_point_at_the_ends_is_cut(measured) -> None:
    found = measured(30, columns=range(27, 55))
    assert found.points[[0, -1], 0].tolist() == [27, 54]
    assert found.findings["samples"].tolist() == [28]


@pytest.fixture
def kept(arcs_along, edges_of):
    """Return a function that gives, by arc, first and last column of what is left of arcs along a row."""

    def run(*rows: Row) -> dict[int, list[int]]:
        edges = edges_of(np.arange(160), np.full(160, 30.0))
        found = select(arcs_along(*rows), edges, 10.0, Watch())
        columns = found.points[:, 0].astype(int)
        return {int(f["arc"]): [int(columns[f["first"]]), int(columns[f["last"] - 1])] for f in found.findings}

    return run


def test_the_shorter_of_two_on_one_edge_goes(kept) -> None:
    assert kept((30, 40, 80), (30.4, 20, 120)) == {1: [20, 120]}


def test_an_overlapping_end_is_trimmed(kept) -> None:
    assert kept((30, 20, 120), (30.4, 100, 155)) == {0: [20, 120], 1: [121, 155]}


def test_a_parallel_edge_two_pixels_away_stays(arcs_along, edges_of) -> None:
    columns = np.concatenate([np.arange(160), np.arange(160)])
    edges = edges_of(columns, np.repeat([30.0, 32.0], 160))
    found = select(arcs_along((30, 20, 120), (32, 20, 110)), edges, 10.0, Watch())
    assert found.findings["arc"].tolist() == [0, 1]
    assert set(found.points[found.findings["first"][1] :, 1].tolist()) == {32.0}


def test_edges_that_cross_both_stay(probes, edges_of) -> None:
    x = np.arange(20, 121)
    runs = [np.stack([x, np.full(101, 30.0)], axis=1), np.stack([x, 5 + 0.5 * (x - 20)], axis=1)]
    records = np.zeros(5, ARC)
    records[:2] = probes.fit(runs, np.ones((2, 3)))
    apart = x != 70  # the pixel that both run through
    columns, rows = np.concatenate([x, x[apart]]), np.concatenate([runs[0][:, 1], runs[1][apart, 1]])
    edges = edges_of(columns, rows, slope=np.repeat([0.0, 0.5], [101, 100]))
    found = select(not_merged(records), edges, 10.0, Watch())
    assert sorted(found.findings["arc"]) == [0, 1]
    assert (found.findings["chord"] > 99).all()


def test_short_arcs_are_not_looked_at(arcs_along, edges_of) -> None:
    edges = edges_of(np.arange(160), np.full(160, 30.0))
    rows = (30, 10, 49), (30, 60, 101)
    assert select(arcs_along(*rows), edges, 40.0, Watch()).findings["arc"].tolist() == [1]
    assert len(select(arcs_along(*rows), edges, 42.0, Watch()).findings) == 0


def test_an_arc_that_leaves_the_image_keeps_what_is_inside(arcs_along, edges_of) -> None:
    edges = edges_of(np.arange(160), np.full(160, 30.0))
    found = select(arcs_along((30, -40, 200)), edges, 10.0, Watch())
    assert found.points[[0, -1], 0].tolist() == [0, 159]


def test_no_arcs_give_no_segments(edges_of) -> None:
    found = select(not_merged(np.zeros(1, ARC)), edges_of(), 10.0, Watch())
    assert (len(found.findings), found.points.shape) == (0, (0, 2))


def test_selection_is_called_off_when_that_is_wished(arcs_along, edges_of) -> None:
    edges = edges_of(np.arange(160), np.full(160, 30.0))
    with pytest.raises(Cancelled):
        select(arcs_along((30, 20, 120)), edges, 10.0, Watch(cancelled=lambda: True))
