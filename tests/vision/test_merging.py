import numpy as np
import pytest

from app.vision.arcs import Arcs, fit_arcs
from app.vision.circle import moment_sums
from app.vision.edges import Gradient
from app.vision.gaps import effective_gaps
from app.vision.merging import FLIPPING, FOLLOWING, merge

Piece = tuple[tuple[float, float], tuple[float, float]]


def field(norm: np.ndarray | None = None, x: float = 0.0, y: float = 1.0) -> Gradient:
    norm = np.zeros((200, 400), np.float32) if norm is None else norm.astype(np.float32)
    return Gradient(norm * np.float32(x), norm * np.float32(y), norm)


def pieces(*ends: Piece, greys: tuple[float, float] = (50, 150), noise: float = 0.0) -> Arcs:
    """Arcs along straight lines, one point per px, dark side and bright side ``greys``."""
    rng = np.random.default_rng(0)
    runs = []
    for start, end in ends:
        count = int(np.hypot(end[0] - start[0], end[1] - start[1])) + 1
        t = np.linspace(0, 1, count)[:, None]
        runs.append(np.array(start) * (1 - t) + np.array(end) * t + rng.normal(0, noise, (count, 2)))
    counts = np.array([len(run) for run in runs])
    origin, sums = moment_sums(np.concatenate(runs), np.concatenate([[0], np.cumsum(counts)]).astype(np.int64))
    traits = counts[:, None] * np.array([*greys, 100.0])
    return fit_arcs(origin, sums, traits, np.array([r[0] for r in runs]), np.array([r[-1] for r in runs]))


def ends(arcs: Arcs) -> list[list[float]]:
    both = [arcs.positions(slice(None), u) for u in (arcs.low, arcs.high)]
    return sorted(np.concatenate(both, axis=1).round(3).tolist())


def test_collinear_pieces_become_one() -> None:
    arcs = pieces(((10, 50), (60, 50)), ((65, 50), (100, 50)), ((108, 50), (150, 50)))
    merged = merge(arcs, field(), FOLLOWING)
    assert ends(merged) == [[10, 50, 150, 50]]
    assert merged.sums[0, 0] == arcs.sums[:, 0].sum()
    assert merged.traits[0] == pytest.approx(arcs.traits.sum(axis=0))


def test_the_order_of_the_pieces_does_not_matter() -> None:
    lines: list[Piece] = [((10, 50), (60, 50)), ((65, 50.4), (100, 51)), ((40, 90), (90, 90)), ((96, 90), (160, 90))]
    one = merge(pieces(*lines), field(), FOLLOWING)
    other = merge(pieces(*lines[::-1]), field(), FOLLOWING)
    assert ends(one) == ends(other)
    assert len(one) == 2


@pytest.mark.parametrize(
    "second",
    [
        ((65, 56), (100, 56)),  # beside
        ((65, 50), (95, 58)),  # at an angle
        ((30, 51), (80, 51)),  # side by side
        ((190, 50), (230, 50)),  # too far
        ((100, 50), (65, 50)),  # bright on the other side
    ],
)
def test_what_is_no_continuation_stays_apart(second: Piece) -> None:
    assert len(merge(pieces(((10, 50), (60, 50)), second), field(), FOLLOWING)) == 2


def test_the_nearest_partner_wins() -> None:
    arcs = pieces(((10, 50), (60, 50)), ((64, 50), (110, 50)), ((66, 51.5), (110, 51.5)))
    merged = merge(arcs, field(), FOLLOWING)
    assert ends(merged) == [[10, 50, 110, 50], [66, 51.5, 110, 51.5]]


def test_flipped_contrast_is_merged_by_its_own_rule_only() -> None:
    arcs = pieces(((10, 50), (80, 50)), ((110, 50), (85, 50)))
    merged = merge(arcs, field(), FLIPPING)
    assert ends(merged) == [[10, 50, 110, 50]]
    counts = arcs.sums[:, 0]
    # the shorter arc's dark side lies on the longer one's bright side
    assert merged.traits[0, :2] == pytest.approx([50 * counts[0] + 150 * counts[1], 150 * counts[0] + 50 * counts[1]])


def test_pieces_of_one_circle_become_one_arc() -> None:
    radius = 2000.0
    angle = np.concatenate([np.arange(0, 60), np.arange(66, 140)]) / radius
    points = np.stack([20 + radius * np.sin(angle), 80 + radius * (1 - np.cos(angle))], axis=1)
    origin, sums = moment_sums(points, np.array([0, 60, 134]))
    arcs = fit_arcs(origin, sums, np.ones((2, 3)), points[[0, 60]], points[[59, 133]])
    merged = merge(arcs, field(), FOLLOWING)
    assert len(merged) == 1
    assert abs(2 * merged.bend[0]) == pytest.approx(1 / radius, rel=1e-3)
    assert merged.rms[0] < 1e-3


def test_nothing_to_merge_is_nothing() -> None:
    arcs = pieces(((10, 50), (60, 50))).take(np.zeros(0, int))
    assert len(merge(arcs, field(), FOLLOWING)) == 0


def _gap(norm: np.ndarray, x: float, y: float, greys: tuple[float, float] = (50, 150)) -> float:
    arcs = pieces(((10, 50), (60, 50)), ((80, 50), (130, 50)))
    arcs.traits[1, :2] = np.array(greys) * arcs.sums[1, 0]
    first, second = np.array([0]), np.array([1])
    leave, enter = np.array([[60.0, 50.0]]), np.array([[80.0, 50.0]])
    return float(effective_gaps(arcs, first, second, leave, enter, True, field(norm, x, y))[0])


def test_a_gap_counts_half_when_nothing_crosses_it() -> None:
    assert _gap(np.zeros((200, 400)), 0, 1) == pytest.approx(10)


def test_a_gap_with_an_edge_across_it_counts_whole() -> None:
    norm = np.zeros((200, 400))
    norm[:, 70:72] = 100  # an edge of one px is at least two wide in the gradient
    assert _gap(norm, 1, 0) == pytest.approx(20)


def test_a_weak_edge_in_the_gap_shortens_it() -> None:
    norm = np.zeros((200, 400))
    norm[50] = 30
    assert _gap(norm, 0, 1) == pytest.approx(20 * 0.3 * 0.5)


def test_other_greys_on_both_sides_lengthen_the_gap() -> None:
    assert _gap(np.zeros((200, 400)), 0, 1, greys=(90, 190)) == pytest.approx(17)
    assert _gap(np.zeros((200, 400)), 0, 1, greys=(50, 190)) == pytest.approx(10)
