import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.vision.arcs import Arcs, concatenate, fit_arcs
from app.vision.circle import moment_sums

LEFT_TO_RIGHT = (np.array([[10.0, 20.0]]), np.array([[60.0, 20.0]]))


def fitted(points: np.ndarray, reverse: bool = False) -> Arcs:
    origin, sums = moment_sums(points, np.array([0, len(points)]))
    start, end = points[:1], points[-1:]
    return fit_arcs(origin, sums, np.zeros((1, 3)), *((end, start) if reverse else (start, end)))


def parabola(curvature: float, length: int = 100) -> np.ndarray:
    x = np.arange(length + 1.0)
    return np.stack([x + 10, 20 + 0.5 * curvature * (x - length / 2) ** 2], axis=1)


def test_a_line_runs_from_start_to_end() -> None:
    arcs = fitted(parabola(0.0))
    assert arcs.tangent == pytest.approx(np.array([[1.0, 0.0]]))
    assert arcs.normal == pytest.approx(np.array([[0.0, 1.0]]))
    assert arcs.lengths == pytest.approx([100])
    assert arcs.positions(slice(None), arcs.low) == pytest.approx(np.array([[10.0, 20.0]]))
    assert arcs.positions(slice(None), arcs.high) == pytest.approx(np.array([[110.0, 20.0]]))


def test_the_other_way_round_it_is_turned() -> None:
    arcs = fitted(parabola(0.0), reverse=True)
    assert arcs.tangent == pytest.approx(np.array([[-1.0, 0.0]]))
    assert arcs.positions(slice(None), arcs.low) == pytest.approx(np.array([[110.0, 20.0]]))


@pytest.mark.parametrize("curvature", [5e-4, -5e-4])
def test_the_bend_follows_the_points(curvature: float) -> None:
    points = parabola(curvature)
    for reverse in (False, True):
        arcs = fitted(points, reverse)
        along, across = arcs.project(np.zeros(len(points), int), points)
        assert np.abs(across).max() < 1e-3
        assert arcs.positions(np.zeros(len(points), int), along) == pytest.approx(points, abs=1e-3)


@given(
    curvature=st.floats(-1e-3, 1e-3),
    u=st.floats(-120, 120),
    distance=st.floats(-20, 20),
)
def test_projecting_undoes_placing(curvature: float, u: float, distance: float) -> None:
    arcs = fitted(parabola(curvature))
    at = np.array([u])
    direction = arcs.directions(slice(None), at)
    assert np.hypot(*direction[0]) == pytest.approx(1)
    point = arcs.positions(slice(None), at) + distance * np.stack([-direction[:, 1], direction[:, 0]], axis=1)
    along, across = arcs.project(slice(None), point)
    assert along[0] == pytest.approx(u, abs=1e-6)
    assert across[0] == pytest.approx(distance, abs=1e-6)


def test_a_few_points_make_a_line() -> None:
    assert fitted(parabola(1e-3, 22)).bend.tolist() == [0.0]
    assert fitted(parabola(1e-3, 24)).bend[0] != 0


def test_sets_join_in_order() -> None:
    one, two = fitted(parabola(0.0)), fitted(parabola(5e-4))
    both = concatenate([one, two])
    assert len(both) == 2
    assert both.take(np.array([1])).bend.tolist() == two.bend.tolist()
