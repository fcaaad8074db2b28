"""Merging: which arcs become one, and what the image in a gap has to say."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.errors import Cancelled
from app.vision.arcs import ends
from app.vision.merging import FLIPPING, FOLLOWING, MergeRule, Merging, merge, not_merged
from app.vision.native.records import ARC
from app.vision.watch import Watch

SHAPE = (200, 400)
Piece = tuple[tuple[float, float], tuple[float, float]]


def straight(start: tuple[float, float], end: tuple[float, float]) -> np.ndarray:
    """Points along a line, one per px."""
    t = np.linspace(0, 1, int(np.hypot(end[0] - start[0], end[1] - start[1])) + 1)[:, None]
    return np.array(start) * (1 - t) + np.array(end) * t


@pytest.fixture
def pieces(probes):
    """Return a function that makes arcs along straight lines."""

    def make(*lines: Piece, greys: tuple[float, float] = (50, 150)) -> np.ndarray:
        """The dark side has the one grey level, the bright side the other."""
        runs = [straight(*line) for line in lines]
        return probes.fit(runs, np.array([len(run) * np.array([*greys, 100.0]) for run in runs]).reshape(-1, 3))

    return make


def state(arcs: np.ndarray) -> Merging:
    records = np.zeros(2 * len(arcs) + 1, ARC)
    records[: len(arcs)] = arcs
    return not_merged(records)


def merged(arcs: np.ndarray, edges, rule: MergeRule = FOLLOWING) -> Merging:
    return merge(state(arcs), edges, rule, Watch())


def lines(arcs: np.ndarray) -> list[list[float]]:
    return sorted(np.round(ends(arcs).reshape(-1, 4), 3).tolist())


@pytest.fixture
def plain(edges_of):
    """An image with nothing in it."""
    return edges_of(shape=SHAPE)


def test_collinear_pieces_become_one(pieces, plain) -> None:
    arcs = pieces(((10, 50), (60, 50)), ((65, 50), (100, 50)), ((108, 50), (150, 50)))
    one = merged(arcs, plain)
    assert lines(one.arcs) == [[10, 50, 150, 50]]
    assert one.arcs["sums"][0, 0] == arcs["sums"][:, 0].sum()
    assert one.arcs["traits"][0] == pytest.approx(arcs["traits"].sum(axis=0))
    assert (one.made, one.arcs["first_piece"][0], one.arcs["last_piece"][0]) == (2, 0, 2)
    assert one.next_piece.tolist() == [1, 2, -1]
    gaps = np.concatenate([one.joins["leave"], one.joins["enter"]], axis=1)[:2]
    assert sorted(gaps.tolist()) == [[60, 50, 65, 50], [100, 50, 108, 50]]
    assert not one.joins["flipped"][:2].any()


@given(order=st.permutations(range(5)))
def test_the_order_of_the_pieces_does_not_matter(probes, edges_of, order: list[int]) -> None:
    all_lines = [
        ((10.0, 50.0), (60.0, 50.0)),
        ((65.0, 50.4), (100.0, 51.0)),
        ((106.0, 50.8), (150.0, 51.5)),
        ((40.0, 90.0), (90.0, 90.0)),
        ((96.0, 90.0), (160.0, 90.0)),
    ]
    traits = np.array([[50.0, 150.0, 100.0]] * 5)
    one, other = (
        merged(probes.fit([straight(*all_lines[i]) for i in chosen], traits), edges_of(shape=SHAPE))
        for chosen in (range(5), order)
    )
    assert lines(one.arcs) == lines(other.arcs)
    assert one.count == 2


@pytest.mark.parametrize(
    "second",
    [
        ((65, 56), (100, 56)),  # beside
        ((65, 50), (95, 65)),  # at an angle
        ((30, 51), (80, 51)),  # side by side
        ((290, 50), (330, 50)),  # too far
        ((100, 50), (65, 50)),  # bright on the other side
    ],
)
def test_what_is_no_continuation_stays_apart(pieces, plain, second: Piece) -> None:
    assert merged(pieces(((10, 50), (60, 50)), second), plain).count == 2


def test_each_condition_of_a_rule_counts(pieces, plain) -> None:
    arcs = pieces(((10, 50), (60, 50)), ((68, 51), (118, 54)))
    loose = replace(FOLLOWING, angle=20.0, offset=9.0, rms=9.0, largest=9.0, reach=99.0, limit=99.0)
    assert merged(arcs, plain, loose).count == 1
    for condition in ("angle", "rms", "largest", "reach"):
        assert merged(arcs, plain, replace(loose, **{condition: 0.01})).count == 2
    assert merged(arcs, plain, replace(loose, offset=0.0, offset_per_gap=0.0)).count == 2
    assert merged(arcs, plain, replace(loose, limit=0.0, limit_per_length=0.0)).count == 2
    assert merged(arcs, plain, replace(loose, limit=0.0, limit_per_length=0.5)).count == 1


def test_the_nearest_partner_wins(pieces, plain) -> None:
    arcs = pieces(((10, 50), (60, 50)), ((64, 50), (110, 50)), ((66, 51.5), (110, 51.5)))
    assert lines(merged(arcs, plain).arcs) == [[10, 50, 110, 50], [66, 51.5, 110, 51.5]]


def test_flipped_contrast_is_merged_by_its_own_rule_only(pieces, plain) -> None:
    arcs = pieces(((10, 50), (80, 50)), ((110, 50), (85, 50)))
    assert merged(arcs, plain, FOLLOWING).count == 2
    one = merged(arcs, plain, FLIPPING)
    assert lines(one.arcs) == [[10, 50, 110, 50]]
    assert one.joins["flipped"][0] == 1
    counts = arcs["sums"][:, 0]
    # the shorter arc's dark side lies on the longer one's bright side
    expected = [50 * counts[0] + 150 * counts[1], 150 * counts[0] + 50 * counts[1]]
    assert one.arcs["traits"][0, :2] == pytest.approx(expected)


def test_pieces_of_one_circle_become_one_arc(probes, plain) -> None:
    radius = 2000.0
    angle = np.concatenate([np.arange(0, 60), np.arange(66, 140)]) / radius
    points = np.stack([20 + radius * np.sin(angle), 80 + radius * (1 - np.cos(angle))], axis=1)
    one = merged(probes.fit([points[:60], points[60:]], np.ones((2, 3))), plain)
    assert one.count == 1
    assert abs(2 * one.arcs["bend"][0]) == pytest.approx(1 / radius, rel=1e-3)
    assert one.arcs["rms"][0] < 1e-3


def test_another_round_goes_on_with_what_is_left(pieces, plain) -> None:
    arcs = pieces(((10, 50), (60, 50)), ((65, 50), (100, 50)), ((140, 50), (104, 50)))
    first = merged(arcs, plain)
    assert (first.count, first.made) == (2, 1)
    second = merge(first, plain, FLIPPING, Watch())
    assert (second.count, second.made) == (1, 2)
    assert second.joins["flipped"][:2].tolist() == [0, 1]
    assert second.joins["next"][second.arcs["first_join"][0]] == 0


def test_nothing_to_merge_is_nothing(plain) -> None:
    assert merged(np.zeros(0, ARC), plain).count == 0


def test_merging_is_called_off_when_that_is_wished(pieces, plain) -> None:
    arcs = pieces(((10, 50), (60, 50)), ((65, 50), (100, 50)))
    with pytest.raises(Cancelled):
        merge(state(arcs), plain, FOLLOWING, Watch(cancelled=lambda: True))


@pytest.fixture
def gap(probes, edges_of):
    """Return a function that gives the effective length of a gap of 20 px from (60, 50) to (80, 50)."""

    def measure(
        gradient_x: np.ndarray | float = 0.0,
        gradient_y: np.ndarray | float = 0.0,
        *,
        greys: tuple[float, float] = (50, 150),
        norm: float = 100.0,
        same_polarity: bool = True,
    ) -> float:
        """The second arc has ``greys`` beside it, and a mean gradient of ``norm``."""
        field = np.zeros((2, *SHAPE))
        field[0], field[1] = gradient_x, gradient_y
        runs = [straight((10, 50), (60, 50)), straight((80, 50), (130, 50))]
        traits = len(runs[0]) * np.array([[50.0, 150.0, 100.0], [*greys, norm]])
        edges = edges_of(shape=SHAPE, gradients=field)
        return probes.gap(edges, probes.fit(runs, traits), same_polarity=same_polarity)

    return measure


def test_a_gap_counts_for_less_when_nothing_crosses_it(gap) -> None:
    crossing = np.zeros(SHAPE)
    crossing[:, 70:72] = 100  # an edge of one px is at least two wide in the gradient
    assert gap() < gap(crossing)
    assert gap(crossing) == pytest.approx(20)


def test_a_weak_edge_in_the_gap_shortens_it(gap) -> None:
    edge, half = np.zeros(SHAPE), np.zeros(SHAPE)
    edge[50] = 30
    half[50, :70] = 30
    assert gap(0.0, edge) < gap(0.0, half) < gap()
    edge[50] = 10
    assert gap(0.0, edge) == gap()


def test_other_greys_on_both_sides_lengthen_the_gap_unless_the_polarity_may_change(gap) -> None:
    assert gap(greys=(90, 190)) > gap()
    assert gap(greys=(50, 190)) == gap()
    assert gap(greys=(90, 190), same_polarity=False) == gap()


def test_another_contrast_lengthens_the_gap(gap) -> None:
    assert gap(norm=45.0) > gap()
    assert gap(norm=60.0) == gap()
